"""Does something again whenever a file changes that it depends on."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from robosc.files import reading as files

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

#: How often files are looked at.
PERIOD_SECONDS = 0.3

#: What tells a text from a later one, without reading it: when it changed, how long it is, and which file has it.
_Stamp: TypeAlias = tuple[int, int, int]


def whenever_files_change(
    do: Callable[[Sequence[str]], None], named: Sequence[str], folders: Iterable[str | Path]
) -> None:
    """Calls `do` now, and again after each change of a file that it has read, of one that is `named`, and of models.

    `do` gets the names of the files that changed. Models are the `.rscd` files in the folders: one that is new there
    may be the library that was missing. Only an exception, such as KeyboardInterrupt, ends this.
    """
    read: list[str] = []
    changed: list[str] = []
    while True:
        before = _stamps([*named, *read], folders)
        with files.noting():
            do(changed)
            read = files.inputs()
        # A file that was read for the first time is compared with what it is now, all others with what they were.
        before = _stamps([*named, *read], folders) | before
        while not (changed := _changed(before, _stamps(list(before), folders))):
            time.sleep(PERIOD_SECONDS)


def _stamps(names: Iterable[str], folders: Iterable[str | Path]) -> dict[str, _Stamp | None]:
    models = (str(path) for folder in folders for path in sorted(Path(folder).glob("*.rscd")))
    return {name: _stamp(name) for name in [*names, *models]}


def _stamp(name: str) -> _Stamp | None:
    try:
        found = Path(name).stat()
    except OSError:  # it is not there, for the moment
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def _changed(before: Mapping[str, _Stamp | None], now: Mapping[str, _Stamp | None]) -> list[str]:
    return [name for name, stamp in now.items() if before.get(name) != stamp]
