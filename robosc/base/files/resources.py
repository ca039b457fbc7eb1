"""Locates the files that ship with the tool: metamodels, grammar, templates, libraries."""

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[2]


def locate(relative: str) -> Path:
    """Return the path of a shipped file or folder, such as `metamodel/sct.ecore`.

    An installed wheel contains it in the package; for an editable install it is at the root of the repository. Raises
    FileNotFoundError if neither has it: then the installation is damaged.
    """
    for root in (_PACKAGE, _PACKAGE.parent):
        path = root / relative
        if path.exists():
            return path
    raise FileNotFoundError(f"{relative} is missing from the installation of robosc")
