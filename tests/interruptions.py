"""Interruption of a process by a signal just before its n-th change of the file system."""

import os
import signal
from collections.abc import Callable, Iterator
from typing import Any, NoReturn

#: The functions of `os` with which pathlib, tempfile and shutil also create, move and remove files.
CHANGES = ("mkdir", "replace", "unlink", "rmdir")

_MOST = 100


def interrupted(action: Callable[[], object], number: int, sent: signal.Signals, *, again: bool = False) -> int:
    """Run an action in a process that gets a signal before its n-th change (from 1), and return the exit status.

    With `again` the process gets the signal before each later change, too. The status is 0 after the end of the action,
    minus the number of the signal that killed the process, 130 for KeyboardInterrupt, the value of SystemExit, or 1 for
    another exception.
    """
    process = os.fork()
    if process == 0:
        _run(action, number, sent, again=again)
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


def interruptions(run: Callable[[int], int]) -> Iterator[tuple[int, int]]:
    """Call `run` with 1, 2, 3, ... until it returns 0, and yield each earlier number with its result."""
    for number in range(1, _MOST + 1):
        status = run(number)
        if status == 0:
            return
        yield number, status
    raise AssertionError(f"it does not end well without a signal at its first {_MOST} changes, either: {status}")


def _run(action: Callable[[], object], number: int, sent: signal.Signals, *, again: bool) -> NoReturn:
    status = 1
    try:
        # The tests may run with ignored signals: shells do that for `&`, and `nohup` does.
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
