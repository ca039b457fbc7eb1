"""`type` (thesis 4.5.11, table 4.1) and `argument`: where expressions stand, and which type each must have there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.definitions import (
    assigned_variable,
    communication_of,
    of_kind,
    sends_message,
    transitions,
    variables,
)
from robosc.checks.expression_types import CONSTANT, ENUM_RULE, ExpressionCheck, Place
from robosc.checks.rule import Finding, rule
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc as rsc
from robosc.metamodel.reflection import tree
from robosc.semantics.cone_of_influence import accesses
from robosc.semantics.evaluation import evaluate
from robosc.semantics.operators import FUNCTIONS
from robosc.semantics.typing import (
    BOOLEAN,
    INTEGER,
    NONE,
    UNKNOWN,
    ArrayType,
    ObjectType,
    Type,
    declared_type,
    provided_data_type,
    type_of,
)
from robosc.semantics.typing import value_type as value_type_in

if TYPE_CHECKING:
    from collections.abc import Iterator

_GUARD = Place(None, "a guard reads what the component remembers, and `value` is the data of one event")
_REQUIREMENT = Place(None, "a requirement reads what components remember, and `value` is the data of one event")
_PROVIDE = Place(None, "provided data is read from what components remember, and `value` is the data of one event")
_SILENT = Place(None, "a silent transition has no event that could carry data")


@rule("type")
def types(base: rsc.Base) -> Iterator[Finding]:
    """Every expression has the type that its place wants, and its operators the operands that they want."""
    for definition in base.definitions:
        match definition:
            case rsc.EnumDataType():
                yield from _enum(definition)
            case rsc.Requirement():
                yield from _boolean(definition.condition, "the condition of a requirement", _REQUIREMENT)
            case rsc.ProvideStatement():
                yield from _provide(definition)
    for declared in variables(base):
        check = ExpressionCheck(CONSTANT)
        check.expect(declared.initial, _variable_type(declared), f"the initial value of `{declared.name}`")
        yield from check.findings
    for _, transition in transitions(base):
        yield from _transition(transition)


def _enum(enum: rsc.EnumDataType) -> Iterator[Finding]:
    place = Place(declared_type(enum.type), restriction=ENUM_RULE)
    for alternative in of_kind(rsc.EnumTransformationRule, enum.rules):
        yield from _boolean(alternative.condition, "the condition of an enum rule", place)


def _provide(statement: rsc.ProvideStatement) -> Iterator[Finding]:
    communication = communication_of(statement.communicationType)
    check = ExpressionCheck(_PROVIDE)
    what = f"the data of `{communication.name}`" if communication else "the data"
    check.provided(statement.data, provided_data_type(communication), what)
    yield from check.findings
    yield from _boolean(statement.condition, "the condition of a provide statement", _PROVIDE)


def _transition(transition: rsc.Transition) -> Iterator[Finding]:
    place = _SILENT
    if isinstance(transition, rsc.TauTransition):
        yield from _boolean(transition.guard, "a guard", _GUARD)
    elif sends_message(transition):
        place = Place(UNKNOWN)  # That nothing can be assigned there is the matter of `assignment-on-message-to-node`.
    elif isinstance(transition, rsc.ResultTransition):
        place = Place(value_type_in(transition), f"the event `{transition.resultType}` carries no data to a component")
    for assignment in transition.assignments:
        variable = assigned_variable(assignment)
        check = ExpressionCheck(place)
        if variable is not None:
            check.type(assignment.item)
            wanted = UNKNOWN if assignment.item.segments else _variable_type(variable)
            check.expect(assignment.value, wanted, f"a value for `{variable.name}`")
        else:
            check.type(assignment.value)
        yield from check.findings


def _variable_type(variable: rsc.Variable) -> Type:
    """What a variable holds; what no variable can hold is the matter of `variable-type`."""
    declared = declared_type(variable.type)
    return UNKNOWN if declared == NONE or isinstance(declared, (ArrayType, ObjectType)) else declared


def _boolean(condition: ex.Expression | None, what: str, place: Place) -> Iterator[Finding]:
    check = ExpressionCheck(place)
    check.expect(condition, BOOLEAN, what)
    yield from check.findings


@rule("argument")
def arguments(base: rsc.Base) -> Iterator[Finding]:
    """A function gets as many arguments as it has parameters, and a positive constant to divide by."""
    for _, element in tree(base):
        if not isinstance(element, ex.FunctionCall):
            continue
        row, given = FUNCTIONS[element.function], list(element.arguments)
        names = [f"`{name}`" for name in "abcdef"[: row.parameters]]
        if len(given) != row.parameters:
            wanted = "argument" if row.parameters == 1 else "arguments"
            yield Finding(
                element,
                f"`{row.symbol}` has {row.parameters} {wanted}, found {len(given)}",
                f"write `{row.symbol}({', '.join(name.strip('`') for name in names)})`",
            )
            continue
        for position in sorted(row.divisors):
            if _is_no_divisor(given[position]):
                yield Finding(
                    given[position],
                    f"argument {position + 1} of `{row.symbol}` must be a positive constant",
                    "write an integer from 1 on, such as `10`",
                )


def _is_no_divisor(expression: ex.Expression) -> bool:
    """Whether an integer is read from somewhere, or below 1; what is no integer the rule `type` reports."""
    if type_of(expression) != INTEGER:
        return False
    return next(accesses(expression), None) is not None or evaluate(expression, lambda access: access) < 1  # type: ignore[operator]
