"""Finds the files that ship with the tool: metamodels, grammar, templates, libraries."""

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent.parent


def locate(relative: str) -> Path:
    """The path of a shipped file or folder, such as `metamodel/sct.ecore`.

    An installed wheel carries it inside the package; an editable install finds it at the root of the repository.
    Raises FileNotFoundError where neither has it: the installation is damaged.
    """
    for root in (_PACKAGE, _PACKAGE.parent):
        path = root / relative
        if path.exists():
            return path
    raise FileNotFoundError(f"{relative} is missing from the installation of robosc")
