"""The cost of requirements in synthesis, as counts that are the same on every machine."""

import pytest

from benchmarks.requirement_costs import KINDS, synthesis_of
from tests.searching import slow_but


@pytest.mark.parametrize("kind", slow_but([*KINDS][:1], KINDS))
def test_the_search_grows_with_the_robot_and_not_with_its_states(kind: str) -> None:
    """Twice the stations take twice the operations, as without requirements.

    The number of states grows to its square.
    """
    small, large = synthesis_of(5, kind), synthesis_of(10, kind)
    assert large.controlled_states > small.controlled_states**2 / 2
    assert 0 < large.statistics.operations <= 2.6 * small.statistics.operations
