"""Type check of one expression. Each fault is reported once, at its place."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

from robosc.language.checks.edits import Choice, Replacement
from robosc.language.checks.libraries import instances
from robosc.language.checks.rule import Finding
from robosc.language.checks.type_repairs import equality_repair, negated_comparison, repair
from robosc.model import expression as ex
from robosc.model import robosc as rsc
from robosc.model.semantics.expansion import constant_value
from robosc.model.semantics.instances import instance_text
from robosc.model.semantics.naming import TEXT_FUNCTION, escape_keyword
from robosc.model.semantics.operators import SYMBOLS, Operator, TypeRule, operator_of
from robosc.model.semantics.typing import (
    BOOLEAN,
    DOUBLE,
    INTEGER,
    NONE,
    STRING,
    UNKNOWN,
    ArrayType,
    EnumType,
    ObjectType,
    Type,
    access_types,
    declared_type,
    infer,
    is_number,
    operator_type,
)
from robosc.model.semantics.walks import branches, fold, operands

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.language.checks.edits import Hint


class Restriction(Enum):
    """Names that an expression may read."""

    FREE = "any"
    CONSTANT = "enum values"
    ENUM_RULE = "`value` and enum values"
    FUNCTION = "parameters and constants"


@dataclass(frozen=True)
class Place:
    """Context of an expression: the type of `value` or why there is none, and the names that it may read.

    `has_reason`: whether the expression may read `error`. `what` and `instead` are for expressions that must be
    constant: `what` names the expression in messages, and `instead` ends the hint.
    """

    value: Type | None
    why_no_value: str = ""
    restriction: Restriction = Restriction.FREE
    what: str = "an initial value"
    instead: str = "; a transition can assign the rest"
    has_reason: bool = False


_STORE_REASON = "store it in a variable by `on error from … do why := error`, and read the variable"
#: Argument types of functions that take no basic type: a test of a type, and its name.
_FITTING: Mapping[TypeRule, tuple[Callable[[Type], bool], str]] = {
    TypeRule.SIZE: (lambda kind: isinstance(kind, ArrayType) or kind == STRING, "an array or a string"),
    TypeRule.ELEMENTS: (
        lambda kind: isinstance(kind, ArrayType) and (is_number(kind.element) or kind.element == UNKNOWN),
        "an array of integers or doubles",
    ),
}
#: Items that constant expressions may read, and those that rules of enums and functions may read.
_CONSTANT_ITEMS = (rsc.EnumValue, rsc.Constant, rsc.FormalParameter, rsc.ArrayElement)
_SET_ITEMS = (*_CONSTANT_ITEMS, rsc.Parameter)
CONSTANT = Place(None, restriction=Restriction.CONSTANT)
ENUM_RULE = Restriction.ENUM_RULE


class ExpressionCheck:
    """Type check of an expression in a context, which collects findings.

    A faulty expression has the type UNKNOWN for the expression around it. Each fault therefore gives only one finding.
    """

    def __init__(self, place: Place) -> None:
        self.place = place
        self.findings: list[Finding] = []

    def expect(self, expression: ex.Expression | None, expected: Type, what: str) -> None:
        """Report the expression unless it has exactly this type; `what` names its role."""
        actual = self.type(expression)
        if expression is not None and UNKNOWN not in {actual, expected} and actual != expected:
            wants, finds = names(expected, actual)
            self.report(expression, f"{what} must be {wants}, found {finds}", repair(expression, actual, expected))

    def expect_data(self, value: ex.Expression | None, expected: Type, what: str) -> None:
        """Report provided data unless it has this type; the properties of an object value are checked one by one."""
        if isinstance(expected, EnumType) or expected == NONE:
            expected = UNKNOWN  # `data-type` and `data-provisioning` report this.
        if isinstance(value, ex.Conditional) and _is_structured(value, expected):
            self._expect_choice(value, expected, what)
            return
        if isinstance(value, rsc.ArrayLiteral):
            if expected != UNKNOWN and not isinstance(expected, ArrayType):
                self.report(value, f"{what} must be {expected}, found an array", repair(value, UNKNOWN, expected))
            for element in value.elements:
                self.expect(
                    element, expected.element if isinstance(expected, ArrayType) else UNKNOWN, f"an element of {what}"
                )
            return
        if not isinstance(value, rsc.ObjectValue):
            self.expect(value, expected, what)
            return
        if expected != UNKNOWN and not isinstance(expected, ObjectType):
            self.report(value, f"{what} must be {expected}, found an object value", repair(value, UNKNOWN, expected))
        for field in value.properties:
            name = f"the value of property `{field.property.name}`" if field.property else "the value"
            self.expect_data(field.value, declared_type(field.property.type) if field.property else UNKNOWN, name)

    def _expect_choice(self, choice: ex.Conditional, expected: Type, what: str) -> None:
        pending: list[ex.Expression | None] = [choice]
        while pending:
            branch = pending.pop()
            if isinstance(branch, ex.Conditional):
                self.expect(branch.condition, BOOLEAN, "the condition after `if`")
                pending += [branch.otherwise, branch.then]
            else:
                self.expect_data(branch, expected, what)

    def type(self, expression: ex.Expression | None) -> Type:
        """Return the type of the expression and report faults within it; UNKNOWN if it is faulty itself."""
        return UNKNOWN if expression is None else fold(self._typed, expression, _inside)

    def _typed(self, expression: ex.Expression | None, types: list[Type]) -> Type:
        row = operator_of(expression)
        match expression:
            case None:
                return UNKNOWN
            case rsc.Access():
                return self._access(expression, types)
            case rsc.ErrorReason() if not self.place.has_reason:
                self.report(expression, "`error` cannot be read here: it exists only at one `error`", _STORE_REASON)
                return UNKNOWN
            case rsc.ArrayLiteral():
                self.report(
                    expression,
                    "an array is part of an expression, expected a value of a basic type or an enum",
                    "provide arrays as a whole or as the value of a property",
                )
                return UNKNOWN
            case rsc.ObjectValue():
                self.report(
                    expression,
                    "an object value is part of an expression, expected a value of a basic type or an enum",
                    "provide objects as a whole or as the value of a property",
                )
            case ex.Conditional():
                return self._conditional(expression, types)
            case rsc.Call():
                return declared_type(expression.function.type) if expression.function else UNKNOWN
            case rsc.ArrayQuantifier() | rsc.InstanceQuantifier() | rsc.IntegerText():
                self._own_operands(expression, types)
        return infer(expression) if row is None else self._operator(expression, row, types)

    def _own_operands(
        self, expression: rsc.ArrayQuantifier | rsc.InstanceQuantifier | rsc.IntegerText, types: list[Type]
    ) -> None:
        """Report wrong operands of an expression without a row in the table of operators."""
        if isinstance(expression, rsc.ArrayQuantifier):
            self._quantifier(expression, types)
        elif isinstance(expression, rsc.InstanceQuantifier):
            self._operand(expression.body, types[0], BOOLEAN, f"the condition of `{expression.quantifier}`")
        else:
            self._operand(expression.operand, types[0], INTEGER, f"the argument of `{TEXT_FUNCTION}`")
            is_joined = isinstance(expression.eContainer(), ex.Addition)  # `+` is a finding there
            if self.place.restriction is not Restriction.CONSTANT and not is_joined:
                message = f"`{TEXT_FUNCTION}` is in an expression that is not constant, expected a constant string"
                self.report(expression, message, "declare a `constant` for the whole string")

    def _quantifier(self, quantifier: rsc.ArrayQuantifier, types: list[Type]) -> None:
        if types[0] != UNKNOWN and not isinstance(types[0], ArrayType):
            message = f"the operand of `in` must be an array, found {types[0]}"
            self.report(quantifier.array, message, "write the name of an array there")
        self._operand(quantifier.body, types[1], BOOLEAN, f"the condition of `{quantifier.quantifier}`")

    def _operand(self, operand: ex.Expression | None, actual: Type, expected: Type, what: str) -> None:
        if operand is not None and UNKNOWN not in {actual, expected} and actual != expected:
            self.report(operand, f"{what} must be {expected}, found {actual}", repair(operand, actual, expected))

    def _conditional(self, choice: ex.Conditional, types: list[Type]) -> Type:
        condition, then, otherwise = types
        self._operand(choice.condition, condition, BOOLEAN, "the condition after `if`")
        self._operand(choice.otherwise, otherwise, then, "the value after `else`, as after `then`,")
        if isinstance(then, ArrayType | ObjectType):
            message = f"the value after `then` must be one value, found {then}"
            self.report(choice.then, message, repair(choice.then, then, UNKNOWN))
            return UNKNOWN
        return then if then != UNKNOWN else otherwise

    def report(self, element: ex.Located, message: str, hint: Hint) -> None:
        """Add a finding."""
        self.findings.append(Finding(element, message, hint))

    def _operator(self, operator: ex.Expression, row: Operator, types: list[Type]) -> Type:
        if row.rule is TypeRule.EQUALITY:
            self._equality(operator, types)
        elif isinstance(operator, ex.Addition) and {*types} == {STRING}:
            if self.place.restriction is not Restriction.CONSTANT:
                hint = "declare a `constant` for the whole string"
                self.report(
                    operator, "`+` joins strings in an expression that is not constant, expected a constant", hint
                )
        else:
            expected = {TypeRule.LOGICAL: BOOLEAN, TypeRule.INTEGER: INTEGER, TypeRule.ROUNDING: DOUBLE}.get(row.rule)
            fits, names_wanted = _FITTING.get(row.rule, (is_number, "integer or double"))
            what = "argument" if row.parameters else "operand"
            for operand, actual in zip(operands(operator), types, strict=True):
                if operand is not None and actual != UNKNOWN and not (actual == expected if expected else fits(actual)):
                    mended = (
                        "write the name of an array there" if row.rule in _FITTING else negated_comparison(operator)
                    )
                    self.report(
                        operand,
                        f"an {what} of `{row.symbol}` must be {expected or names_wanted}, found {actual}",
                        mended or repair(operand, actual, expected or DOUBLE),
                    )
        return operator_type(row, types)

    def _equality(self, operator: Any, types: list[Type]) -> None:
        symbol = SYMBOLS[type(operator)]
        operands = (operator.left, operator.right)
        comparable = [
            kind in {BOOLEAN, INTEGER, DOUBLE, STRING, UNKNOWN} or isinstance(kind, EnumType) for kind in types
        ]
        for operand, actual, fits in zip(operands, types, comparable, strict=True):
            if not fits:
                self.report(
                    operand,
                    f"an operand of `{symbol}` must be boolean, integer, double, string or an enum, found {actual}",
                    repair(operand, actual, UNKNOWN),
                )
        left, right = types
        if all(comparable) and UNKNOWN not in types and left != right:
            finds = " and ".join(names(left, right))
            place, hint = equality_repair(operator, left, right)
            self.report(place, f"both sides of `{symbol}` must have one type, found {finds}", hint)

    def _access(self, access: rsc.Access, indices: list[Type]) -> Type:
        refusal = self._refusal(access)
        if refusal:
            self.report(access, *refusal)
            return UNKNOWN
        for index, actual in zip(operands(access), indices, strict=True):
            self._operand(index, actual, INTEGER, "an index")
        types = access_types(access, self.place.value)
        for before, segment in zip(types, access.segments, strict=False):
            if isinstance(segment, rsc.IndexSegment) and not isinstance(before, ArrayType) and before != UNKNOWN:
                text = f"`[{segment.index}]`" if segment.first is None else "in brackets"
                message = f"the index {text} must follow an array, found {before}"
                hint = f"leave {text if segment.first is None else 'it'} out"
                self.report(segment, message, Replacement(hint, "", segment, is_choice=True))
                return UNKNOWN
        return types[-1]

    def _refusal(self, access: rsc.Access) -> tuple[str, Hint] | None:
        """Return why the access is not allowed here and how to repair it; None if it is allowed."""
        item, restriction = access.item, self.place.restriction
        if restriction is Restriction.CONSTANT and (access.value or (item and not isinstance(item, _CONSTANT_ITEMS))):
            return (
                f"{self.place.what} must be a constant, found {_describe(access)}",
                f"use literals, constants, operators and enum values{self.place.instead}",
            )
        if restriction is Restriction.ENUM_RULE and item and not isinstance(item, _SET_ITEMS):
            return (
                f"an enum rule reads `value`, constants, parameters and enum values only, found {_describe(access)}",
                "compare `value` with literals; requirements and guards can combine the enum with the rest",
            )
        if restriction is Restriction.FUNCTION and item and not isinstance(item, _SET_ITEMS):
            return (
                f"a function reads parameters, constants and enum values only, found {_describe(access)}",
                "add a parameter for this value, or declare a `condition`",
            )
        if access.value and self.place.value is None:
            return (
                f"`value` cannot be read here: {self.place.why_no_value}",
                "store it in a variable by `on response from … do variable := value`, and read the variable",
            )
        if isinstance(item, rsc.Component):
            number = constant_value(access.index if access.index is not None else item.first)
            named = instance_text(item, number)
            members = [f"{named}.{escape_keyword(member)}" for member in _members(item)]
            message = f"component `{item.name}` has no value of its own, expected one of its states or variables"
            if not members:
                return message, f"`{item.name}` has neither: leave it out"
            ways = tuple(Replacement(f"write `{member}`", member, access) for member in members)
            return message, Choice(f"write {' or '.join(f'`{member}`' for member in members[:3])}", ways)
        return None


def _inside(expression: ex.Expression | None) -> list[ex.Expression]:
    """Return the operands to check; literals of objects and arrays are findings themselves."""
    return [] if isinstance(expression, rsc.ObjectValue | rsc.ArrayLiteral) else operands(expression)


def _is_structured(choice: ex.Conditional, expected: Type) -> bool:
    """Return whether a conditional in provided data chooses between objects or arrays."""
    return isinstance(expected, ArrayType | ObjectType) or any(
        isinstance(branch, rsc.ObjectValue | rsc.ArrayLiteral) or isinstance(infer(branch), ArrayType | ObjectType)
        for _, branch in branches(choice)
    )


def names(first: Type, second: Type) -> tuple[str, str]:
    """Return two different types as text, with their libraries if their names are equal."""
    if str(first) == str(second):
        return _with_unit(first), _with_unit(second)
    return str(first), str(second)


def _with_unit(named: Type) -> str:
    if not isinstance(named, (EnumType, ObjectType)):
        return str(named)
    unit: Any = named.definition.eContainer()
    if isinstance(unit, rsc.InterfaceTypeReference):
        return f"{named} of package {unit.package}"
    return f"{named} of {type(unit).__name__.lower()} {unit.name}" if unit else str(named)


def _describe(access: rsc.Access) -> str:
    if access.value or access.item is None:
        return "`value`"
    return f"{type(access.item).__name__.lower()} `{access.item.name}`"


def _members(component: rsc.Component) -> list[str]:
    known = instances(component.eContainer())
    instance = known.instance(component, None) or next(iter(known.fleet(component).values()), None)
    automaton = instance.automaton if instance else None
    return [
        definition.name
        for definition in (automaton.definitions if automaton else ())
        if isinstance(definition, rsc.AccessibleItem)
    ]
