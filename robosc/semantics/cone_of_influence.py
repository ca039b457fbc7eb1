"""Data elimination: which variables and which incoming data the supervisor needs (thesis 5.2.4, made transitive)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc
from robosc.semantics.communication import PortEvent, data_type, event_of
from robosc.semantics.walks import parts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.semantics.instances import Instance, Instances, InstanceVariable, PortInstance

#: A comparison of doubles is tabulated over the integers that it is computed from, up to so many valuations: a larger
#: table would be larger than any model that it is part of.
LARGEST_TABLE = 1 << 16


@dataclass(frozen=True)
class Data:
    """A part of what an event of a port carries: the properties on the way from the whole to it; none: the whole."""

    port: PortInstance
    event: PortEvent
    path: tuple[robosc.ObjectProperty, ...]


@dataclass(frozen=True)
class Assigned:
    """An assignment where it stands: in which instance, in which transition, to which variable (None: to none).

    `value` is what it assigns, written out.
    """

    instance: Instance
    transition: robosc.Transition
    assignment: robosc.Assignment
    variable: InstanceVariable | None
    value: ex.Expression | None


@dataclass(frozen=True)
class Reason:
    """Why something is needed: what reads it, in the text of which instance (None: the robot's), to compute what.

    `variable` is None where the supervisor itself evaluates what reads it.
    """

    access: robosc.Access
    within: Instance | None
    variable: InstanceVariable | None


@dataclass(frozen=True)
class ConeOfInfluence:
    """What the supervisor needs, each with the first reason, in the order in which it was found.

    `computations` are the assignments that it performs.
    """

    variables: dict[InstanceVariable, Reason]
    data: dict[Data, Reason]
    computations: list[Assigned]


def cone_of_influence(instances: Instances) -> ConeOfInfluence:
    """What guards, requirements and conditions of provided data read, and what that was computed from."""
    assignments: dict[InstanceVariable, list[Assigned]] = {}
    for assigned in all_assignments(instances):
        if assigned.variable is not None:
            assignments.setdefault(assigned.variable, []).append(assigned)
    result = ConeOfInfluence({}, {}, [])
    queue: list[InstanceVariable] = []

    def read(expression: ex.Expression | None, within: Instance | None, computed: InstanceVariable | None) -> None:
        for access in accesses(expression):
            variable = instances.variable(access, within)
            if variable is not None and variable not in result.variables:
                result.variables[variable] = Reason(access, within, computed)
                queue.append(variable)

    for condition, within in conditions(instances):
        read(condition, within, None)
    while queue:
        for assigned in assignments.get(queue.pop(0), ()):
            result.computations.append(assigned)
            read(assigned.value, assigned.instance, assigned.variable)
            _read_data(instances, assigned, result)
    return result


def conditions(instances: Instances) -> Iterator[tuple[ex.Expression | None, Instance | None]]:
    """Every expression that the supervisor itself evaluates, written out, with the instance whose text it is."""
    for instance in instances:
        for transition, _ in instance.transitions:
            if isinstance(transition, robosc.TauTransition) and transition.guard is not None:
                yield instances.expanded(transition.guard, instance), instance
    for condition, within in _stated(instances):
        if condition is not None:
            yield instances.expanded(condition, within), within


def _stated(instances: Instances) -> Iterator[tuple[ex.Expression | None, Instance | None]]:
    """What is said in requirements, properties and statements that provide data."""
    for automaton in instances.statements(robosc.AutomatonRequirement):
        transitions = (transition for state in automaton.element.states for transition in state.transitions)
        yield from ((transition.guard, automaton.within) for transition in transitions)
    for claimed in instances.statements(robosc.Property):
        yield claimed.element.condition, claimed.within
        if isinstance(claimed.element, robosc.ReachabilityProperty):
            yield claimed.element.origin, claimed.within
    for required in instances.statements(robosc.CommunicationRequirement):
        yield required.element.condition, required.within
    for provided in (statement for port in instances.ports() for statement in instances.provided(port)):
        yield provided.element.condition, provided.within
    for invariant in instances.statements(robosc.StateInvariant):
        yield invariant.element.condition, invariant.within


def all_assignments(instances: Instances) -> Iterator[Assigned]:
    """Every assignment of every instance, in the order of the text."""
    for instance in instances:
        for transition, _ in instance.transitions:
            for assignment in transition.assignments:
                variable = instances.variable(assignment.item, instance) if assignment.item else None
                given = assignment.value
                value = None if given is None else instances.expanded(given, instance)
                yield Assigned(instance, transition, assignment, variable, value)


def accesses(expression: ex.Expression | None) -> Iterator[robosc.Access]:
    """Every access in an expression, from left to right."""
    return (part for part in parts(expression) if isinstance(part, robosc.Access))


def property_path(access: robosc.Access) -> tuple[robosc.ObjectProperty, ...] | None:
    """The properties that an access to `value` follows; None where it reads an array or is not resolved."""
    segments = list(access.segments)
    if not all(isinstance(segment, robosc.PropertySegment) and segment.property is not None for segment in segments):
        return None
    return tuple(segment.property for segment in segments if isinstance(segment, robosc.PropertySegment))


def read_type(assigned: Assigned, access: robosc.Access) -> robosc.DataType | None:
    """The declared type of what an assignment reads of its event's data; None where that is not known."""
    segments = list(access.segments)
    if not segments:
        transition = assigned.transition
        if not isinstance(transition, robosc.ResultTransition) or transition.communicationType is None:
            return None
        event = event_of(transition.communicationType, transition.resultType)
        carried = event if event is not None and not event.is_sent else None
        return data_type(transition.communicationType.communicationType, carried)
    last = segments[-1]
    return last.property.type if isinstance(last, robosc.PropertySegment) and last.property else None


def _read_data(instances: Instances, assigned: Assigned, result: ConeOfInfluence) -> None:
    transition = assigned.transition
    if not isinstance(transition, robosc.ResultTransition):
        return
    port = instances.port(transition.communicationType, assigned.instance)
    event = event_of(transition.communicationType, transition.resultType)
    if port is None or event is None:
        return
    for access in accesses(assigned.value):
        path = property_path(access)
        if access.value and path is not None:
            data = Data(port, event, path)
            result.data.setdefault(data, Reason(access, assigned.instance, assigned.variable))
