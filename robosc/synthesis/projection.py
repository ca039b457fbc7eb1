"""Large sets of states, restricted to few elements.

The permission of an event depends on the elements that it touches. An operation on the set of all states walks through,
and often rebuilds, the part of its diagram that lies above these elements: with n events over n components, that takes
n² steps. A projection leaves out the parts above and below. Both are computed once for all events.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from functools import cached_property
from typing import TYPE_CHECKING

from robosc.synthesis.bdd import split

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Domain, Element, Encoding

#: Maximum number of different subdiagrams examined below one level. With more, little can be left out.
_WIDEST = 64


class Projection:
    """A set of states and its projections. Inputs are no part of a state and have no effect here.

    Levels are numbered from 0 at the top and count only those of the state.
    """

    def __init__(self, states: Diagram, encoding: Encoding) -> None:
        self.states = states
        self._encoding = encoding
        self._domains = encoding.layout.state
        self._levels = sorted(level for domain in self._domains for level in domain.levels)

    def onto(self, elements: Iterable[Element]) -> Diagram:
        """Return a superset of the states that agrees with them between the levels of the elements.

        The levels above the first of these elements and those below the last are quantified.
        """
        first, last = self._range(elements)
        return self._below[first].exists(self._cubes[last]) if first < len(self._below) else self.states

    def factor(self, elements: Iterable[Element]) -> tuple[Diagram, Sequence[Domain]]:
        """Return a small list of domains that contains the elements, and the states restricted to it.

        The set of states is the product of this restriction and a set over the other domains.
        """
        first, last = self._range(elements)
        first = self._cut_levels[bisect_right(self._cut_levels, first) - 1]
        below = bisect_left(self._cut_levels, last)
        last = self._cut_levels[below] if below < len(self._cut_levels) else len(self._levels)
        domains = self._domains[bisect_left(self._starts, first) : bisect_left(self._starts, last)]
        return self._below[first].exists(self._cubes[last]), domains

    def _range(self, elements: Iterable[Element]) -> tuple[int, int]:
        """Return the first level of the elements and the level after their last."""
        ranges = [self._ranges[element] for element in elements if element in self._ranges]
        return min((first for first, _ in ranges), default=0), max((last for _, last in ranges), default=0)

    @cached_property
    def _ranges(self) -> dict[Element, tuple[int, int]]:
        number = {level: index for index, level in enumerate(self._levels)}
        return {
            domain.element: (number[domain.levels[0]], number[domain.levels[-1]] + 1)
            for domain in self._domains
            if domain.levels
        }

    @cached_property
    def _starts(self) -> list[int]:
        """First level of each domain, ascending; a domain without levels has that of the one before."""
        starts = [0]
        for domain in self._domains:
            starts.append(self._ranges.get(domain.element, (starts[-1],))[0])
        return sorted(starts[1:])

    @cached_property
    def _frontiers(self) -> list[tuple[Diagram, ...]]:
        """Subdiagrams of the states at each level or below, down to the level with too many of them."""
        frontiers = []
        frontier: tuple[Diagram, ...] = (self.states,)
        for level in self._levels:
            frontiers.append(frontier)
            parts = dict.fromkeys(part for diagram in frontier for part in split(diagram, level))
            frontier = tuple(part for part in parts if part.satisfiable())
            if len(frontier) > _WIDEST:
                break
        return frontiers

    @cached_property
    def _below(self) -> list[Diagram]:
        """For each of these levels, the states with all levels above it quantified."""
        return list(map(self._encoding.diagrams.any_of, self._frontiers)) or [self.states]

    @cached_property
    def _cut_levels(self) -> list[int]:
        """Levels at which the states are a product of a set above and one below, with no domain in both."""
        torn = {level for first, last in self._ranges.values() for level in range(first + 1, last)}
        alone = (level for level, frontier in enumerate(self._frontiers) if len(frontier) == 1)
        return [level for level in alone if level not in torn] or [0]

    @cached_property
    def _cubes(self) -> list[Diagram]:
        """For each level, all variables from there on; at the end, none."""
        cubes = [self._encoding.diagrams.true]
        for level in reversed(self._levels):
            cubes.append(self._encoding.diagrams.variable(level) & cubes[-1])
        return cubes[::-1]
