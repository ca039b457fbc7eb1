"""Rule `type` (thesis 4.5.11, table 4.1): the places of expressions, and the type of each place."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from robosc.language.checks.definitions import (
    assigned_variable,
    communication_of,
    data_types,
    identified_elements,
    of_kind,
    sends_message,
    statements,
    transitions,
    variables,
)
from robosc.language.checks.edits import Choice, Replacement
from robosc.language.checks.expression_types import CONSTANT, ENUM_RULE, ExpressionCheck, Place, Restriction
from robosc.language.checks.rule import Finding, rule
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import is_error, port_event_of
from robosc.model.semantics.durations import set_on_robot
from robosc.model.semantics.typing import (
    BOOLEAN,
    DOUBLE,
    INTEGER,
    NONE,
    STRING,
    UNKNOWN,
    ArrayType,
    ObjectType,
    Type,
    declared_type,
    provided_data_type,
    read_from,
    value_types,
)
from robosc.model.semantics.typing import value_type as value_type_in

if TYPE_CHECKING:
    from collections.abc import Iterator

_GUARD = Place(None, "a guard reads states and variables, and `value` is the data of one event")
_REQUIREMENT = Place(None, "this condition reads states and variables, and `value` is the data of one event")
_ASSUMPTION = Place(None, "an assumption reads the state before the event, and `value` is the data of the event")
_PROVIDE = Place(None, "provided data comes from states and variables, and `value` is the data of one event")
_FUNCTION = Place(None, "a function computes its value from its parameters", Restriction.FUNCTION)
_TIMED = Place(None, "an expired time has no data")
_SILENT = Place(None, "a silent transition has no event and no data")


@rule("type")
def types(base: rsc.Base) -> Iterator[Finding]:
    """Every expression has the type of its place, and every operator has operands of its types."""
    for enum in of_kind(rsc.EnumDataType, base.definitions):
        yield from _enum(enum)
    yield from _requirements(base)
    for statement in statements(rsc.DataStatement, base):
        yield from _data(statement)
    for named in statements(rsc.NamedExpression, base):
        yield from _named(named)
    for computed in _computed(base):
        yield from _constant(computed, INTEGER, "the bound of a range")
    for identified in identified_elements(base):
        yield from _constant(identified.computedIdentifier, STRING, "an identifier")
    for declared in variables(base):
        check = ExpressionCheck(CONSTANT)
        is_stored = isinstance(declared_type(declared.type), ArrayType | ObjectType)
        expected = UNKNOWN if is_stored else _variable_type(declared)  # `variable-type` reports initial values here.
        check.expect(declared.initial, expected, f"the initial value of `{declared.name}`")
        yield from check.findings
    for _, transition in transitions(base):
        yield from _transition(transition)


def _requirements(base: rsc.Base) -> Iterator[Finding]:
    for requirement in statements(rsc.CommunicationRequirement, base):
        yield from _required(requirement)
    for invariant in statements(rsc.StateInvariant, base):
        yield from _boolean(invariant.condition, f"the condition after `{invariant.kind.name}`", _REQUIREMENT)
    for count in statements(rsc.CountRequirement, base):
        yield from _constant(count.bound, INTEGER, "the number after `at most`")
    for assumed in statements(rsc.Assumption, base):
        yield from _boolean(assumed.condition, "the condition of an assumption", _ASSUMPTION)
    for claimed in statements(rsc.Property, base):
        yield from _boolean(claimed.condition, "the condition of a property", _REQUIREMENT)
        if isinstance(claimed, rsc.ReachabilityProperty):
            yield from _boolean(claimed.premise, "the condition after `from`", _REQUIREMENT)
    for required in statements(rsc.ReachabilityRequirement, base):
        yield from _boolean(required.condition, "the condition after `reachable`", _REQUIREMENT)
        yield from _boolean(required.premise, "the condition after `from`", _REQUIREMENT)
    for automaton in statements(rsc.AutomatonRequirement, base):
        for transition in (transition for state in automaton.states for transition in state.transitions):
            has_reason = transition.event is not None and is_error(port_event_of(transition.event))
            place = replace(_REQUIREMENT, value=value_type_in(transition), has_reason=has_reason)
            yield from _boolean(transition.guard, "the condition after `if`", place)


def _required(requirement: rsc.CommunicationRequirement) -> Iterator[Finding]:
    """Check a condition for the data of each command: first in the text itself, then in copies."""
    condition, what = requirement.condition, "the condition of a requirement"
    kinds = () if condition is None else value_types(condition)
    yield from _boolean(condition, what, replace(_REQUIREMENT, value=next(iter(kinds), None)))
    hint = "write one requirement for each type of data"
    for kind in kinds[1:]:
        check = ExpressionCheck(replace(_REQUIREMENT, value=kind))
        check.expect(read_from(condition, kind), BOOLEAN, what)
        for finding in check.findings[:1]:
            yield replace(finding, element=condition, message=f"with data of type {kind}: {finding.message}", hint=hint)


def _named(named: rsc.NamedExpression) -> Iterator[Finding]:
    name = f"`{named.name}`"
    match named:
        case rsc.Condition():
            yield from _boolean(named.value, f"the condition {name}", _GUARD)
        case rsc.Constant():
            yield from _of_one_value(named.type, f"constant {name}")
            yield from _constant(named.value, declared_type(named.type), f"the value of {name}")
        case rsc.Parameter():
            yield from _of_one_value(named.type, f"parameter {name}")
            yield from _constant(named.value, declared_type(named.type), f"the value of {name}")
            for bound in (named.lowest, named.highest):
                yield from _constant(bound, DOUBLE, f"a bound of {name}")
        case rsc.Function():
            for parameter in named.parameters:
                if declared_type(parameter.type) == NONE:
                    yield from _of_one_value(parameter.type, f"parameter `{parameter.name}` of {name}")
            check = ExpressionCheck(_FUNCTION)
            if check.type(named.value) == declared_type(named.type):
                yield from _of_one_value(named.type, f"function {name}")
            else:
                check.expect(named.value, declared_type(named.type), f"the value of {name}")
            yield from check.findings


def _of_one_value(declared: rsc.DataType | None, what: str) -> Iterator[Finding]:
    actual = declared_type(declared)
    if declared is not None and (actual == NONE or isinstance(actual, ArrayType | ObjectType)):
        hint = "write `boolean`, `integer`, `double`, `string` or the name of an enum"
        ways = tuple(
            Replacement(f"write `{name}`", name, declared) for name in ("boolean", "integer", "double", "string")
        )
        yield Finding(declared, f"{what} is of type {actual}, expected a type of one value", Choice(hint, ways))


def _constant(value: ex.Expression | None, expected: Type, what: str) -> Iterator[Finding]:
    check = ExpressionCheck(replace(CONSTANT, what=what))
    check.expect(value, expected, what)
    yield from check.findings


def _computed(base: rsc.Base) -> Iterator[ex.Expression]:
    for declared in of_kind(rsc.IntegerDataType, data_types(base)):
        yield from (bound for bound in (declared.lower, declared.upper) if bound is not None)


def _enum(enum: rsc.EnumDataType) -> Iterator[Finding]:
    place = Place(declared_type(enum.type), restriction=ENUM_RULE)
    for alternative in of_kind(rsc.EnumTransformationRule, enum.rules):
        yield from _boolean(alternative.condition, "the condition of an enum rule", place)


def _data(statement: rsc.DataStatement) -> Iterator[Finding]:
    communication = communication_of(statement.communicationType)
    is_limit = isinstance(statement, rsc.LimitStatement)
    place = Place(value_type_in(statement)) if is_limit else _PROVIDE
    check = ExpressionCheck(place)
    what = f"the data of `{communication.name}`" if communication else "the data"
    check.expect_data(statement.data, provided_data_type(communication), what)
    yield from check.findings
    yield from _boolean(
        statement.condition, f"the condition of a {'limit' if is_limit else 'provide statement'}", place
    )


def _transition(transition: rsc.Transition) -> Iterator[Finding]:
    place = guarded = _SILENT
    if isinstance(transition, rsc.ResultTransition):
        without = f"the event `{transition.resultType}` carries no data to a component"
        has_reason = transition.resultType == rsc.ResultType.error
        place = guarded = Place(value_type_in(transition), without, has_reason=has_reason)
        if transition.guard is not None:
            guarded = replace(place, value=value_type_in(transition.guard))
    if isinstance(transition, rsc.TimedTransition):
        place = _TIMED
        yield from _duration(transition.duration)
    elif sends_message(transition):
        place = Place(UNKNOWN)  # `assignment-on-message-to-node` reports assignments here.
    if isinstance(transition, rsc.GuardedTransition):
        yield from _boolean(transition.guard, "a guard", guarded)
    for assignment in transition.assignments:
        variable = assigned_variable(assignment)
        check = ExpressionCheck(place)
        if variable is not None:
            check.type(assignment.item)
            expected = UNKNOWN if assignment.item.segments else _variable_type(variable)
            check.expect(assignment.value, expected, f"a value for `{variable.name}`")
        else:
            check.type(assignment.value)
        yield from check.findings


def _duration(value: ex.Expression | None) -> Iterator[Finding]:
    check = ExpressionCheck(Place(None) if set_on_robot(value) else replace(CONSTANT, what="a duration"))
    actual = check.type(value)
    if value is not None and actual not in {INTEGER, DOUBLE, UNKNOWN}:
        hint = Replacement("write a number, such as `3.0 s`", "3.0", value, is_choice=True)
        check.report(value, f"a duration must be integer or double, found {actual}", hint)
    yield from check.findings


def _variable_type(variable: rsc.Variable) -> Type:
    """Return the type of a variable; UNKNOWN for a type that `variable-type` reports."""
    declared = declared_type(variable.type)
    return UNKNOWN if declared == NONE else declared


def _boolean(condition: ex.Expression | None, what: str, place: Place) -> Iterator[Finding]:
    check = ExpressionCheck(place)
    check.expect(condition, BOOLEAN, what)
    yield from check.findings
