"""A large set of states, seen from a few elements.

What an event is allowed to do depends on what it touches. To ask a set of all states about that means to walk through,
and often to make anew, the part of its diagram that lies above: with n events over n components that takes n² steps. A
projection leaves out what is above and what is below; both are found once for all events.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from robosc.synthesis.bdd import split

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element, Encoding

#: Up to how many different rests of the diagram are looked at below one level: with more, little is left out.
_WIDEST = 64


class Projection:
    """The projections of a set of states."""

    def __init__(self, states: Diagram, encoding: Encoding) -> None:
        self.states = states
        self._encoding = encoding

    def onto(self, elements: Iterable[Element]) -> Diagram:
        """A superset of the states that has the same values of the given elements, and of those between them.

        Inputs are no part of a state, and don't matter.
        """
        levels = [level for each in elements for level in self._levels_of.get(each, ())]
        if not levels:
            return self.states
        above, below = self._rests.get(min(levels)), self._cubes[max(levels)]
        return self.states if above is None else above.exists(below)

    @cached_property
    def _levels_of(self) -> dict[Element, tuple[int, ...]]:
        return {each.element: each.levels for each in self._encoding.layout.state}

    @cached_property
    def _levels(self) -> list[int]:
        """The levels of the state, from the top."""
        return sorted(level for each in self._levels_of.values() for level in each)

    @cached_property
    def _rests(self) -> dict[int, Diagram]:
        """For each level the states without what is above it; not for those below which the diagram is wide."""
        rests: dict[int, Diagram] = {}
        frontier = [self.states]
        for level in self._levels:
            rest = frontier[0]
            for each in frontier[1:]:
                rest |= each
            rests[level] = rest
            frontier = list(dict.fromkeys(part for each in frontier for part in split(each, level)))
            if len(frontier) > _WIDEST:
                break
        return rests

    @cached_property
    def _cubes(self) -> dict[int, Diagram]:
        """For each level all variables of the state below it."""
        cubes: dict[int, Diagram] = {}
        cube = self._encoding.diagrams.true
        for level in reversed(self._levels):
            cubes[level] = cube
            cube = self._encoding.diagrams.variable(level) & cube
        return cubes
