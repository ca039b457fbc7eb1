"""How deep functions may call themselves: expressions are trees, some of them thousands of operators deep.

Python's own calls take no more of the C stack for that, whatever thread they run on, as long as none of them goes
through C: what recurses over a model calls methods by their names, not `object(...)`, `map` or a generator.
"""

from __future__ import annotations

import sys
from contextlib import contextmanager
from threading import Lock
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Twenty for each of the 6,000 elements that may be inside each other (`robosc.metamodel.xmi.format.DEEPEST`).
_CALLS = 120_000

_lock = Lock()
_users = 0
_before = 0


@contextmanager
def deep_recursion(calls: int = _CALLS) -> Iterator[None]:
    """Room for so many calls inside each other while the `with` block or the decorated function runs.

    Python has one limit for all threads: it is set back when the last one has left.
    """
    global _users, _before  # noqa: PLW0603  # as the limit itself
    with _lock:
        if not _users:
            _before = sys.getrecursionlimit()
        _users += 1
        sys.setrecursionlimit(max(sys.getrecursionlimit(), calls))
    try:
        yield
    finally:
        with _lock:
            _users -= 1
            if not _users:
                sys.setrecursionlimit(_before)
