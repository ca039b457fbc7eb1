"""The types of the expressions of sct and rosgraph models, where both operands of an operator have one type."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

#: `boolean`, `integer`, `double`, `string`, or the enumeration itself; None where no type can be told.
ValueType: TypeAlias = str | ex.Enumeration | None

_LOGICAL = (ex.Conjunction, ex.Disjunction, ex.Implication)
_EQUALITY = (ex.Equation, ex.Inequation)
_ORDERING = (ex.LessThan, ex.LessOrEqual, ex.GreaterThan, ex.GreaterOrEqual)
_ARITHMETIC = (ex.Addition, ex.Subtraction, ex.Multiplication)
_DECLARED = {
    ex.BooleanType: "boolean",
    ex.IntegerType: "integer",
    ex.DoubleType: "double",
    ex.StringType: "string",
}
_LITERAL = {
    ex.BooleanLiteral: "boolean",
    ex.IntegerLiteral: "integer",
    ex.DoubleLiteral: "double",
    ex.StringLiteral: "string",
}

#: What refers to a declaration, whose type may be missing.
_TYPED = (
    sct.VariableReference,
    sct.InputReference,
    rosgraph.NodeVariableReference,
    rosgraph.WireAccess,
    rosgraph.ConversionCall,
)


def declared_type(kind: ex.Type | None) -> ValueType:
    """The type that a variable, an input or a field is declared with."""
    return kind.enumeration if isinstance(kind, ex.EnumerationType) else _DECLARED.get(type(kind))


def _atomic_type(expression: ex.Expression) -> ValueType:
    match expression:
        case ex.EnumerationLiteralReference():
            owner: ex.Enumeration = expression.literal.eContainer()
            return owner
        case sct.LocationReference():
            return "boolean"
        case sct.VariableReference() | rosgraph.NodeVariableReference():
            return declared_type(expression.variable.type)
        case sct.InputReference():
            return declared_type(expression.input.type)
        case rosgraph.WireAccess():
            return declared_type(expression.type)
        case rosgraph.ConversionCall():
            return expression.conversion.enumeration
    return _LITERAL.get(type(expression))


def is_double(expression: ex.Expression) -> bool:
    """Whether the value of a well-typed expression is a double."""
    match expression:
        case ex.Division() | ex.DoubleConversion():
            return True
        case ex.UnaryMinus():
            return is_double(expression.operand)
        case ex.Conditional():
            return is_double(expression.then)
        case ex.BinaryExpression():
            return isinstance(expression, _ARITHMETIC) and is_double(expression.left)
    return _atomic_type(expression) == "double"


def named(kind: ValueType) -> str:
    """The type as a message names it."""
    return f"enumeration {kind.name}" if isinstance(kind, ex.Enumeration) else kind or "unknown type"


class ExpressionTypes:
    """The types of expressions, and what is wrong with them; no expression is looked into twice."""

    def __init__(self) -> None:
        self._types: dict[ex.Expression, ValueType] = {}
        #: Each expression that does not fit its operator, with the reason.
        self.faults: list[tuple[ex.Expression, str]] = []

    def add(self, elements: Iterable[Any]) -> None:
        """Types all expressions among the elements, which come with what is above before what is below."""
        for element in reversed(list(elements)):
            if isinstance(element, ex.Expression):
                self._types[element] = self._type(element)

    def unless(self, expression: ex.Expression, wanted: ValueType) -> Iterator[tuple[ex.Expression, str]]:
        """The fault, if an expression is of another type than is wanted."""
        found = self._types[expression]
        if found is not None and wanted is not None and found != wanted:
            yield expression, f"this is of {named(found)}, but {named(wanted)} is wanted"

    def _want(self, expression: ex.Expression, wanted: ValueType) -> None:
        self.faults += self.unless(expression, wanted)

    def _same(self, expression: ex.Expression, first: ex.Expression, second: ex.Expression) -> ValueType:
        left, right = self._types[first], self._types[second]
        if left is None or right is None or left == right:
            return left or right
        self.faults.append((expression, f"the operands are of {named(left)} and {named(right)}, not of one type"))
        return None

    def _number(self, expression: ex.Expression, kind: ValueType) -> ValueType:
        if kind in (None, "integer", "double"):
            return kind
        self.faults.append((expression, f"numbers are wanted, not {named(kind)}"))
        return None

    def _type(self, expression: ex.Expression) -> ValueType:
        match expression:
            case ex.BinaryExpression():
                return self._binary(expression)
            case ex.Negation():
                self._want(expression.operand, "boolean")
                return "boolean"
            case ex.UnaryMinus():
                return self._number(expression, self._types[expression.operand])
            case ex.DoubleConversion():
                self._want(expression.operand, "integer")
                return "double"
            case ex.Conditional():
                self._want(expression.condition, "boolean")
                return self._same(expression, expression.then, expression.otherwise)
        return self._atom(expression)

    def _binary(self, expression: ex.BinaryExpression) -> ValueType:
        if isinstance(expression, _LOGICAL):
            self._want(expression.left, "boolean")
            self._want(expression.right, "boolean")
            return "boolean"
        if isinstance(expression, ex.Division):
            self._want(expression.left, "double")
            self._want(expression.right, "double")
            return "double"
        common = self._same(expression, expression.left, expression.right)
        if isinstance(expression, _EQUALITY):
            return "boolean"
        number = self._number(expression, common)
        return "boolean" if isinstance(expression, _ORDERING) else number

    def _atom(self, expression: ex.Expression) -> ValueType:
        found = _atomic_type(expression)
        if found is None and not isinstance(expression, _TYPED):
            self.faults.append((expression, f"{type(expression).__name__} belongs in a robosc model only"))
        return found
