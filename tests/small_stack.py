"""Work in a thread as small as those of some servers and of macOS."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

STACK = 512 << 10
_Result = TypeVar("_Result")


def on_small_stack(work: Callable[[], _Result]) -> _Result:
    """What `work` returns in a thread with a stack of 512 KiB; what it raises is raised here."""
    before = threading.stack_size(STACK)
    try:
        with ThreadPoolExecutor(1) as threads:
            return threads.submit(work).result()
    finally:
        threading.stack_size(before)
