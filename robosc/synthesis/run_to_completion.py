"""Run to completion: the maximum number of consecutive internal events before a state is quiescent."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

from robosc.model.semantics.roles import SILENT
from robosc.synthesis.encoding import referenced_elements

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from robosc.model import sct
    from robosc.synthesis.bdd import Diagram, Diagrams
    from robosc.synthesis.encoding import Element
    from robosc.synthesis.relation import EventRelation, SymbolicStep

#: Constant cost of examining a step, in nodes, in addition to the nodes of the states.
_OVERHEAD = 100


@dataclass(frozen=True)
class InternalEvent:
    """Internal event under its supervisor.

    `allowed` are the states in which it can happen. `step` is its effect there; None for no effect. `touched` are all
    elements that it reads or changes.
    """

    relation: EventRelation
    allowed: Diagram
    step: SymbolicStep | None
    touched: frozenset[Element]

    def before(self, states: Diagram) -> Diagram:
        """Return the states among `states` in which the event can happen and lead to one of `states`."""
        return states & (self.allowed if self.step is None else self.step.preimage(states))


def internal_events(
    events: Iterable[tuple[EventRelation, Diagram, SymbolicStep | None]], guards: Iterable[sct.EventGuard]
) -> list[InternalEvent]:
    """Return the internal events; each of `events` comes with its allowed states and its step."""
    guard_of = {guard.event: guard for guard in guards}
    internal = []
    for relation, allowed, step in events:
        if relation.event.kind in SILENT:
            guard = guard_of.get(relation.event)
            parts = (guard.requirement, guard.synthesis) if guard else ()
            elements = {element for part in parts for element in referenced_elements(part)}
            internal.append(InternalEvent(relation, allowed, step, relation.touched | elements))
    return internal


@dataclass(frozen=True)
class Completion:
    """Bound on sequences of internal events.

    `bound` is the maximum number of consecutive internal events. It is None if there is no bound, or if the effort
    limit is reached first. `divergent` are the states from which internal events can happen for ever.
    """

    bound: int | None
    divergent: Diagram


def completion(diagrams: Diagrams, events: Sequence[InternalEvent], states: Diagram, effort: int) -> Completion:
    """Bound the sequences of internal events from `states`, a set that the events do not leave.

    Independent events do not delay each other. The longest sequence is therefore no longer than those of the groups
    together, and it is endless if that of a group is. `effort` is the maximum number of visited nodes.
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
    """Return the maximum number of consecutive events from any state, reachable or not.

    Returns None if it exceeds the number of events. Mostly it does not, and the check does not need the large diagram
    of the reachable states.
    """
    for length, longer in enumerate(islice(runs(diagrams, group, diagrams.true), len(group) + 1)):
        if not longer.satisfiable():
            return length
    return None


def runs(diagrams: Diagrams, events: Sequence[InternalEvent], states: Diagram) -> Iterator[Diagram]:
    """Yield the states in which one event can happen, two in a row, three and so on; each set holds the next."""
    while True:
        before = diagrams.false
        for event in events:
            before |= event.before(states)
            diagrams.tidy()
        states = before
        yield states


def independent_groups(events: Sequence[InternalEvent]) -> list[list[InternalEvent]]:
    """Group the events so that no event changes an element that an event of another group touches."""
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
    groups: dict[object, list[InternalEvent]] = {}
    for event in events:
        shared = [first(element) for element in event.touched & changed]
        groups.setdefault(shared[0] if shared else event, []).append(event)
    return list(groups.values())
