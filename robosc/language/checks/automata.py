"""Rules on requirement automata and on the events that requirements name.

The module also has the edits that leave one initial state, or one of two transitions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.language.checks.definitions import communication_of, of_kind, statements
from robosc.language.checks.edits import NOWHERE, Choice, Insertion, Removal, Replacement, part_of
from robosc.language.checks.fleets import reference_key
from robosc.language.checks.rule import Finding, on_line
from robosc.model import robosc as rsc
from robosc.model.reflection import tree
from robosc.model.semantics.communication import SERVED, event_names, event_of, kind_text, port_event_of
from robosc.model.semantics.naming import enumeration, escape_keyword

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.model import expression as ex


def named_events(base: rsc.Base) -> Iterator[rsc.EventReference]:
    """Yield the events that orders, counts, automata and assumptions name."""
    for requirement in (*statements(rsc.Requirement, base), *statements(rsc.Assumption, base)):
        if not isinstance(requirement, rsc.CommunicationRequirement | rsc.StateInvariant):
            yield from of_kind(rsc.EventReference, (element for _, element in tree(requirement)))


def unknown_events(base: rsc.Base) -> Iterator[Finding]:
    """Report events that their communications do not have, for the rule `result-type`."""
    for named in named_events(base):
        communication = communication_of(named.communicationType)
        if isinstance(named, rsc.NamedEvent):
            yield from wrong_preposition(named)
        if communication is not None and port_event_of(named) is None and isinstance(named, rsc.NamedEvent):
            allowed = event_names(communication)
            yield Finding(
                named,
                f"{kind_text(communication)} `{communication.name}` has no {named.resultType}, expected"
                f" {enumeration(f'`{name}`' for name in allowed)}",
                Removal(
                    f"write `{escape_keyword(communication.name)}` alone",
                    part_of(named).until(part_of(named.communicationType)),
                ),
            )


def wrong_preposition(named: rsc.ResultTransition | rsc.NamedEvent) -> Iterator[Finding]:
    """Report `to` before a client's event, and `from` before an answer to it, for the rule `result-type`.

    Other communications accept both words.
    """
    communication, row = communication_of(named.communicationType), event_of(named.communicationType, named.resultType)
    if row is None or not isinstance(communication, SERVED):
        return
    wrong = "from" if row.is_sent else "to"
    word = part_of(named).until(part_of(named.communicationType)).find(wrong)
    if word != NOWHERE:
        sender = "the controller" if row.is_sent else "a client"
        yield Finding(
            named,
            f"{sender} sends the {row.name} of {kind_text(communication)} `{communication.name}`,"
            f" expected `{row.preposition}`",
            Replacement(f"write `{row.preposition}` instead of `{wrong}`", row.preposition, word),
        )


def initial_states(base: rsc.Base) -> Iterator[Finding]:
    """Report automata without exactly one initial state, for the rule `initial-state`."""
    for automaton in statements(rsc.AutomatonRequirement, base):
        initial = [state for state in automaton.states if state.initial]
        for other in initial[1:]:
            message = f"the automaton has a second initial state `{other.name}`, expected one"
            hint = f"leave `initial` out before `{other.name}` or `{initial[0].name}`"
            yield Finding(other, message, one_initial(hint, other, initial[0]))
        if not initial:
            message = "no state of the automaton is initial, expected one"
            starts = start_of("write `initial` before the state it starts in", automaton.states)
            yield Finding(automaton, message, starts, relies_on=automaton)


def start_of(hint: str, states: Iterable[rsc.State | rsc.RequirementState]) -> Choice:
    """Return the choice of the state to make initial."""
    ways = (
        Insertion(f"write `initial` before `state {escape_keyword(state.name)}`", "initial ", state) for state in states
    )
    return Choice(hint, tuple(ways))


def one_initial(hint: str, *states: rsc.State | rsc.RequirementState) -> Choice:
    """Return the choice of the state that loses `initial`."""
    ways = (Removal(f"leave `initial` out before `{state.name}`", part_of(state).find("initial")) for state in states)
    return Choice(hint, tuple(ways))


def one_out(hint: str, later: rsc.Transition | rsc.RequirementTransition, earlier: ex.Located) -> Choice:
    """Return the choice of which of two transitions to remove."""
    ways = (
        Removal(f"leave this one out{on_line(later)}", later),
        Removal(f"leave the other one out{on_line(earlier)}", earlier),
    )
    return Choice(hint, ways)


def repeated_events(base: rsc.Base) -> Iterator[Finding]:
    """Report transitions after an unconditional one on the same event in a state, for the rule `nondeterminism`."""
    for automaton in statements(rsc.AutomatonRequirement, base):
        for state in automaton.states:
            always: dict[Any, rsc.RequirementTransition] = {}
            for transition in state.transitions:
                reference = transition.event.communicationType if transition.event else None
                event = port_event_of(transition.event) if reference and reference.communicationType else None
                if reference is None or event is None:
                    continue
                key = (*reference_key(reference), event)
                if key in always:
                    yield Finding(
                        transition,
                        f"this transition of state `{state.name}` is never tried: one without condition for this event"
                        f" is before it{on_line(always[key])}",
                        one_out("move it before that one, or leave one of the two out", transition, always[key]),
                        related=always[key],
                    )
                elif transition.guard is None:
                    always[key] = transition
