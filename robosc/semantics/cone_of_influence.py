"""Data elimination: which variables and which incoming data the supervisor needs (thesis 5.2.4, made transitive)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeGuard

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc
from robosc.semantics.communication import data_type, event_of, meant
from robosc.semantics.inputs import Computed, inputs_in, may_be_missing, readable
from robosc.semantics.typing import declared_type
from robosc.semantics.walks import parts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.semantics.communication import PortEvent
    from robosc.semantics.inputs import Told
    from robosc.semantics.instances import Instance, Instances, InstanceVariable
    from robosc.semantics.typing import Type

#: A comparison of doubles is tabulated over the integers that it is computed from, up to so many valuations: a larger
#: table would be larger than any model that it is part of.
LARGEST_TABLE = 1 << 16


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

    access: robosc.Access | robosc.ErrorReason
    within: Instance | None
    variable: InstanceVariable | None


@dataclass(frozen=True)
class Reading:
    """A part of a whole expression that reads the data of an event, and the input that it is; None: it can't be one.

    `is_readable`: it is no part, and the input is whether the whole can be computed.
    """

    whole: ex.Expression
    part: ex.Expression
    told: Told | None
    reason: Reason
    value: Type
    is_readable: bool = False


@dataclass(frozen=True)
class ConeOfInfluence:
    """What the supervisor needs, each with the first reason, in the order in which it was found.

    `readings` are those of data, `computations` the assignments that it performs.
    """

    variables: dict[InstanceVariable, Reason]
    readings: list[Reading]
    computations: list[Assigned]

    @property
    def data(self) -> dict[Told, Reading]:
        """What it is told, each with where it is read first."""
        found: dict[Told, Reading] = {}
        for reading in self.readings:
            if reading.told is not None:
                found.setdefault(reading.told, reading)
        return found


def cone_of_influence(instances: Instances) -> ConeOfInfluence:
    """What guards, requirements and conditions of provided data read, and what that was computed from."""
    assignments: dict[InstanceVariable, list[Assigned]] = {}
    for assigned in all_assignments(instances):
        if assigned.variable is not None:
            assignments.setdefault(assigned.variable, []).append(assigned)
    result = ConeOfInfluence({}, [], [])
    queue: list[InstanceVariable] = []

    def read(expression: ex.Expression | None, within: Instance | None, computed: InstanceVariable | None) -> None:
        for access in accesses(expression):
            variable = instances.variable(access, within)
            if variable is not None and variable not in result.variables:
                result.variables[variable] = Reason(access, within, computed)
                queue.append(variable)

    for condition in conditions(instances):
        read(condition.expression, condition.within, None)
        result.readings.extend(read_data(instances, condition.expression, condition.within, condition.transition))
    while queue:
        for assigned in assignments.get(queue.pop(0), ()):
            result.computations.append(assigned)
            read(assigned.value, assigned.instance, assigned.variable)
            result.readings.extend(
                read_data(instances, assigned.value, assigned.instance, assigned.transition, assigned.variable)
            )
    return result


@dataclass(frozen=True)
class Evaluated:
    """An expression that the supervisor itself evaluates, written out, where it stands.

    `within` is the instance whose text it is, None: the robot's, and `transition` the one that it guards.
    """

    expression: ex.Expression
    within: Instance | None
    transition: robosc.Transition | robosc.RequirementTransition | None = None


def guard_of(transition: robosc.Transition) -> ex.Expression | None:
    """What must hold for a transition to be taken; None where nothing must."""
    return transition.guard if isinstance(transition, robosc.GuardedTransition) else None


def conditions(instances: Instances) -> Iterator[Evaluated]:
    """Every guard and condition."""
    for instance in instances:
        for transition, _ in instance.transitions:
            guard = guard_of(transition)
            if guard is not None:
                yield Evaluated(instances.expanded(guard, instance), instance, transition)
    for condition, within, following in _stated(instances):
        if condition is not None:
            yield Evaluated(instances.expanded(condition, within), within, following)


def _stated(
    instances: Instances,
) -> Iterator[tuple[ex.Expression | None, Instance | None, robosc.RequirementTransition | None]]:
    """Conditions of requirements, properties and statements that provide data."""
    for automaton in instances.statements(robosc.AutomatonRequirement):
        transitions = (transition for state in automaton.element.states for transition in state.transitions)
        yield from ((transition.guard, automaton.within, transition) for transition in transitions)
    for condition, within in _remembered(instances):
        yield condition, within, None


def _remembered(instances: Instances) -> Iterator[tuple[ex.Expression | None, Instance | None]]:
    """Conditions over what the robot remembers."""
    for claimed in instances.statements(robosc.Property):
        yield claimed.element.condition, claimed.within
        if isinstance(claimed.element, robosc.ReachabilityProperty):
            yield claimed.element.premise, claimed.within
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


def read_data(
    instances: Instances,
    expression: ex.Expression | None,
    within: Instance | None,
    transition: robosc.Transition | robosc.RequirementTransition | None,
    variable: InstanceVariable | None = None,
) -> Iterator[Reading]:
    """What a written out expression reads of the data of its transition's event.

    `variable` is what it is assigned to.
    """
    reference, event = _event(transition)
    port = None if reference is None else instances.port(reference, within)
    if expression is None or port is None or event is None or event.is_sent:
        return
    bounds = None if variable is None else _bounds(variable.type)
    value = declared_type(data_type(port.communication, event))
    for part, carried in inputs_in(expression, port, event, bounds, is_condition=variable is None):
        access = next(filter(_reads_event, parts(part)))
        reason = Reason(access, within, variable)
        yield Reading(expression, part, carried, reason, value)
        if variable is not None and isinstance(carried, Computed) and may_be_missing(carried):
            yield Reading(expression, part, readable(carried), reason, value, is_readable=True)


def _event(
    transition: robosc.Transition | robosc.RequirementTransition | None,
) -> tuple[robosc.CommunicationReference | None, PortEvent | None]:
    """The communication and the event of a transition; None where it has none."""
    match transition:
        case robosc.ResultTransition():
            return transition.communicationType, event_of(transition.communicationType, transition.resultType)
        case robosc.RequirementTransition() if transition.event is not None:
            return transition.event.communicationType, meant(transition.event)
    return None, None


def _reads_event(part: ex.Expression) -> TypeGuard[robosc.Access | robosc.ErrorReason]:
    """Whether a part is `value` or `error`."""
    return isinstance(part, robosc.ErrorReason) or (isinstance(part, robosc.Access) and part.value)


def _bounds(declared: robosc.DataType) -> tuple[int, int] | None:
    """The range of an integer that has one."""
    if not isinstance(declared, robosc.IntegerDataType) or declared.minimum is None or declared.maximum is None:
        return None
    return declared.minimum, declared.maximum
