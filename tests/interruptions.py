"""Sends a signal to a process of its own just before it changes the file system for the n-th time."""

import os
import signal
from collections.abc import Callable, Iterator
from typing import Any, NoReturn

#: The functions of `os` through which files are made, moved and removed, by pathlib, tempfile and shutil, too.
CHANGES = ("mkdir", "replace", "unlink", "rmdir")

_MOST = 100


def interrupted(action: Callable[[], object], number: int, sent: signal.Signals, *, again: bool = False) -> int:
    """How a process that runs an action ends when it gets a signal before its n-th change, counted from 1.

    With `again` it gets the signal before each change that follows, too. 0: the action came to its end; minus the
    number of a signal: that has killed it; 130: KeyboardInterrupt; what SystemExit says; 1: another exception.
    """
    process = os.fork()
    if process == 0:
        _run(action, number, sent, again=again)
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


def interruptions(run: Callable[[int], int]) -> Iterator[tuple[int, int]]:
    """Calls `run` with 1, 2, 3, ... until it answers 0, and yields each number with the answer before that."""
    for number in range(1, _MOST + 1):
        status = run(number)
        if status == 0:
            return
        yield number, status
    raise AssertionError(f"it does not end well without a signal at its first {_MOST} changes, either: {status}")


def _run(action: Callable[[], object], number: int, sent: signal.Signals, *, again: bool) -> NoReturn:
    status = 1
    try:
        # Also where the tests were started with signals ignored, as shells do behind `&` and `nohup` does.
        for heeded in (signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM):
            signal.signal(heeded, signal.SIG_DFL)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        _count(number, sent, again=again)
        action()
        status = 0
    except KeyboardInterrupt:
        status = 130
    except SystemExit as end:
        status = 0 if end.code is None else end.code if isinstance(end.code, int) else 1
    finally:
        os._exit(status)


def _count(number: int, sent: signal.Signals, *, again: bool) -> None:
    done = 0

    def counted(change: Callable[..., Any]) -> Callable[..., Any]:
        def changed(*arguments: Any, **options: Any) -> Any:
            nonlocal done
            done += 1
            if done == number or (again and done > number):
                os.kill(os.getpid(), sent)
            return change(*arguments, **options)

        return changed

    for name in CHANGES:
        setattr(os, name, counted(getattr(os, name)))
