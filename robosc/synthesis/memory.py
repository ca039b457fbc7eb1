"""Bounds the memory of the whole process, whoever takes it."""

from __future__ import annotations

import ctypes
import sys
from contextlib import contextmanager
from threading import Event, Lock, Thread, get_ident
from typing import TYPE_CHECKING

if sys.platform != "win32":
    import resource

if TYPE_CHECKING:
    from collections.abc import Iterator

#: So much more than the process has already may be taken in any case.
_LEAST = 64 << 20
_SECONDS = 0.05
_PAGE = 4096 if sys.platform == "win32" else resource.getpagesize()


class TooFewAddressesError(MemoryError):
    """The system allows the process too few addresses, however much memory there is."""


class _TooMuchError(MemoryError):
    """Raised from outside, so without a message."""


@contextmanager
def bounded(memory: int, what: str) -> Iterator[None]:
    """MemoryError in the `with` block soon after the whole process takes more bytes than `memory`.

    The message says that it was during `what`. Where the system does not tell what a process takes, nothing is bounded.
    The block must not have to be ended in order: the error may come anywhere in it.
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
        raise MemoryError(f"{what} needs more than {most >> 20} MiB, all things taken together") from None
    finally:
        with lock:
            ended.set()
            if struck:
                _raise_in(thread, None)
        watcher.join()


def resident() -> int | None:
    """The bytes of memory that the process has now; None where the system does not tell."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123  # no path that somebody names
            return int(file.read().split()[1]) * _PAGE
    except OSError:
        return None


def address_space() -> int | None:
    """How many bytes of addresses the process may still take; None where nothing bounds them."""
    if sys.platform == "win32":
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
    """Raises an error in a thread before its next step; None takes back one that is not raised yet."""
    ctypes.pythonapi.PyThreadState_SetAsyncExc(
        ctypes.c_ulong(thread), ctypes.py_object(error) if error is not None else None
    )
