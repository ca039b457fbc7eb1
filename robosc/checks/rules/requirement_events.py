"""`requirement-event`: which events requirements may restrict, and who may read requirement automata.

And what requirement automata and the events in requirements are to be of what other rules say of behaviours.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.checks.definitions import (
    communication_of,
    communications,
    of_kind,
    restricted_events,
    statements,
    transitions,
)
from robosc.checks.libraries import instances
from robosc.checks.mending import Choice, Insertion, Removal, Replacement, Rewriting
from robosc.checks.rule import Finding, on_line, rule
from robosc.metamodel import robosc as rsc
from robosc.metamodel.reflection import tree
from robosc.semantics.communication import event_names, meant
from robosc.semantics.cone_of_influence import accesses
from robosc.semantics.naming import enumeration, written

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.checks.mending import Way
    from robosc.metamodel import expression as ex


@rule("requirement-event")
def requirement_event(base: rsc.Base) -> Iterator[Finding]:
    """An order or a count restricts no outgoing message, and only requirements read requirement automata."""
    for events in restricted_events(base):
        for named in events.events if events else ():
            communication = communication_of(named.communicationType)
            if isinstance(communication, rsc.Message) and communication.direction == rsc.MessageDirection.outgoing:
                yield Finding(
                    named,
                    f"`{communication.name}` comes from its component whenever that sends it, expected a request or an"
                    " answer",
                    "restrict what the controller does about it",
                )
    if any(True for _ in statements(rsc.AutomatonRequirement, base)):
        yield from _readers(base)
    yield from _sent_on_change(base)


def _sent_on_change(base: rsc.Base) -> Iterator[Finding]:
    """What is sent on change and comes from its component, or is named as an event: when it goes out means nothing."""
    for message in communications(base):
        if isinstance(message, rsc.Message) and message.onChange and message.direction == rsc.MessageDirection.outgoing:
            what = f"`{message.name}` comes from its component whenever that sends it, expected an incoming message"
            yield Finding(
                message, f"{what} before `send: change`", _with_every_tick("leave `, send: change` out", message)
            )
    named: list[tuple[ex.Located, rsc.CommunicationReference]] = []
    named += [(event, event.communicationType) for event in named_events(base)]
    for _, transition in transitions(base):
        if isinstance(transition, rsc.ResultTransition):
            named.append((transition, transition.communicationType))
    for where, reference in named:
        sent = communication_of(reference)
        if isinstance(sent, rsc.Message) and sent.onChange and sent.direction == rsc.MessageDirection.incoming:
            ways: list[Way] = [_with_every_tick("leave `, send: change` out", sent, is_choice=True)]
            if isinstance(where, rsc.Transition):
                ways.append(Removal("leave the transition out", where))
            yield Finding(
                where,
                f"`{sent.name}` is sent when its data changes, expected no transition, order, count or automaton that"
                " names it",
                Choice("leave `, send: change` out, or this", tuple(ways)),
            )


def _with_every_tick(hint: str, message: rsc.Message, *, is_choice: bool = False) -> Rewriting:
    return Rewriting(hint, r"\s*,\s*send\s*:\s*change\b", "", message, is_choice)


def _readers(base: rsc.Base) -> Iterator[Finding]:
    """What reads a requirement automaton and is no requirement; what it inlines reads it, too."""
    found = instances(base)
    for instance in found:
        for transition, _ in instance.transitions:
            if isinstance(transition, rsc.TauTransition) and transition.guard is not None:
                yield from _reading(transition.guard, found.expanded(transition.guard, instance), "a guard")
    for statement in found.statements(rsc.ProvideStatement):
        condition = statement.element.condition
        if condition is not None:
            expanded = found.expanded(condition, statement.within)
            yield from _reading(condition, expanded, "the condition of a provide statement")
    for _, transition in transitions(base):
        for assignment in transition.assignments:
            yield from _reading(assignment.value, assignment.value, "an assignment")


def _reading(expression: ex.Expression | None, expanded: ex.Expression | None, what: str) -> Iterator[Finding]:
    items = (access.item for access in accesses(expanded))
    read = next((item for item in items if isinstance(item, rsc.RequirementState)), None)
    if read is not None and expression is not None:
        name = f"{written(read.eContainer().name)}.{written(read.name)}"
        yield Finding(
            expression,
            f"{what} reads `{name}`, a state of a requirement, expected states and variables of components: the robot"
            " does not know what is required of it",
            "say it in a requirement, or remember it in a state of a component",
        )


def named_events(base: rsc.Base) -> Iterator[rsc.EventReference]:
    """The events that orders, counts and automata name."""
    for requirement in statements(rsc.Requirement, base):
        if not isinstance(requirement, rsc.CommunicationRequirement | rsc.StateInvariant):
            yield from of_kind(rsc.EventReference, (element for _, element in tree(requirement)))


def unknown_events(base: rsc.Base) -> Iterator[Finding]:
    """The events that their communications do not have, of the rule `result-type`."""
    for named in named_events(base):
        communication = communication_of(named.communicationType)
        if communication is not None and meant(named) is None and isinstance(named, rsc.NamedEvent):
            allowed = event_names(communication)
            yield Finding(
                named,
                f"{type(communication).__name__.lower()} `{communication.name}` has no {named.resultType}, expected"
                f" {enumeration(f'`{name}`' for name in allowed)}",
                Replacement(f"write `{written(communication.name)}` alone", written(communication.name), named)
                if named.communicationType.component is None
                else Rewriting(f"write `{written(communication.name)}` alone", r"\A\w+\s+(?:to|from)\s+", "", named),
            )


def initial_states(base: rsc.Base) -> Iterator[Finding]:
    """The automata without one initial state, of the rule `initial-state`."""
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
    """The states of which one may be initial."""
    ways = (Insertion(f"write `initial` before `state {written(state.name)}`", "initial ", state) for state in states)
    return Choice(hint, tuple(ways))


def one_initial(hint: str, *states: rsc.State | rsc.RequirementState) -> Choice:
    """The states of which one is not to be initial."""
    ways = (Rewriting(f"leave `initial` out before `{state.name}`", r"\binitial\s+", "", state) for state in states)
    return Choice(hint, tuple(ways))


def one_out(hint: str, later: rsc.Transition | rsc.RequirementTransition, earlier: ex.Located) -> Choice:
    """Two transitions of which one is to be left out."""
    ways = (
        Removal(f"leave this one out{on_line(later)}", later),
        Removal(f"leave the other one out{on_line(earlier)}", earlier),
    )
    return Choice(hint, ways)


def repeated_events(base: rsc.Base) -> Iterator[Finding]:
    """Transitions of a state behind one without condition on the same event, of the rule `nondeterminism`."""
    for automaton in statements(rsc.AutomatonRequirement, base):
        for state in automaton.states:
            always: dict[Any, rsc.RequirementTransition] = {}
            for transition in state.transitions:
                reference = transition.event.communicationType if transition.event else None
                event = meant(transition.event) if reference and reference.communicationType else None
                if reference is None or event is None:
                    continue
                key = (reference.component, reference.communicationType, event)
                if key in always:
                    yield Finding(
                        transition,
                        f"this transition of state `{state.name}` is never tried: another one for this event, without"
                        f" condition, stands before it{on_line(always[key])}",
                        one_out("move it before that one, or leave one of the two out", transition, always[key]),
                        related=always[key],
                    )
                elif transition.guard is None:
                    always[key] = transition
