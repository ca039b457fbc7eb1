"""Reads the files that somebody names: regular ones, of a bounded size, so that none can hang or fill the memory."""

from __future__ import annotations

import errno
import os
import stat
import sys
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

#: The largest file that is read. A model of 100,000 lines has 4 MB, a saved one with the deepest expression 72 MB.
MOST_BYTES = 128 << 20

#: By absent names of Windows: what does not wait for a pipe's other end, and what takes no terminal.
_CAUTIOUS = sum(getattr(os, name, 0) for name in ("O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY"))
_KINDS = {
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}

_Identity = tuple[int, int]
#: The inputs that were read within `noting`, by their identity: the path by which each was named.
_noted: ContextVar[dict[_Identity, str] | None] = ContextVar("noted", default=None)


def read(path: str | os.PathLike[str], *, is_input: bool = True) -> bytes:
    """What is in a regular file; without `is_input` it may be written over afterwards.

    Raises OSError where it can't be read, is no regular file (nothing is opened then), or has more than MOST_BYTES.
    """
    name = os.fspath(path)
    with opened(name, is_input=is_input, buffering=0) as file:
        return _bounded(file, name)


@contextmanager
def opened(path: str | os.PathLike[str], *, is_input: bool = True, buffering: int = -1) -> Iterator[IO[bytes]]:
    """A regular file of any size, to be read as binary; as for `read`. Raises OSError."""
    name = os.fspath(path)
    try:
        _require_regular(Path(name).stat(), name)
        # Between the two calls it may have become something else, which must not make us wait, either.
        descriptor = os.open(name, os.O_RDONLY | _CAUTIOUS)
    except ValueError as error:  # a null character
        raise OSError(errno.EINVAL, str(error), name) from None
    with os.fdopen(descriptor, "rb", buffering=buffering) as file:
        found = os.fstat(descriptor)
        _require_regular(found, name)
        noted = _noted.get()
        if is_input and noted is not None:
            noted[_identity(found)] = name
        yield file


def read_stdin(name: str) -> bytes:
    """What comes from the standard input; `name` is what errors call it.

    Raises OSError where it can't be read or has more than MOST_BYTES.
    """
    return _bounded(sys.stdin.buffer, name)


@contextmanager
def noting() -> Iterator[None]:
    """While the `with` block runs, the inputs that `read` reads are noted: nothing is written over them."""
    token = _noted.set({})
    try:
        yield
    finally:
        _noted.reset(token)


def input_named(found: os.stat_result) -> str | None:
    """The name by which this very file, whatever it is called here, was read within `noting`; None if it was not."""
    return (_noted.get() or {}).get(_identity(found))


def inputs() -> list[str]:
    """The names of all files that were read within `noting`, in the order in which they first were."""
    return list((_noted.get() or {}).values())


def kind(mode: int) -> str:
    """What stands where a regular file is wanted, such as `a pipe`, from its mode."""
    return _KINDS.get(stat.S_IFMT(mode), "something else")


def _identity(found: os.stat_result) -> _Identity:
    return found.st_dev, found.st_ino


def _require_regular(found: os.stat_result, name: str) -> None:
    if stat.S_ISDIR(found.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), name)
    if not stat.S_ISREG(found.st_mode):
        raise OSError(errno.EINVAL, f"this is {kind(found.st_mode)}; only regular files are read", name)


def _bounded(file: IO[bytes], name: str) -> bytes:
    pieces: list[bytes] = []
    rest = MOST_BYTES
    while rest >= 0:
        piece = file.read(min(rest + 1, 1 << 20))
        if piece is None:  # /proc has regular files that wait for more
            raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN), name)
        if not piece:
            return b"".join(pieces)
        pieces.append(piece)
        rest -= len(piece)
    raise OSError(errno.EFBIG, f"this has more than {MOST_BYTES >> 20} MB, the most that is read", name)
