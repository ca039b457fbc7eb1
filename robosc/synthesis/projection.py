"""A large set of states, seen from a few elements.

What an event is allowed to do depends on what it touches. To ask a set of all states about that means to walk through,
and often to make anew, the part of its diagram that lies above: with n events over n components that takes n² steps. So
what is above and what is below is left out; both are found once for all events.
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

#: Up to how many different subdiagrams are looked at below one level: with more, little is left out.
_WIDEST = 64


class Projection:
    """A set of states and what is seen of it. Inputs are no part of a state: they don't matter.

    Levels are numbered here from 0 at the top, those of the state alone.
    """

    def __init__(self, states: Diagram, encoding: Encoding) -> None:
        self.states = states
        self._encoding = encoding
        self._domains = encoding.layout.state
        self._levels = sorted(level for domain in self._domains for level in domain.levels)

    def onto(self, elements: Iterable[Element]) -> Diagram:
        """A superset of the states: all elements whose levels lie between those of the given ones have the same values.

        The levels above the first of them are quantified, and those below the last.
        """
        first, last = self._range(elements)
        return self._below[first].exists(self._cubes[last]) if first < len(self._below) else self.states

    def factor(self, elements: Iterable[Element]) -> tuple[Diagram, Sequence[Domain]]:
        """Some domains that hold the elements, and the states as far as these are concerned.

        All states are the combinations of these with what the other domains may have. As few domains as are found.
        """
        first, last = self._range(elements)
        first = self._cut_levels[bisect_right(self._cut_levels, first) - 1]
        below = bisect_left(self._cut_levels, last)
        last = self._cut_levels[below] if below < len(self._cut_levels) else len(self._levels)
        domains = self._domains[bisect_left(self._starts, first) : bisect_left(self._starts, last)]
        return self._below[first].exists(self._cubes[last]), domains

    def _range(self, elements: Iterable[Element]) -> tuple[int, int]:
        """The first level of the elements and the one after their last."""
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
        """The first level of each domain, in ascending order: of one without levels that of the one before."""
        starts = [0]
        for domain in self._domains:
            starts.append(self._ranges.get(domain.element, (starts[-1],))[0])
        return sorted(starts[1:])

    @cached_property
    def _frontiers(self) -> list[tuple[Diagram, ...]]:
        """The subdiagrams of the states that begin at each level or below, down to a level where they are too many."""
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
        """For each of these levels the states with all levels above it quantified."""
        return list(map(self._encoding.diagrams.any_of, self._frontiers)) or [self.states]

    @cached_property
    def _cut_levels(self) -> list[int]:
        """The levels at which the states are a product of a set above and one below, no domain having bits in both."""
        torn = {level for first, last in self._ranges.values() for level in range(first + 1, last)}
        alone = (level for level, frontier in enumerate(self._frontiers) if len(frontier) == 1)
        return [level for level in alone if level not in torn] or [0]

    @cached_property
    def _cubes(self) -> list[Diagram]:
        """For each level all variables from there on; at the end none."""
        cubes = [self._encoding.diagrams.true]
        for level in reversed(self._levels):
            cubes.append(self._encoding.diagrams.variable(level) & cubes[-1])
        return cubes[::-1]
