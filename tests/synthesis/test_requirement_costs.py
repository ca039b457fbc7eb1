"""What requirements cost synthesis: counts, which are the same on each machine."""

import pytest

from benchmarks.requirement_costs import KINDS, synthesis_of
from tests.searching import slow_but


@pytest.mark.parametrize("kind", slow_but([*KINDS][:1], KINDS))
def test_the_search_grows_with_the_robot_and_not_with_its_states(kind: str) -> None:
    """As without: twice the stations have more than the square of the states, and take twice the operations."""
    small, large = synthesis_of(5, kind), synthesis_of(10, kind)
    assert large.controlled_states > small.controlled_states**2 / 2
    assert 0 < large.statistics.operations <= 2.6 * small.statistics.operations
