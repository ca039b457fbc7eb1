"""Expressions of the node as C++17."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.c.comments import string_literal
from robosc.m2t.c.expressions import number
from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct
from robosc.semantics.operators import ARITHMETIC, PRECEDENCE, SYMBOLS
from robosc.semantics.printing import Printed, Printer
from robosc.semantics.typing import DOUBLE, Types
from robosc.semantics.walks import fold

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2t.ros.names import CppNames

_CONVERSIONS: dict[type[ex.Type | None], str] = {
    ex.BooleanType: "bool",
    ex.IntegerType: "Integer",
    ex.DoubleType: "double",
}


class CppPrinter(Printer):
    """Prints what the node evaluates: doubles as `double`, whole numbers as the node's saturating `Integer`.

    `data` is the variable that holds the data which came in, `node` the one with the node's variables. Elements of
    arrays are read through an `ArrayReader`, the variable `reader`, in the order of the text and as far as `and`, `or`
    and `=>` need them.
    """

    symbols = {  # noqa: RUF012  # ClassVar in the parent
        **SYMBOLS,
        ex.Disjunction: "||",
        ex.Conjunction: "&&",
        ex.Equation: "==",
    }

    def __init__(self, names: CppNames, data: str = "message", node: str = "data_", reader: str = "read") -> None:
        self._names = names
        self._data = data
        self._node = node
        self._reader = reader
        self._constants: dict[ex.Expression, bool] = {}
        self._types = Types()

    def write(self, expression: ex.Expression, given: Sequence[Printed]) -> Printed:
        """A state is a comparison in C++, a conversion a call."""
        if isinstance(expression, sct.LocationReference):
            text = self._names.is_in(expression.location)
            return Printed(text, PRECEDENCE[ex.Equation]) if " " in text else Printed(text)
        if isinstance(expression, ex.DoubleConversion):
            return Printed(f"static_cast<double>({given[0].text})")
        return super().write(expression, given)

    def binary(self, expression: ex.BinaryExpression, left: Printed, right: Printed) -> Printed:
        """A comparison with NaN is false, `!=` too; no whole number overflows in the compiler's own `int`."""
        if isinstance(expression, ex.Implication):
            return Printed(f"(!{left.tight} || {right.tight})")
        if isinstance(expression, ex.Inequation) and self._double(expression.left):
            return Printed(f"differ({left.text}, {right.text})")
        if isinstance(expression, ARITHMETIC) and self._constant(expression) and not self._double(expression):
            text = f"Integer({left.text}) {self.symbols[type(expression)]} {right.tight}"
            return Printed(text, PRECEDENCE[type(expression)])
        return super().binary(expression, left, right)

    def unary(self, expression: ex.UnaryExpression, operand: Printed) -> Printed:
        """An operator before its operand; C++ has no literal of the least integer."""
        if isinstance(expression, ex.UnaryMinus) and isinstance(expression.operand, ex.IntegerLiteral):
            return Printed(number(-expression.operand.value), PRECEDENCE[ex.UnaryMinus])
        return super().unary(expression, operand)

    def call(self, expression: ex.FunctionCall, given: Sequence[Printed]) -> Printed:
        """A function of the header `data.hpp`, of whole numbers of the node."""
        arguments = [
            f"Integer({text})" if self._constant(argument) else text
            for argument, (text, _) in zip(expression.arguments, given, strict=True)
        ]
        return Printed(f"{expression.function}({', '.join(arguments)})")

    def choice(self, condition: Printed, then: Printed, otherwise: Printed) -> Printed:
        """The conditional operator, in parentheses."""
        return Printed(f"({condition.tight} ? {then.tight} : {otherwise.tight})")

    def atom(self, expression: ex.Expression) -> str:
        """Literals, references to the state, the node's variables and the data that came in, conversions."""
        match expression:
            case ex.DoubleLiteral():
                return repr(expression.value)
            case ex.StringLiteral():
                return f"std::string({string_literal(expression.value)})"
        return self._reference(expression)

    def _reference(self, expression: ex.Expression) -> str:
        match expression:
            case ex.EnumerationLiteralReference():
                return self._names.literal(expression.literal)
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
        given = self.printed(expression)
        if self._constant(expression):
            return f"Integer({given.text}){bounds}"
        return f"{given.tight}{bounds}" if bounds else given.text

    def tight(self, expression: ex.Expression) -> str:
        """The text, in parentheses where it is not a single operand."""
        return self.printed(expression).tight

    def _constant(self, expression: ex.Expression) -> bool:
        return fold(_is_constant, expression, memo=self._constants)

    def _double(self, expression: ex.Expression) -> bool:
        return self._types(expression) == DOUBLE


def _is_constant(expression: ex.Expression, given: list[bool]) -> bool:
    """Whether the expression is made of integer literals only."""
    return isinstance(expression, ex.IntegerLiteral) or (
        isinstance(expression, (ex.BinaryExpression, ex.UnaryExpression)) and all(given)
    )
