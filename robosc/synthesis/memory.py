"""Memory limit for the whole process."""

from __future__ import annotations

import ctypes
import sys
from contextlib import contextmanager
from threading import Event, Lock, Thread, get_ident
from typing import TYPE_CHECKING

if sys.platform not in {"win32", "emscripten"}:
    import resource

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Minimum additional memory that the process may take, in bytes.
_LEAST = 64 << 20
_SECONDS = 0.05
_PAGE = 4096 if sys.platform in {"win32", "emscripten"} else resource.getpagesize()


class TooFewAddressesError(MemoryError):
    """The address space limit of the process is too small, regardless of the available memory."""


class _TooMuchError(MemoryError):
    """Asynchronous error without a message, raised by the watching thread."""


@contextmanager
def limit_memory(memory: int, what: str) -> Iterator[None]:
    """Raise MemoryError in the `with` block soon after the whole process takes more bytes than `memory`.

    The message names the activity `what`. If the system does not report the memory of a process, nothing is bounded.
    The error may come anywhere in the block, so the block must not need an orderly end.
    """
    start = resident()
    if start is None:
        yield
        return
    most = max(memory, start + _LEAST)
    thread, ended, lock = get_ident(), Event(), Lock()
    struck = False

    def watch() -> None:
        nonlocal struck
        while not ended.wait(_SECONDS):
            if (resident() or 0) > most:
                with lock:
                    if not ended.is_set():
                        struck = True
                        _raise_in(thread, _TooMuchError)
                return

    watcher = Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    except _TooMuchError:
        raise MemoryError(f"{what} needs more than {most >> 20} MiB in total") from None
    finally:
        with lock:
            ended.set()
            if struck:
                _raise_in(thread, None)
        watcher.join()


def resident() -> int | None:
    """Return the current memory of the process in bytes, or None if the system does not report it."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123  # no path of the user
            return int(file.read().split()[1]) * _PAGE
    except OSError:
        return None


def address_space() -> int | None:
    """Return the remaining address space of the process in bytes, or None if it is unlimited."""
    if sys.platform in {"win32", "emscripten"}:
        return None
    most = resource.getrlimit(resource.RLIMIT_AS)[0]
    if most == resource.RLIM_INFINITY:
        return None
    try:
        with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123  # as above
            return most - int(file.read().split()[0]) * _PAGE
    except OSError:
        return most


def _raise_in(thread: int, error: type[BaseException] | None) -> None:
    """Raise an error in a thread before its next step; None cancels an error that is still pending."""
    ctypes.pythonapi.PyThreadState_SetAsyncExc(
        ctypes.c_ulong(thread), ctypes.py_object(error) if error is not None else None
    )
