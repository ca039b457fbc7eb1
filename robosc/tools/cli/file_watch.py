"""Repetition of an action whenever one of its files changes."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from robosc.base.files import reading as files

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

#: Polling period.
PERIOD_SECONDS = 0.3

#: Identity of a text without its content: time of change, length, and file number.
_Stamp: TypeAlias = tuple[int, int, int]


def whenever_files_change(
    do: Callable[[Sequence[str]], None], named: Sequence[str], folders: Iterable[str | Path]
) -> None:
    """Call `do` now, and again after each change of a file that it read, of a `named` file, and of models.

    `do` gets the names of the changed files. Models are the `.rscd` files in the folders: a new one may be a missing
    library. Only an exception, such as KeyboardInterrupt, ends this.
    """
    inputs: list[str] = []
    changed: list[str] = []
    while True:
        before = _stamps([*named, *inputs], folders)
        with files.record_inputs():
            do(changed)
            inputs = files.inputs()
        # Files that were read for the first time are compared with their present state, all others with their earlier
        # state.
        before = _stamps([*named, *inputs], folders) | before
        while not (changed := _changed(before, _stamps(list(before), folders))):
            time.sleep(PERIOD_SECONDS)


def _stamps(names: Iterable[str], folders: Iterable[str | Path]) -> dict[str, _Stamp | None]:
    models = (str(path) for folder in folders for path in sorted(Path(folder).glob("*.rscd")))
    return {name: _stamp(name) for name in [*names, *models]}


def _stamp(name: str) -> _Stamp | None:
    try:
        status = Path(name).stat()
    except OSError:  # it does not exist at the moment
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino


def _changed(before: Mapping[str, _Stamp | None], now: Mapping[str, _Stamp | None]) -> list[str]:
    return [name for name, stamp in now.items() if before.get(name) != stamp]
