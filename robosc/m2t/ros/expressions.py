"""Expressions of the node as C++17."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from robosc.m2t.c.comments import string_literal
from robosc.m2t.c.types import number
from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct
from robosc.metamodel.expression_types import is_double
from robosc.metamodel.reflection import tree
from robosc.semantics.printing import ATOM, PRECEDENCE, ExpressionPrinter

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.m2t.ros.names import CppNames

_ARITHMETIC = (ex.Addition, ex.Subtraction, ex.Multiplication)
_CONVERSIONS: dict[type[ex.Type | None], str] = {
    ex.BooleanType: "bool",
    ex.IntegerType: "Integer",
    ex.DoubleType: "double",
}


class CppPrinter(ExpressionPrinter):
    """Prints what the node evaluates: doubles as `double`, whole numbers as the node's saturating `Integer`.

    `data` is the variable that holds the data which came in, `node` the one with the node's variables. Elements of
    arrays are read through an `ArrayReader`, the variable `reader`, in the order of the text and as far as `and`, `or`
    and `=>` need them.
    """

    symbols: ClassVar[Mapping[type[ex.Expression], str]] = {
        ex.Disjunction: "||",
        ex.Conjunction: "&&",
        ex.Equation: "==",
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

    def __init__(self, names: CppNames, data: str = "message", node: str = "data_", reader: str = "read") -> None:
        self._names = names
        self._data = data
        self._node = node
        self._reader = reader

    def precedence(self, expression: ex.Expression) -> int:
        """A state is a comparison in C++; an implication and a choice are printed in parentheses."""
        match expression:
            case sct.LocationReference() if " " in self._names.is_in(expression.location):
                return PRECEDENCE[ex.Equation]
            case ex.Implication():
                return ATOM
            case ex.Inequation() if is_double(expression.left):
                return ATOM
        return super().precedence(expression)

    def binary(self, expression: ex.BinaryExpression) -> str:
        """A comparison with NaN is false, `!=` too; no whole number overflows in the compiler's own `int`."""
        if isinstance(expression, ex.Implication):
            return f"(!{self.tight(expression.left)} || {self.tight(expression.right)})"
        if isinstance(expression, ex.Inequation) and is_double(expression.left):
            return f"differ({self.text(expression.left)}, {self.text(expression.right)})"
        if isinstance(expression, _ARITHMETIC) and not is_double(expression) and is_constant(expression):
            return (
                f"Integer({self.text(expression.left)}) {self.symbols[type(expression)]} {self.tight(expression.right)}"
            )
        return super().binary(expression)

    def unary(self, expression: ex.UnaryExpression) -> str:
        """An operator before its operand; C++ has no literal of the least integer."""
        if isinstance(expression, ex.UnaryMinus) and isinstance(expression.operand, ex.IntegerLiteral):
            return number(-expression.operand.value)
        return super().unary(expression)

    def atom(self, expression: ex.Expression) -> str:
        """Literals, references to the state, the node's variables and the data that came in, conversions."""
        match expression:
            case ex.BooleanLiteral():
                return "true" if expression.value else "false"
            case ex.IntegerLiteral():
                return str(expression.value)
            case ex.DoubleLiteral():
                return repr(expression.value)
            case ex.StringLiteral():
                return f"std::string({string_literal(expression.value)})"
            case ex.DoubleConversion():
                return f"static_cast<double>({self.text(expression.operand)})"
            case ex.Conditional():
                parts = (expression.condition, expression.then, expression.otherwise)
                return "({} ? {} : {})".format(*[self.tight(part) for part in parts])
        return self._reference(expression)

    def _reference(self, expression: ex.Expression) -> str:
        match expression:
            case ex.EnumerationLiteralReference():
                return self._names.literal(expression.literal)
            case sct.LocationReference():
                return self._names.is_in(expression.location)
            case sct.VariableReference():
                value = self._names.state(expression.variable)
                return f"Integer({value})" if isinstance(expression.variable.type, ex.IntegerType) else value
            case rosgraph.NodeVariableReference():
                return f"{self._node}.{self._names.variable(expression.variable)}"
            case rosgraph.WireAccess():
                conversion = _CONVERSIONS.get(type(expression.type))
                return f"{conversion}({self.wire(expression)})" if conversion else self.wire(expression)
            case rosgraph.ConversionCall():
                return f"{self._names.conversion(expression.conversion)}({self.wire(expression.argument)})"
        return super().atom(expression)

    def wire(self, access: rosgraph.WireAccess) -> str:
        """The place in the ROS data, not converted to a type of the model."""
        text = self._data
        for step in access.steps:
            if isinstance(step, rosgraph.FieldStep):
                text += f".{step.name}"
            else:
                assert isinstance(step, rosgraph.IndexStep)
                text = f"{self._reader}.at({text}, {step.index})"
        return text

    def integer(self, expression: ex.Expression, kind: ex.IntegerType) -> str:
        """A whole number as an `Integer`, within the bounds of its type."""
        bounds = ""
        if kind.minimum is not None and kind.maximum is not None:
            bounds = f".within({number(kind.minimum)}, {number(kind.maximum)})"
        if is_constant(expression):
            return f"Integer({self.text(expression)}){bounds}"
        return f"{self.tight(expression)}{bounds}" if bounds else self.text(expression)

    def tight(self, expression: ex.Expression) -> str:
        """The text, in parentheses where it is not a single operand."""
        text = self.text(expression)
        return text if self.precedence(expression) == ATOM else f"({text})"


def parts(expression: ex.Expression) -> Iterator[ex.Expression]:
    """The expression and everything in it, from the outside inwards and from left to right."""
    return (part for _, part in tree(expression) if isinstance(part, ex.Expression))


def is_constant(expression: ex.Expression) -> bool:
    """Whether the expression is made of integer literals only."""
    operators = (ex.BinaryExpression, ex.UnaryExpression, ex.IntegerLiteral)
    return all(isinstance(part, operators) for part in parts(expression))
