"""Records interrupts, so that the program ends with the right status even if the exception is lost.

Python raises KeyboardInterrupt in whatever code is running: an import may turn it into another exception, and a
callback may swallow it.
"""

from __future__ import annotations

import signal
from typing import Any

_noted: list[int] = []


def note() -> None:
    """Record interrupts from now on, unless the caller ignores them."""
    if signal.getsignal(signal.SIGINT) in (signal.SIG_DFL, signal.default_int_handler):
        signal.signal(signal.SIGINT, _interrupt)


def leave() -> None:
    """Stop recording interrupts: a ROS node handles them itself."""
    if signal.getsignal(signal.SIGINT) is _interrupt:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def was_interrupted() -> bool:
    """Return whether an interrupt was recorded."""
    return bool(_noted)


def check() -> None:
    """Raise KeyboardInterrupt again if an interrupt was recorded, before an action that must not follow it."""
    if _noted:
        raise KeyboardInterrupt


def _interrupt(number: int, frame: Any) -> None:
    _noted.append(number)
    signal.default_int_handler(number, frame)
