"""How many random models a test tries. `benchmarks/search.py` has the same tests search longer."""

from __future__ import annotations

import os

#: How many times as long the random searches are.
TIMES = int(os.environ.get("ROBOSC_SEARCH", "1"))


def examples(number: int) -> int:
    """The number of random models, where a run of all tests tries so many."""
    return number * TIMES
