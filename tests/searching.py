"""How much a test looks at: how many random models, and what of it in a quick run."""

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

#: How many times as long the random searches are: `benchmarks/search.py` has the same tests search longer.
TIMES = int(os.environ.get("ROBOSC_SEARCH", "1"))


def examples(number: int) -> int:
    """The number of random models, where a run of all tests tries so many."""
    return number * TIMES


def slow_but(quick: Iterable[str], values: Iterable[Any]) -> list[Any]:
    """Values for the parameter of a test: names, or paths, all of them marked slow but those with the `quick` names."""
    names = set(quick)

    def is_quick(value: Any) -> bool:
        return (value.stem if isinstance(value, Path) else str(value)) in names

    return [value if is_quick(value) else pytest.param(value, marks=pytest.mark.slow) for value in values]


def matrix_but(chosen: Iterable[str], values: Iterable[Any]) -> list[Any]:
    """As `slow_but`; those that are not chosen only `benchmarks/matrix.py` tries."""
    names, rest = set(chosen), [pytest.mark.slow, pytest.mark.matrix]
    return [pytest.param(value, marks=[pytest.mark.slow] if value in names else rest) for value in values]


def long_but(short: Iterable[str], names: Iterable[str]) -> list[str]:
    """Names for the parameter of a test: the `short` ones where a run of all tests is made, all in a longer search."""
    chosen = set(short)
    return [name for name in names if TIMES > 1 or name in chosen]


@contextmanager
def less_effort() -> Iterator[None]:
    """While it lasts `verify` tries a tenth of the operations of a control loop, and of the states of a large model.

    For models that are too large for all their states in any case, or whose constructs others have that are tried with
    all effort. In `benchmarks/search.py` these are, too.
    """
    loop = LoopEffort(LoopEffort.explored * TIMES // 10, LoopEffort.walked * TIMES // 10)
    model = Effort(states=Effort.states * TIMES // 10, random=Effort.random * TIMES // 10)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(c_validation, "explore_loop", lambda program: explore_loop(program, loop))
        patch.setattr(verify, "validate_model", lambda robot, plants: validate_model(robot, plants, model))
        yield
