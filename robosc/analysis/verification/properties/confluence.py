"""Confluence: in whatever order silent events happen, they come to rest in the same state.

The term is that of Reijnen, Hofkamp, van de Mortel-Fronczak, Reniers, Rooda: Finite response and confluence of
state-based supervisory controllers, CASE 2019. Where pairs of events are looked at there, it is decided here.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from itertools import chain, combinations
from typing import TYPE_CHECKING

from robosc.analysis.verification.loop import asked_of_the_loop
from robosc.analysis.verification.system import counted, steps
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.synthesis.fixpoint import coreachable
from robosc.synthesis.paths import shortest_path
from robosc.synthesis.settling import groups

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.analysis.verification.system import SupervisedSystem
    from robosc.metamodel import sct
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.paths import Path
    from robosc.synthesis.settling import SilentEvent

NAME = "confluence"


#: How many resets of what has failed may be among silent events that have to do with each other: all ways to hold them
#: back are looked at.
_HELD = 6


@asked_of_the_loop(NAME)
def confluence(system: SupervisedSystem) -> Verdict:
    """From every state that the control loop comes to silent events lead to no more than one in which it rests.

    Events that have nothing to do with each other can't lead elsewhere by taking turns: they are looked at apart.
    """
    loop = system.loop
    resting = counted(system.encoding.count(loop.rests), "of them at rest").removesuffix("s")
    evidence = f"{counted(system.encoding.count(loop.states), 'state')}, {resting}"
    skipped = False
    for group in groups(system.silent):
        held = {each.relation.event: loop.held(each.relation.event) for each in group}
        resets = [event for event, states in held.items() if states.satisfiable()]
        # A single event has no order.
        if len(group) == 1:
            continue
        skipped = skipped or len(resets) > _HELD
        for chosen in _subsets(resets[:_HELD]):
            torn = _Torn(system, [_held_back(each, held) if each.relation.event in chosen else each for each in group])
            if torn.states.satisfiable():
                return torn.verdict(evidence)
    if skipped:
        return Verdict(NAME, Outcome.SKIPPED, evidence, "too many resets have to do with each other")
    return Verdict(NAME, Outcome.PROVED, evidence)


def _subsets(events: Sequence[sct.Event]) -> Iterator[tuple[sct.Event, ...]]:
    return chain.from_iterable(combinations(events, size) for size in range(len(events) + 1))


def _held_back(silent: SilentEvent, held: Mapping[sct.Event, Diagram]) -> SilentEvent:
    """A reset that happens only where nothing holds it back."""
    allowed = silent.allowed & ~held[silent.relation.event]
    return replace(silent, allowed=allowed, step=silent.relation.step_where(allowed))


class _Torn:
    """The states from which events that have to do with each other come to rest in several."""

    def __init__(self, system: SupervisedSystem, events: Sequence[SilentEvent]) -> None:
        self._system = system
        self._moves = [(each.relation, each.step) for each in events if each.step is not None]
        self._resting = system.loop.states
        for each in events:
            self._resting &= ~each.allowed

    @cached_property
    def states(self) -> Diagram:
        """Their resting states differ in some bit, which one of the events changed."""
        system, torn = self._system, self._system.diagrams.false
        for element in dict.fromkeys(each for relation, _ in self._moves for each in relation.changed):
            for bit in system.encoding.bits(element):
                one, other = (
                    coreachable(system.diagrams, steps(self._moves), self._resting & value, system.loop.states)
                    for value in (bit, ~bit)
                )
                torn |= one & other
        return torn

    def verdict(self, evidence: str) -> Verdict:
        """That there are some, with two ways from one of them."""
        system = self._system
        path = system.loop.path_to(self.states)
        one = self._way(path, self._resting)
        other = self._way(path, self._resting & ~system.last(one))
        return Verdict(
            NAME,
            Outcome.REFUTED,
            evidence,
            _difference(system, one, other),
            system.trace(path),
            system.trace(one),
            system.trace(other),
        )

    def _way(self, before: Path, goal: Diagram) -> Path:
        system = self._system
        way = shortest_path(system.encoding, self._moves, system.last(before), goal, system.loop.states)
        assert way is not None
        return way


def _difference(system: SupervisedSystem, one: Path, other: Path) -> str:
    ends = one.states[-1], other.states[-1]
    differing = [element for element in ends[0] if ends[0][element] != ends[1][element]]
    first, second = (system.where(each, differing) for each in ends)
    return f"depending on their order, silent events end where `{first}` or where `{second}`"
