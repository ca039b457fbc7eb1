"""Work in a thread with a small stack, as in some servers and in macOS."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

STACK = 512 << 10
_Result = TypeVar("_Result")


def on_small_stack(work: Callable[[], _Result]) -> _Result:
    """Return the result of `work` in a thread with a stack of 512 KiB, or raise its exception."""
    before = threading.stack_size(STACK)
    try:
        with ThreadPoolExecutor(1) as threads:
            return threads.submit(work).result()
    finally:
        threading.stack_size(before)
