"""Repetition of an action whenever one of its files changes."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import click

from robosc.base.diagnostics.visible import visible
from robosc.base.files import reading as files
from robosc.language.libraries import search_folders
from robosc.tools.cli import say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from robosc.tools.cli.options import Paths

#: Polling period.
PERIOD_SECONDS = 0.3

#: Identity of a text without its content: time of change, length, and file number.
_Stamp: TypeAlias = tuple[int, int, int]


def watch(action: str, do: Callable[[], None], models: Sequence[str], others: Sequence[str], paths: Paths) -> None:
    """Call `do` now and again after each change of its files, until Ctrl-C. An error does not end this.

    `action` is a verb such as `checking`. `others` are names of further files that `do` reads, or would read.
    """

    def again(changed: Sequence[str]) -> None:
        because = f": {', '.join(map(visible, changed))} changed" if changed else ""
        say(f"{action} {', '.join(map(visible, models))}{because}", err=True)
        try:
            do()
        except click.exceptions.Exit:
            pass  # the report has the errors
        except click.ClickException as error:
            say(f"Error: {error.format_message()}", err=True)
        except OSError as error:
            say(f"{visible(str(error.filename))}: {error.strerror}", err=True)
        say("waiting for changes; stop with Ctrl-C", err=True)

    folders = [*dict.fromkeys(Path(model).parent for model in models), *search_folders(paths.libraries)]
    whenever_files_change(again, [*models, *others], folders)


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
