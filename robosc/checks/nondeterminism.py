"""`nondeterminism`."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from robosc.checks.automata import behaviours, common_transitions, states
from robosc.checks.rule import Finding, rule
from robosc.checks.unique_names import on_line
from robosc.metamodel import robosc as rsc
from robosc.semantics.communication import event_names

if TYPE_CHECKING:
    from collections.abc import Iterator

_Event: TypeAlias = "tuple[rsc.Component | None, rsc.CommunicationType, str]"


@rule("nondeterminism")
def nondeterminism(base: rsc.Base) -> Iterator[Finding]:
    """A state reacts to an event in one way; the transitions that all states have are among its own."""
    for component, behaviour in behaviours(base):
        automaton = behaviour.automaton
        order = {definition: number for number, definition in enumerate(automaton.definitions)}
        common = common_transitions(automaton)
        reported: set[rsc.Transition] = set()
        yield from _repeated([(transition, None) for transition in common], component, reported)
        for state in states(automaton):
            own: list[tuple[rsc.Transition, rsc.State | None]] = [
                (transition, state) for transition in state.transitions
            ]
            before = [(transition, None) for transition in common if order[transition] < order[state]]
            after = [(transition, None) for transition in common if order[transition] > order[state]]
            yield from _repeated([*before, *own, *after], component, reported)


def _repeated(
    transitions: list[tuple[rsc.Transition, rsc.State | None]],
    component: rsc.Component,
    reported: set[rsc.Transition],
) -> Iterator[Finding]:
    """Each transition on an event that an earlier one is on, given in the order of the text, once."""
    firsts: dict[_Event, tuple[rsc.Transition, rsc.State | None]] = {}
    for second, state in transitions:
        event = _event(second)
        if event is None:
            continue
        first, other = firsts.setdefault(event, (second, state))
        if first is not second and second not in reported:
            reported.add(second)
            where = state or other
            place = f"state `{component.name}.{where.name}`" if where else f"every state of `{component.name}`"
            yield Finding(
                second,
                f"{place} reacts to the {event[2]} of `{event[1].name}` already{on_line(first)}, expected one"
                " transition for it",
                _repair(state, other),
            )


def _repair(state: rsc.State | None, other: rsc.State | None) -> str:
    if state is other:
        return "leave one of the two out, or join them: a second step can be a `transition if …` of the next state"
    return "leave one of the two out: a transition outside the states is one of every state"


def _event(transition: rsc.Transition) -> _Event | None:
    """What a transition reacts to; None for a silent one, and for an event that does not exist (`result-type`)."""
    if not isinstance(transition, rsc.ResultTransition) or transition.communicationType is None:
        return None
    reference, event = transition.communicationType, str(transition.resultType)
    known = event in event_names(reference.communicationType)
    return (reference.component, reference.communicationType, event) if known else None
