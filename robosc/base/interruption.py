"""Interruption of long work by its caller: `checkpoint` in the work calls the caller's check.

A check returns if the work is to continue. It raises an exception if the result is no longer needed or the work has
taken too long. At a checkpoint no state is half changed.
"""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_CHECK: ContextVar[Callable[[], None] | None] = ContextVar("robosc_interruption", default=None)


@contextmanager
def call_at_checkpoints(check: Callable[[], None]) -> Iterator[None]:
    """Call `check` at every checkpoint of this thread within the `with` block."""
    token = _CHECK.set(check)
    try:
        yield
    finally:
        _CHECK.reset(token)


def current_check() -> Callable[[], None] | None:
    """Return the check of the innermost `call_at_checkpoints` block of this thread, or None."""
    return _CHECK.get()


def checkpoint() -> None:
    """Let the caller interrupt the work. Raises the exception of its check."""
    check = _CHECK.get()
    if check is not None:
        check()
