"""How expression trees become text: one table of precedence, one printer that every target refines."""

import json
from collections.abc import Iterable, Mapping
from decimal import Decimal
from functools import reduce
from typing import Any, ClassVar, TypeVar

from robosc.diagnostics.visible import visible
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc, sct
from robosc.metamodel.reflection import features, is_attribute
from robosc.semantics.naming import written
from robosc.semantics.recursion import deep_recursion

_Kind = TypeVar("_Kind", bound=ex.Expression)

#: Loosest to tightest, for RoboSC and for every target: none binds differently, and where one has finer levels
#: (or a compiler that warns), `_LOOSE_PAIRS` adds parentheses.
PRECEDENCE: Mapping[type[ex.Expression], int] = {
    ex.Implication: 1,
    ex.Disjunction: 2,
    ex.Conjunction: 3,
    ex.Equation: 4,
    ex.Inequation: 4,
    ex.LessThan: 5,
    ex.LessOrEqual: 5,
    ex.GreaterThan: 5,
    ex.GreaterOrEqual: 5,
    ex.Addition: 6,
    ex.Subtraction: 6,
    ex.Multiplication: 7,
    ex.Division: 7,
    ex.Negation: 8,
    ex.UnaryMinus: 8,
}
ATOM = 9
_CHAINS = (ex.Disjunction, ex.Conjunction, ex.Addition, ex.Multiplication)
_LOOSE_PAIRS = {(2, 3), (1, 2), (1, 3), (4, 5)}


def precedence(expression: ex.Expression) -> int:
    """How tightly the expression's outermost operator binds; ATOM where it has none."""
    return PRECEDENCE.get(type(expression), ATOM)


class ExpressionPrinter:
    """Prints an expression with the parentheses that its tree needs.

    A target sets `symbols` (operator class to text) and overrides what it writes differently. An expression class
    without a method raises TypeError: a target's preconditions must have refused it before.
    """

    symbols: ClassVar[Mapping[type[ex.Expression], str]]

    def __call__(self, expression: ex.Expression) -> str:
        """The text of the expression, without parentheses around it."""
        with deep_recursion():
            return self.text(expression)

    def text(self, expression: ex.Expression) -> str:
        """The same, for who is printing already."""
        if isinstance(expression, ex.BinaryExpression):
            return self.binary(expression)
        if isinstance(expression, (ex.Negation, ex.UnaryMinus)):
            return self.unary(expression)
        return self.atom(expression)

    def binary(self, expression: ex.BinaryExpression) -> str:
        """A binary operator between its operands."""
        left = self.operand(expression, expression.left, chain=True)
        right = self.operand(expression, expression.right, chain=isinstance(expression, ex.Implication))
        return f"{left} {self.symbols[type(expression)]} {right}"

    def unary(self, expression: ex.UnaryExpression) -> str:
        """An operator before its operand; two in a row are kept apart, so that `--x` is never printed."""
        text = self.text(expression.operand)
        bare = self.precedence(expression.operand) == ATOM
        return f"{self.symbols[type(expression)]}{text if bare else f'({text})'}"

    def operand(self, parent: ex.BinaryExpression, child: ex.Expression, *, chain: bool) -> str:
        """A child of a binary operator, in parentheses where the tree or a reader needs them."""
        outer, inner = self.precedence(parent), self.precedence(child)
        same = (
            outer == inner
            and chain
            and (type(parent) is type(child))
            and isinstance(parent, (*_CHAINS, ex.Implication))
        )
        if same and isinstance(parent, ex.Implication):
            same = child is parent.right
        bare = (inner > outer and (outer, inner) not in _LOOSE_PAIRS) or same
        return self.text(child) if bare else f"({self.text(child)})"

    def precedence(self, expression: ex.Expression) -> int:
        """How tightly the text of the expression binds; a target that writes an atom with an operator says so here."""
        return precedence(expression)

    def atom(self, expression: ex.Expression) -> str:
        """Everything that is not an operator: literals, references, conversions."""
        raise TypeError(f"{type(self).__name__} has no text for {type(expression).__name__}")


class RoboscPrinter(ExpressionPrinter):
    """Prints a linked expression of a robot model as its author would write it, states and variables qualified."""

    symbols: ClassVar[Mapping[type[ex.Expression], str]] = {
        ex.Implication: "=>",
        ex.Disjunction: "or",
        ex.Conjunction: "and",
        ex.Equation: "=",
        ex.Inequation: "!=",
        ex.LessThan: "<",
        ex.LessOrEqual: "<=",
        ex.GreaterThan: ">",
        ex.GreaterOrEqual: ">=",
        ex.Addition: "+",
        ex.Subtraction: "-",
        ex.Multiplication: "*",
        ex.Division: "/",
        ex.Negation: "!",
        ex.UnaryMinus: "-",
    }

    def atom(self, expression: ex.Expression) -> str:
        """A name with the steps into its data, or a literal."""
        match expression:
            case robosc.Access():
                name = "value" if expression.item is None else written(expression.item.name)
                owner = f"{written(expression.component.name)}." if expression.component else ""
                return owner + name + "".join(map(_step, expression.segments))
            case ex.BooleanLiteral():
                return "true" if expression.value else "false"
            case ex.IntegerLiteral():
                return str(expression.value)
            case ex.DoubleLiteral():
                digits = format(Decimal(repr(expression.value)), "f")  # RoboSC has no exponents
                return digits if "." in digits else f"{digits}.0"
            case ex.StringLiteral():
                return visible(json.dumps(expression.value, ensure_ascii=False))
        return super().atom(expression)


def _step(segment: robosc.AccessSegment) -> str:
    if isinstance(segment, robosc.PropertySegment):
        return f".{written(segment.property.name)}"
    assert isinstance(segment, robosc.IndexSegment)
    return f"[{segment.index}]"


class SctPrinter(ExpressionPrinter):
    """Prints an expression of an sct model for a person, in RoboSC's operators, each name with its plant before it."""

    symbols = RoboscPrinter.symbols

    def atom(self, expression: ex.Expression) -> str:
        """A reference as `plant.name`, a literal, a choice as `(if a then b else c)`."""
        match expression:
            case sct.LocationReference():
                return _with_plant(expression.location)
            case sct.VariableReference():
                return _with_plant(expression.variable)
            case sct.InputReference():
                return _with_plant(expression.input)
            case ex.EnumerationLiteralReference():
                return expression.literal.name
            case ex.IntegerLiteral():
                return str(expression.value)
            case ex.BooleanLiteral():
                return "true" if expression.value else "false"
            case ex.Conditional():
                parts = (expression.condition, expression.then, expression.otherwise)
                condition, then, otherwise = [self.text(part) for part in parts]
                return f"(if {condition} then {then} else {otherwise})"
        return super().atom(expression)


class RobotPrinter(SctPrinter):
    """Prints an expression of an sct model as the robot model does: states and variables with their component."""

    def atom(self, expression: ex.Expression) -> str:
        """A reference as `Component.name`; all else as in every sct model."""
        match expression:
            case sct.LocationReference():
                return _with_origin(expression.location)
            case sct.VariableReference():
                return _with_origin(expression.variable)
        return super().atom(expression)


def _with_origin(element: sct.Location | sct.DiscreteVariable) -> str:
    plant: sct.Plant = element.eContainer()
    return f"{plant.origin or plant.name}.{element.name}"


def _with_plant(element: Any) -> str:
    return f"{element.eContainer().name}.{element.name}"


def copied(expression: _Kind) -> _Kind:
    """A tree of its own that means the same: whoever contains the expression keeps it."""
    made = type(expression)()
    for name, feature in features(expression.eClass).items():
        value = getattr(expression, name)
        if value is not None:
            setattr(made, name, value if is_attribute(feature) or not feature.containment else copied(value))
    return made


def conjunction(parts: Iterable[ex.Expression]) -> ex.Expression | None:
    """The conjunction of all parts, in their order; None of none. The parts become its children."""
    return _chain(ex.Conjunction, parts)


def disjunction(parts: Iterable[ex.Expression]) -> ex.Expression | None:
    """The disjunction of all parts, in their order; None of none. The parts become its children."""
    return _chain(ex.Disjunction, parts)


def _chain(operator: type[ex.BinaryExpression], parts: Iterable[ex.Expression]) -> ex.Expression | None:
    each = iter(parts)
    first = next(each, None)
    return None if first is None else reduce(lambda left, right: operator(left=left, right=right), each, first)
