"""Edges of an event in a plant, tried in order."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import engine, sct
from robosc.model.semantics.edges import origin

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2m.sct_to_engine.collect_events import Edges
    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.m2m.sct_to_engine.terms import Term, Terms


class Alternatives:
    """Edges of an event in a plant. They are tried in order, and one of them is taken."""

    def __init__(self, plant: sct.Plant, edges: Edges, lower: Lowering) -> None:
        self._plant = plant
        self._lower = lower
        self._untried = {location: len(leaving) for location, leaving in edges.items()}
        self._denied: dict[sct.Location | None, set[Term]] = {location: set() for location in edges}
        self._ruled_out: dict[sct.Location | None, list[Term]] = {location: [] for location in edges}

    def one_of(self, chosen: Sequence[sct.Edge]) -> Term:
        """Return the condition that one of the edges is taken and none of those tried before.

        Omits parts that the earlier edges already imply.
        """
        terms = self._lower.terms
        left: dict[sct.Location | None, list[Term]] = {}
        for edge in chosen:
            location = origin(edge)
            self._untried[location] -= 1
            guard = terms.junction(engine.And, [self._lower(edge.guard), *self._ruled_out[location]])
            left.setdefault(location, []).append(remaining_guard(guard, self._denied[location], terms))
        guards = {
            location: terms.junction(engine.Or, conditions) if self._untried[location] else terms.true
            for location, conditions in left.items()
        }
        return self._lower.where(self._plant, guards, list(self._untried))

    def rule_out(self, chosen: Sequence[sct.Edge]) -> None:
        """Exclude the states in which one of these edges may be taken from all later edges."""
        for edge in chosen:
            self._ruled_out[origin(edge)].append(self._lower(edge.guard, positive=False))


def remaining_guard(guard: Term, denied: set[Term], terms: Terms) -> Term:
    """Return the part of a guard that the earlier guards in `denied` do not imply. Adds its opposite to `denied`."""
    parts = guard.operands if guard.operator is engine.And else (guard,)
    left = terms.junction(engine.And, [part for part in parts if part not in denied])
    denied |= {terms.opposite(part) for part in (left.operands if left.operator is engine.Or else (left,))}
    return left


def exclusive(edges: Edges, lower: Lowering) -> bool:
    """Return whether the guards of each location exclude each other: each includes the denials of those before it."""
    for leaving in edges.values():
        denied: set[Term] = set()
        for edge in leaving:
            guard = lower(edge.guard)
            if not denied.issubset(guard.operands if guard.operator is engine.And else (guard,)):
                return False
            remaining_guard(guard, denied, lower.terms)
    return True
