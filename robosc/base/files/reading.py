"""Reads files that users name: only regular ones of bounded size, so that none can block or fill the memory."""

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
    from collections.abc import Callable, Iterator, Sequence

#: Maximum size of a file. A model of 100,000 lines has 4 MB, a saved one with the deepest expression 72 MB.
MOST_BYTES = 128 << 20

#: Flags, as far as the platform has them: do not wait for the other end of a pipe, do not take over a terminal.
_CAUTIOUS = sum(getattr(os, name, 0) for name in ("O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY"))
_KINDS = {
    stat.S_IFIFO: "a pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}

_Identity = tuple[int, int]
#: Inputs that were read within `record_inputs`: from their identity to the path by which each was named.
_noted: ContextVar[dict[_Identity, str] | None] = ContextVar("noted", default=None)
#: Folders and trusted folders of `read_only_below`, or None if all files may be read.
_readable: ContextVar[tuple[Sequence[Path], Sequence[Path]] | None] = ContextVar("readable", default=None)


def read(path: str | os.PathLike[str], *, is_input: bool = True) -> bytes:
    """Return the content of a regular file; without `is_input`, the tool may overwrite it later.

    Raises OSError if the file cannot be read, is not regular (then it is not opened), or has more than MOST_BYTES.
    """
    name = os.fspath(path)
    with open_file(name, is_input=is_input, buffering=0) as file:
        return _bounded(file, name)


@contextmanager
def open_file(path: str | os.PathLike[str], *, is_input: bool = True, buffering: int = -1) -> Iterator[IO[bytes]]:
    """Open a regular file of any size for binary reading; `is_input` is as for `read`. Raises OSError."""
    name = os.fspath(path)
    try:
        _require_readable(name, os.path.realpath)
        _require_regular(Path(name).stat(), name)
        # Between the two calls, the file may be replaced by another kind, which must not block either.
        descriptor = os.open(name, os.O_RDONLY | _CAUTIOUS)
    except ValueError as error:  # The path contains a null character.
        raise OSError(errno.EINVAL, str(error), name) from None
    with os.fdopen(descriptor, "rb", buffering=buffering) as file:
        status = os.fstat(descriptor)
        _require_regular(status, name)
        _require_readable(name, lambda _: _opened_path(descriptor))
        noted = _noted.get()
        if is_input and noted is not None:
            noted[_identity(status)] = name
        yield file


def read_stdin(name: str) -> bytes:
    """Return the content of the standard input; errors call it `name`.

    Raises OSError if it cannot be read or has more than MOST_BYTES.
    """
    return _bounded(sys.stdin.buffer, name)


@contextmanager
def record_inputs() -> Iterator[None]:
    """Record the inputs that `read` reads within the `with` block, so that nothing overwrites them."""
    token = _noted.set({})
    try:
        yield
    finally:
        _noted.reset(token)


def input_name(status: os.stat_result) -> str | None:
    """Return the name by which this file was read within `record_inputs`, or None if it was not.

    The file is identified by its device and inode, so that links do not hide it.
    """
    return (_noted.get() or {}).get(_identity(status))


def inputs() -> list[str]:
    """Return the names of all files that were read within `record_inputs`, in the order of their first reading."""
    return list((_noted.get() or {}).values())


@contextmanager
def read_only_below(folders: Sequence[Path], trusted: Sequence[Path]) -> Iterator[None]:
    """Read no file outside of these folders within the `with` block; `open_file` raises PermissionError.

    Links that lead out of `folders` are not followed. Links in `trusted` folders may lead anywhere.
    """
    token = _readable.set(([folder.resolve() for folder in folders], [folder.absolute() for folder in trusted]))
    try:
        yield
    finally:
        _readable.reset(token)


def _opened_path(descriptor: int) -> str | None:
    """Return the path of an opened file without links, or None if the system does not report it."""
    try:
        return str(Path(f"/proc/self/fd/{descriptor}").readlink())
    except OSError:
        return None


def _require_readable(name: str, without_links: Callable[[str], str | None]) -> None:
    """Raise PermissionError if `read_only_below` excludes a file. `without_links` returns its real path, if known."""
    readable = _readable.get()
    real = None if readable is None else without_links(name)
    if readable is None or real is None:
        return
    folders, trusted = readable
    path = Path(name).absolute()
    is_trusted = ".." not in path.parts and any(path.is_relative_to(folder) for folder in trusted)
    if not is_trusted and not any(Path(real).is_relative_to(folder) for folder in folders):
        raise PermissionError(errno.EACCES, "this is outside of the folders that may be read", name)


def kind(mode: int) -> str:
    """Return the kind of a file that is not regular, such as `a pipe`, from its mode."""
    return _KINDS.get(stat.S_IFMT(mode), "something else")


def _identity(status: os.stat_result) -> _Identity:
    return status.st_dev, status.st_ino


def _require_regular(status: os.stat_result, name: str) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), name)
    if not stat.S_ISREG(status.st_mode):
        raise OSError(errno.EINVAL, f"this is {kind(status.st_mode)}; only regular files are read", name)


def _bounded(file: IO[bytes], name: str) -> bytes:
    pieces: list[bytes] = []
    rest = MOST_BYTES
    while rest >= 0:
        piece = file.read(min(rest + 1, 1 << 20))
        if piece is None:  # /proc has regular files that wait for more data.
            raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN), name)
        if not piece:
            return b"".join(pieces)
        pieces.append(piece)
        rest -= len(piece)
    raise OSError(errno.EFBIG, f"this has more than {MOST_BYTES >> 20} MB, the most that is read", name)
