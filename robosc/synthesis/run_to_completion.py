"""Run to completion: how many internal events may happen in a row until a state is quiescent, if one ever is."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

from robosc.semantics.roles import SILENT
from robosc.synthesis.encoding import referenced

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from robosc.metamodel import sct
    from robosc.synthesis.bdd import Diagram, Diagrams
    from robosc.synthesis.encoding import Element
    from robosc.synthesis.relation import EventRelation, Step

#: What looking at a step costs beside the nodes of the states.
_OVERHEAD = 100


@dataclass(frozen=True)
class InternalEvent:
    """An internal event under its supervisor.

    `allowed` is where it can happen, `step` what it does there (None: nothing), `touched` all that it reads or changes.
    """

    relation: EventRelation
    allowed: Diagram
    step: Step | None
    touched: frozenset[Element]

    def before(self, states: Diagram) -> Diagram:
        """Those states in which the event can happen so that one of them follows."""
        return states & (self.allowed if self.step is None else self.step.preimage(states))


def internal_events(
    events: Iterable[tuple[EventRelation, Diagram, Step | None]], guards: Iterable[sct.EventGuard]
) -> list[InternalEvent]:
    """The internal ones of events, each given with where it can happen under its guard and what it does there."""
    guard_of = {guard.event: guard for guard in guards}
    found = []
    for relation, allowed, step in events:
        if relation.event.kind in SILENT:
            guard = guard_of.get(relation.event)
            parts = (guard.requirement, guard.synthesis) if guard else ()
            read = {element for part in parts for element in referenced(part)}
            found.append(InternalEvent(relation, allowed, step, relation.touched | read))
    return found


@dataclass(frozen=True)
class Completion:
    """Whether internal events come to an end.

    `bound`: so many can happen in a row at most; None where there is no bound, or none was found with the effort
    allowed. `divergent` are the states from which they can happen for ever.
    """

    bound: int | None
    divergent: Diagram


def completion(diagrams: Diagrams, events: Sequence[InternalEvent], states: Diagram, effort: int) -> Completion:
    """What can happen in a row from the states, which hold all that the events lead to.

    Events that have nothing to do with each other don't delay each other: the longest run of all is no longer than
    those of the groups together, and it is endless where one of these is. `effort` bounds the work, in nodes looked at.
    """
    bound, divergent = 0, diagrams.false
    for group in independent_groups(events):
        anywhere = _longest_anywhere(diagrams, group)
        if anywhere is not None:
            bound += anywhere
            continue
        previous = states
        for longer in runs(diagrams, group, states):
            if not longer.satisfiable():
                break
            if longer == previous:
                divergent |= longer
                break
            effort -= len(group) * (longer.node_count() + _OVERHEAD)
            if effort < 0:
                return Completion(None, divergent)
            previous = longer
            bound += 1
    return Completion(None if divergent.satisfiable() else bound, divergent)


def _longest_anywhere(diagrams: Diagrams, group: Sequence[InternalEvent]) -> int | None:
    """How many can happen in a row from any state, reachable or not, unless it is more than there are events.

    That is mostly so, and seen without the large diagram of the reachable states.
    """
    for length, longer in enumerate(islice(runs(diagrams, group, diagrams.true), len(group) + 1)):
        if not longer.satisfiable():
            return length
    return None


def runs(diagrams: Diagrams, events: Sequence[InternalEvent], states: Diagram) -> Iterator[Diagram]:
    """The states from which one event can happen, two in a row, three and so on: each set holds the next one."""
    while True:
        before = diagrams.false
        for event in events:
            before |= event.before(states)
            diagrams.tidy()
        states = before
        yield states


def independent_groups(events: Sequence[InternalEvent]) -> list[list[InternalEvent]]:
    """The events so that those of one group change nothing that those of another touch."""
    changed = {element for event in events for element in event.relation.changed}
    known: dict[Element, Element] = {}

    def first(element: Element) -> Element:
        while (before := known.setdefault(element, element)) is not element:
            known[element] = element = known[before]
        return element

    for event in events:
        shared = [first(element) for element in event.touched & changed]
        for element in shared:
            known[first(element)] = first(shared[0])
    found: dict[object, list[InternalEvent]] = {}
    for event in events:
        shared = [first(element) for element in event.touched & changed]
        found.setdefault(shared[0] if shared else event, []).append(event)
    return list(found.values())
