"""Digests of the tool, of the files of a model, and of the generated files."""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from typing import TYPE_CHECKING

from robosc.base.files.resources import locate

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

#: Suffixes of the tool's sources; files that Python and jinja2 compile beside them do not count.
_SOURCES = (".py", ".c", ".j2", ".hpp", ".tx", ".ecore", ".json", ".xml", ".in", ".cmake")


def digest(content: str | bytes) -> str:
    """Return the SHA-256 of a text in UTF-8, or of bytes, in hexadecimal."""
    return sha256(content.encode() if isinstance(content, str) else content).hexdigest()


def of_files(texts: Mapping[str, str | bytes]) -> list[dict[str, str]]:
    """Return the digest of each file, in the order of the paths."""
    return [{"path": path, "sha256": digest(texts[path])} for path in sorted(texts)]


def together(digests: Iterable[tuple[str, str]]) -> str:
    """Return one digest of many files: that of a list as `sha256sum` writes it."""
    return digest("".join(f"{sha}  {path}\n" for path, sha in sorted(digests)))


@cache
def of_tool() -> str:
    """Return the digest of the installed tool: of all its sources, grammars, metamodels and templates.

    It is the same for a checkout and for the wheel that is built from it.
    """
    package = locate("run").parent
    paths = {path.relative_to(package).as_posix(): path for path in package.rglob("*")}
    for name in ("grammar/robosc.tx", "metamodel/sct.ecore"):
        folder = locate(name).parent
        paths |= {f"{folder.name}/{path.relative_to(folder).as_posix()}": path for path in folder.rglob("*")}
    return together(
        (relative, digest(path.read_bytes()))
        for relative, path in paths.items()
        if path.suffix in _SOURCES and "__pycache__" not in relative
    )
