"""Write files: all of them or none, only those that changed, and never outside of the named folder.

The folder is locked during the writing. New texts are staged in a folder inside of it, and then each is moved to its
place. A signal that would end the process waits until all are moved, or ends the staging. After SIGKILL each file is
complete, and the next call that writes to the folder finishes the work and removes the stage.
"""

from __future__ import annotations

import errno
import os
import re
import shutil
import signal
import stat
import sys
import tempfile
import threading
import time
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from robosc.base.files import reading

if sys.platform != "win32":
    import fcntl

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

#: Maximum time to wait for a folder to which another process writes.
PATIENCE_SECONDS = 60.0

_STAGE = re.compile(r"\.robosc-[a-z0-9_]{8}")
_ENDING_SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT") if hasattr(signal, name)
)


class OutputError(OSError):
    """The files could not be written, and none was; the message gives the reason."""


def write(trees: Mapping[Path, Mapping[str, str]]) -> list[Path]:
    """Write texts below folders, as UTF-8, and return the files that are new or different.

    Each folder comes with its files: relative POSIX path to text. Missing folders are created. A file with the same
    text keeps its time of change, and other files are not touched. Scripts (`#!`) become executable.

    Raises OutputError, before any file has changed, if a text cannot be staged; if a path leads out of its folder (by
    `..`, an absolute path or a link) or has two texts; if a file would replace an input (`files.reading.record_inputs`)
    or anything but a regular file; or if another process keeps writing to a folder.
    """
    with _Signals() as signals:
        try:
            return _write(trees, signals)
        except OutputError:
            raise
        except (OSError, RuntimeError) as error:  # `resolve` reports cyclic links as RuntimeError.
            raise OutputError(_reason(error)) from error


def write_file(path: str | os.PathLike[str], text: str) -> None:
    """Write a text to the file that a user named, as `write` does.

    A link is followed and stays. A character device, or a pipe with a reader, receives the text and stays. Raises
    OutputError.
    """
    try:
        refuse(path)
        if Path(path).exists() and not Path(path).is_file():
            _pour(path, text)
            return
        target = Path(os.path.realpath(path))
    except OutputError:
        raise
    except OSError as error:
        raise OutputError(_reason(error)) from error
    write({target.parent: {target.name: text}})


def refuse(path: str | os.PathLike[str]) -> None:
    """Raise OutputError if `write_file` would refuse a path because of the file that exists there."""
    try:
        status = Path(path).stat()
    except FileNotFoundError:
        return
    except (OSError, ValueError) as error:
        raise OutputError(_reason(error) if isinstance(error, OSError) else str(error)) from error
    if stat.S_ISCHR(status.st_mode) or stat.S_ISFIFO(status.st_mode):
        return
    _refuse_existing(Path(path), status)


def open_log(path: str | os.PathLike[str]) -> int:
    """Open a file for appending lines, and return its descriptor.

    The file may also be a character device, or a pipe with a reader. Raises OSError, also if the file was read within
    `robosc.base.files.reading.record_inputs`.
    """
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_NOCTTY", 0)
    descriptor = os.open(path, flags | getattr(os, "O_NONBLOCK", 0), 0o666)
    status = os.fstat(descriptor)
    fault = None
    if not any(test(status.st_mode) for test in (stat.S_ISREG, stat.S_ISCHR, stat.S_ISFIFO)):
        fault = f"this is {reading.kind(status.st_mode)}, no file for a log"
    elif reading.input_name(status) is not None:
        fault = "this call has read it: it cannot be the log, too"
    if fault is not None:
        os.close(descriptor)
        raise OSError(errno.EINVAL, fault, os.fspath(path))
    if sys.platform != "win32":
        os.set_blocking(descriptor, True)
    return descriptor


def _pour(path: str | os.PathLike[str], text: str) -> None:
    descriptor = os.open(path, os.O_WRONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0))
    if sys.platform != "win32":
        os.set_blocking(descriptor, True)
    with os.fdopen(descriptor, "wb") as file:
        file.write(text.encode())


def _write(trees: Mapping[Path, Mapping[str, str]], signals: _Signals) -> list[Path]:
    placed: dict[Path, dict[Path, str]] = {}
    texts: dict[Path, str] = {}
    for named, files in trees.items():
        folder = named.resolve()
        for name, text in files.items():
            path = _inside(folder, name)
            if path.is_dir() and not path.is_symlink():
                raise OutputError(f"{path} is a folder: a file of that name cannot be written")
            if texts.setdefault(path, text) != text:
                raise OutputError(f"{path} would be written twice, with different texts")
            placed.setdefault(folder, {})[path] = text
    with ExitStack() as new_folders, ExitStack() as locks:
        for folder in sorted(placed):
            locks.enter_context(_locked(folder, new_folders, signals))
            _remove_left_over(folder)
        changed = {
            folder: {path: text.encode() for path, text in files.items() if not _is(path, text.encode())}
            for folder, files in placed.items()
        }
        for path in (path for files in changed.values() for path in files):
            if os.path.lexists(path):
                _refuse_existing(path, path.lstat())
        _replace(changed, new_folders, signals)
    return [path for files in changed.values() for path in files]


def _inside(folder: Path, name: str) -> Path:
    """Return the path of a name below a folder. Raises OutputError if it is not inside of it."""
    relative = PurePosixPath(name)
    path = folder / relative
    if relative.is_absolute() or not relative.parts or ".." in relative.parts or "\\" in name:
        raise OutputError(f"{name} is not a path inside of the output folder")
    if not path.parent.resolve().is_relative_to(folder):
        raise OutputError(f"{path} leads out of {folder}: its path has a link")
    return path


def _refuse_existing(path: Path, status: os.stat_result) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise OutputError(f"{path} is a folder: a file of that name cannot be written")
    if not stat.S_ISREG(status.st_mode):
        what = "a link" if stat.S_ISLNK(status.st_mode) else reading.kind(status.st_mode)
        raise OutputError(f"{path} is {what}: only a regular file can be replaced")
    name = reading.input_name(status)
    if name is not None:
        also = "" if Path(name) == path else f", as {name}"
        raise OutputError(f"{path} was read by this call{also}: an input file is not overwritten")


@contextmanager
def _locked(folder: Path, new_folders: ExitStack, signals: _Signals) -> Iterator[None]:
    """Create a folder if it is missing, and lock it against other processes that use this function."""
    if sys.platform == "win32":
        _make(folder, new_folders)
        yield
        return
    until = time.monotonic() + PATIENCE_SECONDS
    while True:
        _make(folder, new_folders)
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            while not _lock(descriptor):
                signals.check()
                if time.monotonic() > until:
                    raise OutputError(f"another run of robosc still writes to {folder}: try again after it")
                time.sleep(0.02)
            if folder.exists() and os.path.samestat(os.fstat(descriptor), folder.stat()):
                yield
                return
            # The previous owner of the lock has removed the folder.
        finally:
            os.close(descriptor)


def _lock(descriptor: int) -> bool:
    """Return whether the folder is locked now; a file system without locks counts as locked."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        return error.errno in (errno.ENOLCK, errno.EBADF, errno.EINVAL, errno.ENOTSUP, errno.ENOSYS)
    return True


def _replace(changed: Mapping[Path, Mapping[Path, bytes]], new_folders: ExitStack, signals: _Signals) -> None:
    """Stage all files, then move each to its place; new folders stay once all files are staged."""
    with ExitStack() as stages:
        moves: list[tuple[Path, Path]] = []
        for folder, files in changed.items():
            if files:
                # Inside of the folder, this process may write, and a move stays within one file system.
                stage = Path(tempfile.mkdtemp(prefix=".robosc-", dir=folder))
                stages.callback(shutil.rmtree, stage, ignore_errors=True)
                moves += [(_staged(stage / str(number), file, files[file]), file) for number, file in enumerate(files)]
            signals.check()
        for _, path in moves:
            _make(path.parent, new_folders)
            if not path.parent.is_dir():
                raise OutputError(f"{path.parent} is not a folder: {path.name} cannot be written below it")
        signals.check()
        new_folders.pop_all()
        for staged, path in moves:
            staged.replace(path)


def _staged(staged: Path, path: Path, content: bytes) -> Path:
    """Write the content of a file to its stage, with the permissions that the file has or needs."""
    with staged.open("xb") as file:
        file.write(content)
    if path.exists():
        shutil.copymode(path, staged)
    if content.startswith(b"#!"):
        staged.chmod(staged.stat().st_mode | 0o111)
    return staged


def _remove_left_over(folder: Path) -> None:
    """Remove the stages that killed calls of this user have left."""
    with os.scandir(folder) as entries:
        stages = [Path(entry.path) for entry in entries if _STAGE.fullmatch(entry.name) and not entry.is_symlink()]
    for stage in stages:
        is_own = stage.is_dir() and (sys.platform == "win32" or stage.lstat().st_uid == os.geteuid())
        if is_own and all(path.name.isdecimal() for path in stage.iterdir()):
            shutil.rmtree(stage, ignore_errors=True)


def _make(folder: Path, new_folders: ExitStack) -> None:
    missing = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    for parent in reversed(missing):
        with suppress(FileExistsError):
            parent.mkdir()
            new_folders.callback(_remove_empty, parent)


def _remove_empty(folder: Path) -> None:
    with suppress(OSError):  # Another process may use it already.
        folder.rmdir()


def _is(path: Path, content: bytes) -> bool:
    """Return whether a path is a regular file with this content."""
    try:
        status = path.lstat()
        # Files of the kernel claim to be empty, and reading them may block.
        return stat.S_ISREG(status.st_mode) and status.st_size == len(content) and path.read_bytes() == content
    except (FileNotFoundError, NotADirectoryError):
        return False


def _reason(error: OSError | RuntimeError) -> str:
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    return str(error)


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Create a folder that is removed at the end of the `with` block, even after a signal that ends the process.

    The signal raises KeyboardInterrupt in the block, and takes effect after the folder is removed.
    """
    with _Signals() as signals:
        folder = Path(tempfile.mkdtemp(prefix="robosc-"))
        try:
            with signals.raised():
                yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)


class _Signals:
    """Delays signals that would end the process until the end of the `with` block.

    It uses handlers, because a mask does not keep a signal from the threads of libraries. Only the main thread receives
    signals.
    """

    def __init__(self) -> None:
        self._before: dict[int, Any] = {}
        self._heard: list[int] = []
        self._raises = False

    def __enter__(self) -> _Signals:
        if threading.current_thread() is threading.main_thread():
            for number in _ENDING_SIGNALS:
                before = signal.getsignal(number)
                if before is not signal.SIG_IGN and before is not None:
                    self._before[number] = before
                    signal.signal(number, self._hear)
        return self

    def _hear(self, number: int, _frame: object) -> None:
        self._heard.append(number)
        if self._raises:
            self._raises = False
            raise KeyboardInterrupt

    @contextmanager
    def raised(self) -> Iterator[None]:
        """Raise KeyboardInterrupt, once, if a signal arrives in the `with` block or is pending already."""
        if self._heard:
            raise KeyboardInterrupt
        self._raises = True
        try:
            yield
        finally:
            self._raises = False

    def check(self) -> None:
        """Raise OutputError if a signal is pending."""
        if self._heard:
            raise OutputError("the writing was interrupted")

    def __exit__(self, *_: object) -> None:
        for number, before in self._before.items():
            signal.signal(number, before)
        for number in dict.fromkeys(self._heard):
            signal.raise_signal(number)
