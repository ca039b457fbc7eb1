"""An interrupt ends the program as one, whatever becomes of the exception that tells of it.

Python raises KeyboardInterrupt wherever it happens to be: from within an import it may come out as another exception,
from within a callback not at all.
"""

from __future__ import annotations

import signal
from typing import Any

_noted: list[int] = []


def note() -> None:
    """From now on interrupts are noted, too; not where the caller wants them to be ignored."""
    if signal.getsignal(signal.SIGINT) in (signal.SIG_DFL, signal.default_int_handler):
        signal.signal(signal.SIGINT, _interrupt)


def leave() -> None:
    """From now on they are none of ours: a ROS node has its own way to end."""
    if signal.getsignal(signal.SIGINT) is _interrupt:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def happened() -> bool:
    """Whether there was one."""
    return bool(_noted)


def check() -> None:
    """Raises KeyboardInterrupt, again, if there was one: what follows is not to be done any more."""
    if _noted:
        raise KeyboardInterrupt


def _interrupt(number: int, frame: Any) -> None:
    _noted.append(number)
    signal.default_int_handler(number, frame)
