"""Effort of the tests: the number of random models, and the selection for a quick run."""

from __future__ import annotations

import os
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from robosc.analysis import verify
from robosc.analysis.verify import LoopEffort, c_validation, validate_model
from robosc.analysis.verify.loop_exploration import explore_loop
from robosc.analysis.verify.model_reading import Effort

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

#: Factor for the effort of random searches; `benchmarks/search.py` runs the same tests with more.
TIMES = int(os.environ.get("ROBOSC_SEARCH", "1"))


def examples(number: int) -> int:
    """Return the number of random models for a test that tries `number` in a run of all tests."""
    return number * TIMES


def slow_but(quick: Iterable[str], values: Iterable[Any]) -> list[Any]:
    """Return the values (names or paths) of a test's parameter, all marked slow except those with `quick` names."""
    names = set(quick)

    def is_quick(value: Any) -> bool:
        return (value.stem if isinstance(value, Path) else str(value)) in names

    return [value if is_quick(value) else pytest.param(value, marks=pytest.mark.slow) for value in values]


def matrix_but(chosen: Iterable[str], values: Iterable[Any]) -> list[Any]:
    """Return values like `slow_but`; only `benchmarks/matrix.py` tries those that are not chosen."""
    names, rest = set(chosen), [pytest.mark.slow, pytest.mark.matrix]
    return [pytest.param(value, marks=[pytest.mark.slow] if value in names else rest) for value in values]


def long_but(short: Iterable[str], names: Iterable[str]) -> list[str]:
    """Return the names of a test's parameter: the `short` ones in a run of all tests, all in a longer search."""
    chosen = set(short)
    return [name for name in names if TIMES > 1 or name in chosen]


@contextmanager
def less_effort() -> Iterator[None]:
    """Reduce the effort of `verify` to a tenth of the control loop's operations and of a large model's states.

    This is for models that are too large to enumerate, or whose constructs other models cover with the full effort.
    `benchmarks/search.py` verifies these with more effort, too.
    """
    loop = LoopEffort(LoopEffort.explored * TIMES // 10, LoopEffort.walked * TIMES // 10)
    model = Effort(states=Effort.states * TIMES // 10, random=Effort.random * TIMES // 10)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(c_validation, "explore_loop", lambda program: explore_loop(program, loop))
        patch.setattr(verify, "validate_model", lambda robot, plants: validate_model(robot, plants, model))
        yield
