"""Pipes, devices, sockets, folders and cyclic links where a command expects a file."""

from __future__ import annotations

import os
import shutil
import signal
import socket
from contextlib import contextmanager
from random import Random
from typing import TYPE_CHECKING, Any, NoReturn

from tests.fuzz.mutants import ROOT
from tests.fuzz.trial import HangError, said

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

_EXAMPLE = ROOT / "examples" / "line_follower"
#: Seconds after which a command that reads a few lines counts as hanging.
_PATIENCE = 60


def _socket(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(str(path))


#: Special files and the functions that create them.
KINDS: dict[str, Callable[[Path], Any]] = {
    "pipe": os.mkfifo,
    "socket": _socket,
    "zeros": lambda path: path.symlink_to("/dev/zero"),
    "random": lambda path: path.symlink_to("/dev/urandom"),
    "terminal": lambda path: path.symlink_to("/dev/tty"),
    "kernel": lambda path: path.symlink_to("/proc/kmsg"),
    "circle": lambda path: path.symlink_to(path),
    "nothing": lambda path: path.symlink_to("missing"),
    "folder": lambda path: path.mkdir(),
    "huge": lambda path: _sparse(path, 2**40),
    "bytes": lambda path: path.write_bytes(bytes(range(256)) * 64),
    "brackets": lambda path: path.write_bytes(b"[" * 300_000),
    "many brackets": lambda path: path.write_bytes(b"[" * 2_000_000),
    "digits": lambda path: path.write_bytes(b"[" + b"9" * 300_000 + b"]"),
}
#: Kinds that a command may replace with its output: regular files, and a link to a missing file.
_REPLACEABLE = {"huge", "bytes", "brackets", "many brackets", "digits", "nothing"}


def _sparse(path: Path, size: int) -> None:
    with path.open("wb") as file:
        file.truncate(size)


#: Commands. A word that begins with SPECIAL stands for the special file; MODEL, OUT and FOLDER for ordinary paths.
COMMANDS = (
    "check SPECIAL",
    "check SPECIAL.xmi",
    "check MODEL --interface-path FOLDER",
    "check MODEL -I FOLDER",
    "synthesize SPECIAL.sct.xmi",
    "transform MODEL --to cif --config SPECIAL.json -o OUT",
    "transform MODEL --to cif -o SPECIAL",
    "simulate MODEL --script SPECIAL",
    "simulate MODEL --loop --script SPECIAL",
    "format --check FOLDER",
    "format SPECIAL",
    "diagram SPECIAL",
    "diagram MODEL -o SPECIAL",
    "verify SPECIAL",
    "run SPECIAL --ros2",
)


@contextmanager
def _patience() -> Iterator[None]:
    def ended(*_: Any) -> NoReturn:
        raise HangError(f"waits for more than {_PATIENCE} s")

    before = signal.signal(signal.SIGALRM, ended)
    signal.alarm(_PATIENCE)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def special_tried(folder: Path, seed: int) -> int:
    """Try the command and the kind of file that a seed selects; see `tried_with`."""
    random = Random(seed)  # noqa: S311 - nothing here is secret
    return tried_with(folder, random.choice(COMMANDS), random.choice(sorted(KINDS)), random)


def tried_with(folder: Path, command: str, kind: str, random: Random) -> int:
    """Run a command on a special file, or on a folder that contains one; return the exit status.

    Raises AssertionError if the status is not one of the documented ones, or if the command replaced the special file.
    """
    place = folder / "special"
    place.mkdir()
    try:
        shutil.copy(_EXAMPLE / "line_follower.rscd", place)
        named = next((word for word in command.split() if word.startswith("SPECIAL")), "")
        # A folder may contain models, libraries, and definitions of ROS types.
        special = place / f"special{named.removeprefix('SPECIAL') or random.choice(('', '.rscd', '.msg', '.json'))}"
        if special.suffix == ".msg":
            special = place / "some_msgs" / "msg" / "Some.msg"
            special.parent.mkdir(parents=True)
        KINDS[kind](special)
        before = special.lstat()
        places = {"MODEL": str(place / "line_follower.rscd"), "OUT": str(place / "out"), "FOLDER": str(place)}
        words = [str(special) if word.startswith("SPECIAL") else places.get(word, word) for word in command.split()]
        with _patience():
            status, _ = said(*words)
        after = special.lstat()
        assert (before.st_ino, before.st_mode) == (after.st_ino, after.st_mode) or kind in _REPLACEABLE, (
            f"{command}: {kind} was replaced"
        )
    finally:
        shutil.rmtree(place)
    return status
