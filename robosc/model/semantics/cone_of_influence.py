"""Data elimination: variables and incoming data that the supervisor needs (thesis 5.2.4, made transitive)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias, TypeGuard

from robosc.base.cache import cached
from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.semantics.communication import (
    CONTROLLABLE,
    data_type,
    event_of,
    feedback_event,
    port_event_of,
    sending_event,
    sent_type,
)
from robosc.model.semantics.inputs import ComputedValue, inputs_in, may_be_missing, readable
from robosc.model.semantics.instances import PortInstance
from robosc.model.semantics.state_values import InputContext, StateValue, with_own_parameters, with_state_values
from robosc.model.semantics.typing import declared_type, read_from
from robosc.model.semantics.walks import operands, parts

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.model.semantics.communication import PortEvent
    from robosc.model.semantics.inputs import InputSource
    from robosc.model.semantics.instances import Instance, Instances, InstanceVariable, Statement
    from robosc.model.semantics.typing import Type

    #: Place of an expression that may read data: a transition, or the command that a requirement restricts.
    Carrier: TypeAlias = robosc.Transition | robosc.RequirementTransition | PortInstance

#: Maximum number of valuations in a table of a comparison of doubles. The table ranges over the integers that the
#: comparison depends on. A larger table would exceed any model that contains it.
LARGEST_TABLE = 1 << 16


@dataclass(frozen=True)
class AssignmentPlace:
    """An assignment in its context: the instance, the transition, and the variable (None if it is unresolved).

    `value` is the expanded expression that it assigns.
    """

    instance: Instance
    transition: robosc.Transition
    assignment: robosc.Assignment
    variable: InstanceVariable | None
    value: ex.Expression | None


@dataclass(frozen=True)
class NeedReason:
    """The place that makes a variable or an input necessary: the access, its instance (None: the robot), its use.

    `variable` is the variable that is computed from the access. It is None if the supervisor evaluates the expression.
    """

    access: robosc.Access | robosc.ErrorReason
    within: Instance | None
    variable: InstanceVariable | None


@dataclass(frozen=True)
class InputRead:
    """A part of an expression that reads the data of an event, with its input; None if it cannot be an input.

    `is_readable`: the entry stands for no part. Its input is whether the whole expression can be computed.
    `is_required`: a requirement on the command reads it.
    """

    whole: ex.Expression
    part: ex.Expression
    source: InputSource | None
    reason: NeedReason
    value: Type
    is_readable: bool = False
    is_required: bool = False


@dataclass(frozen=True)
class ConeOfInfluence:
    """Variables and data that the supervisor needs, each with its first reason, in the order of discovery.

    `readings` are the reads of data, `computations` the assignments that the supervisor performs.
    """

    variables: dict[InstanceVariable, NeedReason]
    readings: list[InputRead]
    computations: list[AssignmentPlace]

    @property
    def data(self) -> dict[InputSource, InputRead]:
        """Inputs of the supervisor, each with its first reading."""
        first_readings: dict[InputSource, InputRead] = {}
        for reading in self.readings:
            if reading.source is not None:
                first_readings.setdefault(reading.source, reading)
        return first_readings


def cone_of_influence(instances: Instances) -> ConeOfInfluence:
    """Return the variables and data that guards, requirements and conditions of provided data depend on."""
    assignments: dict[InstanceVariable, list[AssignmentPlace]] = {}
    for assigned in all_assignments(instances):
        if assigned.variable is not None:
            assignments.setdefault(assigned.variable, []).append(assigned)
    result = ConeOfInfluence({}, [], [])
    queue: list[InstanceVariable] = []

    def read(
        expression: ex.Expression | None,
        within: Instance | None,
        carrier: Carrier | None,
        computed: InstanceVariable | None,
    ) -> None:
        readings = list(read_data(instances, expression, within, carrier, computed))
        result.readings.extend(readings)
        for access in _accesses_of_supervisor(expression, readings):
            variable = instances.variable(access, within)
            if variable is not None and variable not in result.variables:
                result.variables[variable] = NeedReason(access, within, computed)
                queue.append(variable)

    for condition in conditions(instances):
        read(condition.expression, condition.within, condition.carrier, None)
    while queue:
        for assigned in assignments.get(queue.pop(0), ()):
            result.computations.append(assigned)
            read(assigned.value, assigned.instance, assigned.transition, assigned.variable)
    return result


@dataclass(frozen=True)
class EvaluatedExpression:
    """An expanded expression that the supervisor itself evaluates, with its place.

    `within` is the instance whose text contains it, or None for the robot. `carrier` determines the event whose data it
    reads.
    """

    expression: ex.Expression
    within: Instance | None
    carrier: Carrier | None = None


def guard_of(transition: robosc.Transition) -> ex.Expression | None:
    """Return the guard of a transition. None if it has no guard."""
    return transition.guard if isinstance(transition, robosc.GuardedTransition) else None


def conditions(instances: Instances) -> Iterator[EvaluatedExpression]:
    """Iterate over all guards and conditions."""
    for instance in instances:
        for transition, _ in instance.transitions:
            guard = guard_of(transition)
            if guard is not None:
                yield EvaluatedExpression(instances.expanded(guard, instance), instance, transition)
    for condition, within, carrier in _statement_needs(instances):
        if condition is not None:
            yield EvaluatedExpression(expanded_for(instances, condition, within, carrier), within, carrier)


def expanded_for(
    instances: Instances, expression: ex.Expression, within: Instance | None, carrier: Carrier | None
) -> ex.Expression:
    """Return the expanded expression. In a requirement, `value` has the type of the command's data."""
    expanded = instances.expanded(expression, within)
    if not isinstance(carrier, PortInstance) or not _reads_command(expanded):
        return expanded
    key = expanded, carrier.communication
    if key not in instances.of_commands:
        instances.of_commands[key] = read_from(expanded, declared_type(sent_type(carrier.communication)))
    return instances.of_commands[key]


def _statement_needs(instances: Instances) -> Iterator[tuple[ex.Expression | None, Instance | None, Carrier | None]]:
    """Iterate over the conditions of requirements, properties, assumptions and statements that provide data."""
    for automaton in instances.statements(robosc.AutomatonRequirement):
        transitions = (transition for state in automaton.element.states for transition in state.transitions)
        yield from ((transition.guard, automaton.within, transition) for transition in transitions)
    yield from _remembered(instances)


def commands(instances: Instances, required: Statement[robosc.CommunicationRequirement]) -> list[PortInstance]:
    """Return the commands that a requirement restricts, each once."""
    target = required.element.target
    references = target.communicationTypes if target else ()
    named = (instances.port(reference, required.within) for reference in references)
    return list(dict.fromkeys(port for port in named if port is not None))


def _carriers(
    instances: Instances, required: Statement[robosc.CommunicationRequirement]
) -> Sequence[PortInstance] | tuple[None]:
    """Return the commands whose data the condition of a requirement reads. A condition without data has None."""
    expanded = instances.expanded(required.element.condition, required.within) if required.element.condition else None
    return commands(instances, required) if _reads_command(expanded) else (None,)


def _reads_command(condition: ex.Expression | None) -> bool:
    """Return whether an expanded condition of a requirement reads the data of the command."""
    return any(access.value for access in accesses(condition))


def _remembered(
    instances: Instances,
) -> Iterator[tuple[ex.Expression | None, Instance | None, PortInstance | None]]:
    """Iterate over the conditions of properties, requirements, assumptions, provided data and invariants.

    They read the robot's stored state. Those of requirements on commands also read the data of the command.
    """
    for claimed in instances.statements(robosc.Property):
        yield claimed.element.condition, claimed.within, None
        if isinstance(claimed.element, robosc.ReachabilityProperty):
            yield claimed.element.premise, claimed.within, None
    for goal in instances.statements(robosc.ReachabilityRequirement):
        yield goal.element.condition, goal.within, None
        yield goal.element.premise, goal.within, None
    for required in instances.statements(robosc.CommunicationRequirement):
        yield from ((required.element.condition, required.within, port) for port in _carriers(instances, required))
    for assumed in instances.statements(robosc.Assumption):
        yield assumed.element.condition, assumed.within, None
    for port in instances.ports():
        for row in (sending_event(port.communication), feedback_event(port.communication)):
            provided = [] if row is None else instances.provide_statements(port, row)
            yield from ((statement.element.condition, statement.within, None) for statement in provided)
    for invariant in instances.statements(robosc.StateInvariant):
        yield invariant.element.condition, invariant.within, None


def all_assignments(instances: Instances) -> Iterator[AssignmentPlace]:
    """Iterate over the assignments of all instances, in the order of the text."""
    for instance in instances:
        for transition, _ in instance.transitions:
            for assignment in transition.assignments:
                variable = instances.variable(assignment.item, instance) if assignment.item else None
                expression = assignment.value
                value = None if expression is None else instances.expanded(expression, instance)
                yield AssignmentPlace(instance, transition, assignment, variable, value)


def accesses(expression: ex.Expression | None) -> Iterator[robosc.Access]:
    """Iterate over the accesses in an expression, from left to right."""
    # Many rules read the conditions, of which the copies of a text with `each` can be long.
    return iter(cached((accesses, expression), lambda: _accesses(expression)))


def _accesses(expression: ex.Expression | None) -> list[robosc.Access]:
    return [part for part in parts(expression) if isinstance(part, robosc.Access)]


def _accesses_of_supervisor(expression: ex.Expression | None, readings: Sequence[InputRead]) -> Iterator[robosc.Access]:
    """Iterate over the accesses in an expression except those in values that the node computes."""
    computed = {reading.part for reading in readings if isinstance(reading.source, StateValue)}
    if not computed:
        yield from accesses(expression)
        return
    pending = [expression]
    while pending:
        part = pending.pop()
        if part is None or part in computed:
            continue
        if isinstance(part, robosc.Access):
            yield part
        pending += reversed(operands(part))


def read_data(
    instances: Instances,
    expression: ex.Expression | None,
    within: Instance | None,
    carrier: Carrier | None,
    variable: InstanceVariable | None = None,
) -> Iterator[InputRead]:
    """Iterate over the reads of event data in an expanded expression.

    `variable` is the variable that the expression is assigned to.
    """
    port, event = _event(instances, within, carrier)
    if expression is None or port is None or event is None:
        return
    if isinstance(carrier, PortInstance) and not _reads_command(expression):
        return
    bounds = None if variable is None else _bounds(variable.type)
    value = declared_type(data_type(port.communication, event))
    is_condition = variable is None
    inputs = list(inputs_in(expression, port, event, bounds, is_condition=is_condition))
    context = InputContext(instances, within, port, event, bounds, is_condition)
    if _is_received(event):
        inputs = list(with_state_values(inputs, expression, context))
    elif is_condition:
        inputs = list(with_own_parameters(inputs, expression, context))
    for part, carried in inputs:
        access = _first_access(part)
        reason = NeedReason(access, within, variable)
        yield InputRead(expression, part, carried, reason, value, is_required=isinstance(carrier, PortInstance))
        if variable is not None and isinstance(carried, ComputedValue) and may_be_missing(carried):
            yield InputRead(expression, part, readable(carried), reason, value, is_readable=True)


def _event(
    instances: Instances, within: Instance | None, carrier: Carrier | None
) -> tuple[PortInstance | None, PortEvent | None]:
    """Return the communication and the event of the data. None if there are none."""
    match carrier:
        case PortInstance():
            return carrier, sending_event(carrier.communication)
        case robosc.ResultTransition():
            reference = carrier.communicationType
            port = None if reference is None else instances.port(reference, within)
            return port, event_of(reference, carrier.resultType)
        case robosc.RequirementTransition() if carrier.event is not None:
            return instances.port(carrier.event.communicationType, within), port_event_of(carrier.event)
    return None, None


def _is_received(event: PortEvent) -> bool:
    """Return whether the robot's nodes send the event, so that the node can compute values beside it."""
    return event.kind not in CONTROLLABLE


def _first_access(part: ex.Expression) -> robosc.Access | robosc.ErrorReason:
    """Return the first access of a part to the event, else to anything."""
    return next(filter(_reads_event, parts(part)), None) or next(accesses(part))


def _reads_event(part: ex.Expression) -> TypeGuard[robosc.Access | robosc.ErrorReason]:
    """Return whether a part is `value` or `error`."""
    return isinstance(part, robosc.ErrorReason) or (isinstance(part, robosc.Access) and part.value)


def _bounds(declared: robosc.DataType) -> tuple[int, int] | None:
    """Return the bounds of an integer with a range. None for other types."""
    if not isinstance(declared, robosc.IntegerDataType) or declared.minimum is None or declared.maximum is None:
        return None
    return declared.minimum, declared.maximum
