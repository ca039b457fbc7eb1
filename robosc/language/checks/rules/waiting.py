"""Rules on components that wait: `cancel-is-not-the-end`, `answer-unheard` and `failure-unheard`.

A request, a call or a cancel starts at one moment and ends at a later one. These rules report components that confuse
the two.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeGuard

from robosc.base.diagnostics import Severity
from robosc.language.checks.commands import Places, command_conditions, commands_of, events_of, kind_of
from robosc.language.checks.definitions import assigned_variable, communication_of
from robosc.language.checks.fleets import reference_key
from robosc.language.checks.libraries import instances
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import CALLED, data_type, event
from robosc.model.semantics.cone_of_influence import accesses
from robosc.model.semantics.instances import InstanceVariable
from robosc.model.semantics.naming import escape_keyword

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.model import expression as ex
    from robosc.model.semantics.instances import Instance, Instances, PortInstance

_END = (rsc.ResultType.response, rsc.ResultType.error, rsc.ResultType.canceled)


@rule("cancel-is-not-the-end", Severity.WARNING)
def cancel_is_not_the_end(base: rsc.Base) -> Iterator[Finding]:
    """Each component or requirement that reacts to the cancel of an action also waits for the action's end."""
    if not isinstance(base, rsc.Robot):
        return
    known = instances(base)
    places = Places(base)
    yield from _states_without_end(known, places)
    yield from _forbidden_ends(known, places)
    yield from _variables_read(known, places)


def _states_without_end(known: Instances, places: Places) -> Iterator[Finding]:
    """Report transitions on a cancel to a state that does not wait for the end of the action."""
    for instance in known:
        common = [transition for transition, where in instance.transitions if where is None]
        for transition, _ in instance.transitions:
            if transition.target is None or not _is_on(transition, rsc.ResultType.cancel):
                continue
            action = communication_of(transition.communicationType)
            if not isinstance(action, rsc.Action):
                continue
            passed = (
                state
                for state in _silently_reached(transition.target, common)
                if not _hears([*state.transitions, *common], transition.communicationType, rsc.ResultType.canceled)
            )
            deaf = next(passed, None)
            if deaf is None:
                continue
            place = places.new(transition, instance, action)
            if place is not None:
                name = escape_keyword(action.name)
                onwards = "" if deaf is transition.target else f" and from there to `{instance.name}.{deaf.name}`"
                yield Finding(
                    place,
                    f"`cancel from {name}` leads to `{instance.name}.{transition.target.name}`{onwards},"
                    f" which does not wait for the end of `{name}`: the controller has only requested the cancel,"
                    " and the robot may still move",
                    f"go to a state `stopping` that `canceled from {name}`, `response from {name}` and"
                    f" `error from {name}` leave",
                    related=None if place is transition else transition,
                )


def _silently_reached(state: rsc.State, common: Iterable[rsc.Transition]) -> list[rsc.State]:
    """Return a state and all that silent transitions without a condition lead to from there, nearest first."""
    reached = [state]
    for current in reached:
        for transition in [*current.transitions, *common]:
            is_certain = isinstance(transition, rsc.TauTransition) and transition.guard is None
            if is_certain and transition.target is not None and transition.target not in reached:
                reached.append(transition.target)
    return reached


def _forbidden_ends(known: Instances, places: Places) -> Iterator[Finding]:
    """Report transitions on a cancel to a state in which the requirement automaton forbids an end that it names."""
    for statement in known.statements(rsc.AutomatonRequirement):
        every = [transition for state in statement.element.states for transition in state.transitions]
        named = {(known.port(other.event.communicationType, statement.within), kind_of(other.event)) for other in every}
        for transition in every:
            port = known.port(transition.event.communicationType, statement.within)
            if transition.target is None or port is None or not isinstance(port.communication, rsc.Action):
                continue
            if kind_of(transition.event) != rsc.ResultType.cancel:
                continue
            there = {
                kind_of(other.event)
                for other in transition.target.transitions
                if known.port(other.event.communicationType, statement.within) == port
            }
            missing = [str(end) for end in _END if (port, end) in named and end not in there]
            place = places.new(transition, statement.within, port.communication) if missing else None
            if place is not None:
                name, state = escape_keyword(port.communication.name), transition.target.name
                yield Finding(
                    place,
                    f"`cancel from {name}` leads to `{state}`, which forbids the {missing[0]} of `{name}`: the"
                    " controller has only requested the cancel, and the goal ends later",
                    f"let `{escape_keyword(state)}` allow `{missing[0]} from {name}`",
                    related=None if place is transition else transition,
                )


def _variables_read(known: Instances, places: Places) -> Iterator[Finding]:
    """Report transitions on a cancel that assign a variable which a requirement on another command reads."""
    readers_by_variable = _readers(known)
    for instance in known if readers_by_variable else ():
        for transition, _ in instance.transitions:
            port = (
                known.port(transition.communicationType, instance)
                if _is_on(transition, rsc.ResultType.cancel)
                else None
            )
            is_cancel = port is not None and isinstance(port.communication, rsc.Action)
            for assignment in transition.assignments if is_cancel else ():
                variable = assigned_variable(assignment)
                readers = (
                    readers_by_variable.get(InstanceVariable(instance, variable), ()) if variable is not None else ()
                )
                others = [reader for reader, restricted in readers if restricted - {port}]
                place = places.new(assignment, instance, port.communication) if port is not None and others else None
                if place is not None and port is not None and variable is not None:
                    name = escape_keyword(port.communication.name)
                    yield Finding(
                        place,
                        f"`{variable.name}` changes when the controller requests the cancel of `{name}`, and a"
                        " requirement on another command reads it: the robot may still move",
                        f"assign it `on canceled from {name}`, or read `{name}.running` in the requirement",
                        related=others[0],
                    )


def _readers(known: Instances) -> dict[InstanceVariable, list[tuple[rsc.Requirement, set[PortInstance | None]]]]:
    """Return the requirements that read each variable, each with the commands that it restricts."""
    readers: dict[InstanceVariable, list[tuple[rsc.Requirement, set[PortInstance | None]]]] = {}
    for condition in command_conditions(known):
        for access in accesses(known.expanded(condition.condition, condition.within)):
            variable = known.variable(access, condition.within)
            if variable is not None:
                readers.setdefault(variable, []).append((condition.requirement, condition.restricted))
    return readers


@rule("answer-unheard", Severity.WARNING)
def answer_unheard(base: rsc.Base) -> Iterator[Finding]:
    """Each component that changes its state with a call waits for the answer in some state."""
    if not isinstance(base, rsc.Robot):
        return
    known = instances(base)
    heard = _answers_heard(known)
    restricted = _restricted(known)
    states_read = _states_read(known)
    places = Places(base)
    for instance in known:
        for transition, state in instance.transitions:
            target = transition.target
            if target is None or target is state or not _is_on(transition, rsc.ResultType.request):
                continue
            port = known.port(transition.communicationType, instance)
            if port is None or not isinstance(port.communication, CALLED) or port in heard:
                continue
            unread = port not in restricted and (instance, target) not in states_read
            if unread and _answers_nothing(port.communication) and not _commands(target, instance, port, known):
                continue
            place = places.new(transition, instance, port.communication)
            if place is not None:
                name = escape_keyword(port.communication.name)
                yield Finding(
                    place,
                    f"`{instance.name}` goes to `{target.name}` with the request to `{name}`, and no transition waits"
                    f" for its answer: events that `{target.name}` allows may begin before `{name}` has ended",
                    f"go to a state that `on response from {name} goto {escape_keyword(target.name)}` leaves, "
                    f"and give it `on error from {name}`, too",
                )


def _answers_heard(known: Instances) -> set[PortInstance]:
    """Return the services and actions whose response a transition or a requirement names."""
    ports: set[PortInstance | None] = set()
    for instance in known:
        for transition, _ in instance.transitions:
            if _is_on(transition, rsc.ResultType.response):
                ports.add(known.port(transition.communicationType, instance))
    for kind in (rsc.OrderRequirement, rsc.CountRequirement, rsc.AutomatonRequirement):
        for requirement in known.statements(kind):
            for reference in events_of(requirement.element):
                if kind_of(reference) == rsc.ResultType.response:
                    ports.add(known.port(reference.communicationType, requirement.within))
    return {port for port in ports if port is not None}


def _restricted(known: Instances) -> set[PortInstance]:
    """Return the communications whose start a requirement restricts."""
    ports: set[PortInstance | None] = set()
    for requirement in known.statements(rsc.CommunicationRequirement):
        ports |= commands_of(requirement, known)
    for kind in (rsc.OrderRequirement, rsc.CountRequirement, rsc.AutomatonRequirement):
        for statement in known.statements(kind):
            for reference in events_of(statement.element):
                ports.add(known.port(reference.communicationType, statement.within))
    return {port for port in ports if port is not None}


def _states_read(known: Instances) -> set[tuple[Instance | None, rsc.State]]:
    """Return the states that requirements read."""
    conditions: list[tuple[ex.Expression | None, Instance | None]] = []
    required, invariants = known.statements(rsc.CommunicationRequirement), known.statements(rsc.StateInvariant)
    conditions += ((statement.element.condition, statement.within) for statement in required)
    conditions += ((statement.element.condition, statement.within) for statement in invariants)
    for goal in known.statements(rsc.ReachabilityRequirement):
        conditions += ((goal.element.condition, goal.within), (goal.element.premise, goal.within))
    for automaton in known.statements(rsc.AutomatonRequirement):
        for state in automaton.element.states:
            conditions += ((transition.guard, automaton.within) for transition in state.transitions)
    return {
        (known.instance(access.component, within), access.item)
        for condition, within in conditions
        if condition is not None
        for access in accesses(known.expanded(condition, within))
        if isinstance(access.item, rsc.State)
    }


def _answers_nothing(communication: rsc.CommunicationType) -> bool:
    row = event(communication, rsc.ResultType.response)
    return isinstance(data_type(communication, row), rsc.NoneDataType)


def _commands(state: rsc.State, instance: Instance, port: PortInstance, known: Instances) -> bool:
    """Return whether a component allows another command in a state."""
    common = [transition for transition, where in instance.transitions if where is None]
    requests = [
        known.port(transition.communicationType, instance)
        for transition in [*state.transitions, *common]
        if _is_on(transition, rsc.ResultType.request)
    ]
    return any(other != port for other in requests)


@rule("failure-unheard", Severity.WARNING)
def failure_unheard(base: rsc.Base) -> Iterator[Finding]:
    """Each state that waits for an answer also reacts to the failure, and to the end of a possible cancel."""
    if not isinstance(base, rsc.Robot):
        return
    known = instances(base)
    cancelable = {
        port
        for requirement in known.statements(rsc.CommunicationRequirement)
        for port in commands_of(requirement, known)
    }
    places = Places(base)
    for instance in known:
        common = [transition for transition, where in instance.transitions if where is None]
        for transition, state in instance.transitions:
            target = transition.target
            if state is None or target is None or target is state or not _is_on(transition, rsc.ResultType.response):
                continue
            port = known.port(transition.communicationType, instance)
            if port is None or not isinstance(port.communication, CALLED):
                continue
            missing = _unheard(state, common, transition.communicationType, port in cancelable)
            place = places.new(transition, instance, port.communication) if missing else None
            if place is not None:
                name = escape_keyword(port.communication.name)
                ends = " or ".join(f"`{end} from {name}`" for end in missing)
                yield Finding(
                    place,
                    f"`{instance.name}` leaves `{state.name}` at the response of `{name}`, and does not react to {ends}"
                    f" there: it may wait forever",
                    f"let `{escape_keyword(state.name)}` react to {ends}: "
                    "with `goto` it gives up, without it tries again",
                )


def _unheard(
    state: rsc.State, common: Iterable[rsc.Transition], awaited: rsc.CommunicationReference, cancelable: bool
) -> list[rsc.ResultType]:
    """Return the ends of a call or goal that a state waiting for its response does not react to."""
    own, call = [*state.transitions, *common], awaited.communicationType
    if any(isinstance(transition, rsc.TimedTransition) for transition in state.transitions) or _leaves_at_the_end(
        own, call
    ):
        return []
    missing: list[rsc.ResultType] = []
    if not _hears(own, awaited, rsc.ResultType.error):
        missing.append(rsc.ResultType.error)
    if isinstance(call, rsc.Action) and cancelable and not _hears(own, awaited, rsc.ResultType.canceled):
        leaves = any(
            transition.target is not None and transition.target is not state
            for transition in own
            if _is_on(transition, rsc.ResultType.cancel) and _names(transition, awaited)
        )
        if not leaves:
            missing.append(rsc.ResultType.canceled)
    return missing


def _leaves_at_the_end(transitions: Iterable[rsc.Transition], call: rsc.CommunicationType | None) -> bool:
    """Return whether the guard of a silent transition checks that a call is running."""
    silent = (transition for transition in transitions if isinstance(transition, rsc.TauTransition))
    return any(access.item is call for transition in silent for access in accesses(transition.guard))


def _is_on(transition: rsc.Transition, kind: rsc.ResultType) -> TypeGuard[rsc.ResultTransition]:
    return isinstance(transition, rsc.ResultTransition) and transition.resultType == kind


def _names(transition: rsc.Transition, reference: rsc.CommunicationReference) -> bool:
    """Return whether a transition names the communication and component of a reference."""
    named = transition.communicationType if isinstance(transition, rsc.ResultTransition) else None
    if named is None:
        return False
    return reference_key(named) == reference_key(reference)


def _hears(transitions: Iterable[rsc.Transition], reference: rsc.CommunicationReference, kind: rsc.ResultType) -> bool:
    return any(_is_on(transition, kind) and _names(transition, reference) for transition in transitions)
