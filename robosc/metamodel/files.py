"""Which files a model came from.

A model names a file by a relative path that is the same on every machine: `file` of a robot or library, and what stands
before the lines and columns in a `source`. Which path that is for the user of this run, is kept beside the model.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from robosc.metamodel import robosc

_LOCATE = "_locate"


def set_path(base: robosc.Base, name: str, path: str) -> None:
    """Notes the file that a robot or library was read from: its name, and its path as the user wrote it."""
    base.file = name
    set_locate(base, {name: path}.get)


def set_locate(root: Any, locate: Callable[[str], str | None]) -> None:
    """Keeps with the root of a model what knows the paths of the files that it names."""
    vars(root)[_LOCATE] = locate


def derive_paths(root: Any, bases: Iterable[robosc.Base]) -> None:
    """Keeps with the root of a model the paths of the robot and the libraries that it comes from."""
    set_locate(root, {str(base.file): path_of(base) for base in bases}.get)


def located(root: Any, name: str) -> str:
    """The path, as the user would write it, of a file that a model names; the name where the path is unknown."""
    locate: Callable[[str], str | None] | None = vars(root).get(_LOCATE)
    return (locate(name) if locate is not None else None) or name


def path_of(base: robosc.Base) -> str:
    """The file that a robot or library was read from, as its user wrote it; the name where only that is known."""
    return located(base, str(base.file or ""))
