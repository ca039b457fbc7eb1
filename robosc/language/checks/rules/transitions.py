"""Rules on transitions and their assignments (thesis 4.5.2, 4.5.5 and 4.5.6).

The rules are `result-type`, `nondeterminism`, `idle-transition`, `assignment-on-message-to-node`, `assignment-scope`
and `repeated-assignment`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.base.diagnostics import Severity
from robosc.language.checks.automata import one_out, repeated_events, unknown_events, wrong_preposition
from robosc.language.checks.definitions import (
    assigned_variable,
    behaviours,
    common_transitions,
    communication_of,
    sends_message,
    states,
    transitions,
)
from robosc.language.checks.edits import Choice, Part, Removal, Replacement, part_of
from robosc.language.checks.fleets import reference_key
from robosc.language.checks.rule import Finding, on_line, rule
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import event_names, events, kind_text
from robosc.model.semantics.naming import enumeration, escape_keyword

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.checks.edits import Hint, Way


class _Event(NamedTuple):
    """An event that a transition reacts to: the instance as the text names it, its communication, and the event."""

    instance: Any
    communication: rsc.CommunicationType
    name: str


#: Direction of a message with this event, and its sender. The component's view defines `incoming`.
_SENT_BY = {"request": ("incoming", "the controller"), "response": ("outgoing", "the component")}


@rule("result-type")
def result_type(base: rsc.Base) -> Iterator[Finding]:
    """Every transition names an event that its communication has; `to` and `from` fit a served one."""
    yield from unknown_events(base)
    for _, transition in transitions(base):
        if isinstance(transition, rsc.TimedTransition):
            yield from _silences(transition)
        if not isinstance(transition, rsc.ResultTransition):
            continue
        yield from wrong_preposition(transition)
        communication = communication_of(transition.communicationType)
        event, allowed = str(transition.resultType), event_names(communication)
        if communication is not None and event not in allowed:
            rows = {row.name: row for row in events(communication)}
            prepositions = {name: rows[name].preposition for name in allowed}
            forms = {
                f"on {name} {word}": f"`on {name} {word} {escape_keyword(communication.name)}`"
                for name, word in prepositions.items()
            }
            ways: list[Way] = [
                Replacement(f"write {form}", text, part_of(transition).until(part_of(transition.communicationType)))
                for text, form in forms.items()
            ]
            ways.append(Removal("leave the transition out", transition))
            direction = f"{communication.direction} " if isinstance(communication, rsc.Message) else ""
            hint = f"write {enumeration(forms.values())}"
            if isinstance(communication, rsc.Message) and event in _SENT_BY:
                opposite, sender = _SENT_BY[event]
                declared = f"declare it as `{opposite} message {escape_keyword(communication.name)}`"
                hint += f", or, if {sender} sends it, {declared}"
                direction_word = part_of(communication).find(str(communication.direction))
                ways.append(Replacement(declared, opposite, direction_word))
            yield Finding(
                transition,
                f"{direction}{kind_text(communication)} `{communication.name}` has no {event}, expected"
                f" {enumeration(f'`{name}`' for name in allowed)}",
                Choice(hint, tuple(ways)),
            )


def _silences(transition: rsc.TimedTransition) -> Iterator[Finding]:
    for reference in transition.without:
        communication = communication_of(reference)
        known = isinstance(communication, rsc.Message) and "response" in event_names(communication)
        if communication is not None and not known:
            direction = f"{communication.direction} " if isinstance(communication, rsc.Message) else ""
            kind = f"{direction}{kind_text(communication)}"
            yield Finding(
                reference,
                f"`without` names the {kind} `{communication.name}`, expected an outgoing message",
                "write a message from a component; without an answer, a service or action has an `error`",
            )


@rule("nondeterminism")
def nondeterminism(base: rsc.Base) -> Iterator[Finding]:
    """Every state reacts to an event in one way: of several transitions, the first with a true guard is taken.

    Transitions of all states are no alternatives to those of one state.
    """
    yield from repeated_events(base)
    for component, behaviour in behaviours(base):
        automaton = behaviour.automaton
        order = {definition: number for number, definition in enumerate(automaton.definitions)}
        common = common_transitions(automaton)
        reported: set[rsc.Transition] = set()
        yield from _repeated([(transition, None) for transition in common], component, reported)
        for state in states(automaton):
            before = [(transition, None) for transition in common if order[transition] < order[state]]
            after = [(transition, None) for transition in common if order[transition] > order[state]]
            own = [(transition, state) for transition in state.transitions]
            yield from _repeated([*before, *own, *after], component, reported)


def _repeated(
    transitions: list[tuple[rsc.Transition, rsc.State | None]],
    component: rsc.Component,
    reported: set[rsc.Transition],
) -> Iterator[Finding]:
    """Report, once, each transition that an earlier one leaves no case of its event.

    `transitions` are in the order of the text.
    """
    firsts: dict[_Event, tuple[rsc.ResultTransition, rsc.State | None]] = {}
    for second, state in transitions:
        event = _event(second)
        if event is None:
            continue
        assert isinstance(second, rsc.ResultTransition)
        first, other = firsts.get(event, (second, state))
        if first.guard is not None and state is other:
            firsts[event] = second, state
        else:
            firsts.setdefault(event, (second, state))
            if first is not second and second not in reported:
                reported.add(second)
                message, hint = _never_taken(component, event, (first, other), state)
                yield Finding(second, message, one_out(hint, second, first), related=first)


def _never_taken(
    component: rsc.Component,
    event: _Event,
    first: tuple[rsc.ResultTransition, rsc.State | None],
    state: rsc.State | None,
) -> tuple[str, str]:
    """Return the message and the hint for a transition that an earlier one preempts."""
    taken, other = first
    where = state or other
    place = f"state `{component.name}.{where.name}`" if where else f"every state of `{component.name}`"
    says = f"{place} reacts to the {event.name} of `{event.communication.name}` already{on_line(taken)}, "
    if state is not other:
        return (
            f"{says}expected one transition for it",
            "leave one of the two out: a transition outside the states belongs to every state",
        )
    return (
        f"{says}in all cases, so this transition is never taken",
        "leave one of the two out, or give the earlier one a condition: `on … if … goto …`",
    )


def _event(transition: rsc.Transition) -> _Event | None:
    """Return the event of a transition; None if it is silent or its event does not exist (`result-type`)."""
    if not isinstance(transition, rsc.ResultTransition) or transition.communicationType is None:
        return None
    instance, communication = reference_key(transition.communicationType)
    name = str(transition.resultType)
    return _Event(instance, communication, name) if name in event_names(communication) else None


@rule("idle-transition", Severity.WARNING)
def idle_transition(base: rsc.Base) -> Iterator[Finding]:
    """Every silent transition has a condition, or changes the state or a variable."""
    for _, transition in transitions(base):
        if not isinstance(transition, rsc.TauTransition) or transition.guard or transition.assignments:
            continue
        owner = transition.eContainer()
        if transition.target is None or transition.target is owner:
            yield Finding(
                transition,
                "the silent transition changes nothing, so the controller takes it forever",
                Removal("leave it out, or write `do …` or `goto …`; an event begins with `on`", transition),
            )


@rule("assignment-on-message-to-node")
def assignment_on_message_to_node(base: rsc.Base) -> Iterator[Finding]:
    """No transition that sends a message to a component assigns a variable: the message brings no data back."""
    for component, transition in transitions(base):
        if transition.assignments and isinstance(transition, rsc.ResultTransition) and sends_message(transition):
            name = transition.communicationType.communicationType.name
            yield Finding(
                transition.assignments[0],
                f"`{component.name}` assigns a value on `{name}`, expected no assignment: a message"
                " to a component returns no data",
                Removal(
                    "leave `do …` out; the target state of the transition can store that the message was sent",
                    _assignments(transition),
                ),
            )


@rule("assignment-scope")
def assignment_scope(base: rsc.Base) -> Iterator[Finding]:
    """Only variables of the own component are assigned; those of others can be read."""
    for component, transition in transitions(base):
        for assignment in transition.assignments:
            target = assignment.item
            unresolved = target is None or (target.item is None and not target.value)
            if not unresolved and assigned_variable(assignment) is None:
                yield Finding(
                    target,
                    f"{_describe(target)} is assigned a value, expected a variable of `{component.name}`",
                    _repair(target, component, transition),
                )


@rule("repeated-assignment", Severity.WARNING)
def repeated_assignment(base: rsc.Base) -> Iterator[Finding]:
    """No transition assigns a variable twice."""
    for _, transition in transitions(base):
        assigned: dict[rsc.Variable, rsc.Assignment] = {}
        for assignment in transition.assignments:
            variable = assigned_variable(assignment)
            if variable is not None and variable in assigned:
                ways = (
                    Removal("leave the first one out", assigned[variable]),
                    Removal("leave the last one out", assignment),
                )
                yield Finding(
                    assignment,
                    f"`{variable.name}` is assigned a value by this transition already, expected one: the last one"
                    " counts",
                    Choice("leave out the unintended one: the assignments of a transition are simultaneous", ways),
                )
            elif variable is not None:
                assigned[variable] = assignment


def _describe(target: rsc.Access) -> str:
    item = target.item
    if item is None:
        return "`value`"
    if isinstance(item, rsc.EnumValue):
        return f"enum value `{item.name}`"
    owner = f" of `{target.component.name}`" if target.component and not isinstance(item, rsc.Component) else ""
    return f"{type(item).__name__.lower()} `{item.name}`{owner}"


def _assignments(transition: rsc.Transition) -> Part:
    """Return the assignments of a transition, with the `do` before them."""
    assignments = transition.assignments
    return part_of(assignments[0]).preceded_by("do").to(part_of(assignments[-1]))


def _repair(target: rsc.Access, component: rsc.Component, transition: rsc.Transition) -> Hint:
    item = target.item
    if isinstance(item, rsc.State) and target.component is component:
        text = f"goto {escape_keyword(item.name)}"
        alone = len(transition.assignments) == 1 and transition.target is None
        return (
            Replacement(f"write `{text}`", text, _assignments(transition), is_choice=True)
            if alone
            else f"write `{text}`"
        )
    if isinstance(item, rsc.Variable) and target.component:
        return f"assign it in `{target.component.name}`, by a transition of its own that reads `{component.name}`"
    return f"declare `variable … : …` in the behaviour of `{component.name}` and assign that"
