"""Data elimination: which variables and which incoming data the supervisor needs (thesis 5.2.4, made transitive)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.instances import Instance, Instances, InstanceVariable, Occurrence


@dataclass(frozen=True)
class Data:
    """A part of what an event carries: the properties on the way from the whole to it; none: the whole."""

    occurrence: Occurrence
    result_type: robosc.ResultType
    path: tuple[robosc.ObjectProperty, ...]


@dataclass(frozen=True)
class Needed:
    """What the supervisor needs, each with the first expression that needs it, in the order in which it was found."""

    variables: dict[InstanceVariable, robosc.Access]
    data: dict[Data, robosc.Access]


@dataclass(frozen=True)
class Assigned:
    """An assignment where it stands: in which instance, in which transition."""

    instance: Instance
    transition: robosc.Transition
    assignment: robosc.Assignment


def needed(instances: Instances) -> Needed:
    """What guards, requirements and conditions of provided data read, and what that was computed from."""
    assignments: dict[InstanceVariable, list[Assigned]] = {}
    for assigned in all_assignments(instances):
        variable = instances.variable(assigned.assignment.item, assigned.instance)
        if variable is not None:
            assignments.setdefault(variable, []).append(assigned)
    result = Needed({}, {})
    queue: list[InstanceVariable] = []

    def read(expression: ex.Expression | None, within: Instance | None) -> None:
        for access in accesses(expression):
            variable = instances.variable(access, within)
            if variable is not None and variable not in result.variables:
                result.variables[variable] = access
                queue.append(variable)

    for condition, within in conditions(instances):
        read(condition, within)
    while queue:
        for assigned in assignments.get(queue.pop(0), ()):
            read(assigned.assignment.value, assigned.instance)
            _read_data(instances, assigned, result)
    return result


def conditions(instances: Instances) -> Iterator[tuple[ex.Expression | None, Instance | None]]:
    """Every expression that the supervisor itself evaluates, with the instance whose text it is."""
    for instance in instances:
        for transition, _ in transitions(instance):
            if isinstance(transition, robosc.TauTransition):
                yield transition.guard, instance
    for definition in instances.base.definitions:
        if isinstance(definition, (robosc.Requirement, robosc.ProvideStatement)):
            yield definition.condition, None


def transitions(instance: Instance) -> Iterator[tuple[robosc.Transition, robosc.State | None]]:
    """The transitions of an instance in the order of the text, each with its state; None: every state has it."""
    for definition in instance.automaton.definitions if instance.automaton else ():
        if isinstance(definition, robosc.State):
            for transition in definition.transitions:
                yield transition, definition
        elif isinstance(definition, robosc.Transition):
            yield definition, None


def all_assignments(instances: Instances) -> Iterator[Assigned]:
    """Every assignment of every instance, in the order of the text."""
    for instance in instances:
        for transition, _ in transitions(instance):
            for assignment in transition.assignments:
                yield Assigned(instance, transition, assignment)


def accesses(expression: ex.Expression | None) -> Iterator[robosc.Access]:
    """Every access in an expression, from left to right."""
    if isinstance(expression, robosc.Access):
        yield expression
    elif isinstance(expression, ex.BinaryExpression):
        yield from accesses(expression.left)
        yield from accesses(expression.right)
    elif isinstance(expression, ex.UnaryExpression):
        yield from accesses(expression.operand)
    elif isinstance(expression, robosc.ObjectValue):
        for each in expression.properties:
            yield from accesses(each.value)


def property_path(access: robosc.Access) -> tuple[robosc.ObjectProperty, ...] | None:
    """The properties that an access to `value` follows; None where it reads an array or is not resolved."""
    segments = list(access.segments)
    if not all(isinstance(each, robosc.PropertySegment) and each.property is not None for each in segments):
        return None
    return tuple(each.property for each in segments if isinstance(each, robosc.PropertySegment))


def _read_data(instances: Instances, assigned: Assigned, result: Needed) -> None:
    transition = assigned.transition
    if not isinstance(transition, robosc.ResultTransition):
        return
    occurrence = instances.occurrence(transition.communicationType, assigned.instance)
    for access in accesses(assigned.assignment.value):
        path = property_path(access)
        if access.value and occurrence is not None and path is not None:
            result.data.setdefault(Data(occurrence, transition.resultType, path), access)
