"""Prints expressions of the node as C++17."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.c.comments import string_literal
from robosc.m2t.c.expressions import number
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.semantics.messages import reads_parameters
from robosc.model.semantics.operators import ARITHMETIC, PRECEDENCE, SYMBOLS, TypeRule, operator_of
from robosc.model.semantics.printing import Printed, Printer
from robosc.model.semantics.typing import DOUBLE, Types
from robosc.model.semantics.walks import fold, operands

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.m2t.ros.names import CppNames

_CONVERSIONS: dict[type[ex.Type | None], str] = {
    ex.BooleanType: "bool",
    ex.IntegerType: "Integer",
    ex.DoubleType: "double",
}


def convert(place: str, kind: ex.Type | None) -> str:
    """Return a place in ROS data as a value of a type of the model."""
    conversion = _CONVERSIONS.get(type(kind))
    return f"{conversion}({place})" if conversion else place


#: Functions whose C++ name differs. None has the name of a C function with other number types.
_FUNCTIONS = {
    "abs": "magnitude",
    "min": "smaller",
    "max": "larger",
    "sqrt": "std::sqrt",
    "sin": "std::sin",
    "cos": "std::cos",
    "atan2": "std::atan2",
    "hypot": "std::hypot",
    "size": "size_of",
}
_OF_ARRAYS = {"min": "least", "max": "greatest"}
_QUANTIFIERS = {"all": "for_all", "any": "for_any", "count": "number_of"}


class CppPrinter(Printer):
    """Prints expressions for the node: doubles as `double`, integers as the node's saturating `Integer`.

    `data` is the variable with the incoming data, `node` the one with the node's variables, `reason` the one with the
    reason of an error. Array elements are read through an `ArrayReader`, the variable `reader`, in the order of the
    text and only as far as `and`, `or` and `=>` need them.
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

    def inside(self, expression: ex.Expression) -> Sequence[ex.Expression]:
        """Return the operands to print first.

        The argument of a conversion is a place in the data: its indices are printed.
        """
        if isinstance(expression, rosgraph.IfReadable):
            return [expression.otherwise]  # the value has a reader of its own
        return operands(expression.argument if isinstance(expression, rosgraph.ConversionCall) else expression)

    def write(self, expression: ex.Expression, printed: Sequence[Printed]) -> Printed:
        """Print an expression. A state becomes a comparison, a conversion becomes a call."""
        if isinstance(expression, sct.LocationReference):
            return self._names.location(expression.location)
        texts = [text for text, _ in printed]
        match expression:
            case rosgraph.WireAccess():
                return Printed(convert(self.wire(expression, texts), expression.type))
            case rosgraph.ConversionCall():
                argument = self.wire(expression.argument, texts)
                node_argument = f", {self._node}" if reads_parameters(expression.conversion) else ""
                return Printed(f"{self._names.conversion(expression.conversion)}({argument}{node_argument})")
            case rosgraph.IfReadable():
                value = CppPrinter(self._names, self._data, self._node, reader="element")(expression.value)
                return Printed(f"read_or({texts[0]}, [&](ArrayReader& element) {{ return {value}; }})")
            case rosgraph.ArrayQuantifier():
                array, body = texts
                element = f"[[maybe_unused]] const auto& {_element(expression)}"
                return Printed(
                    f"{_QUANTIFIERS[str(expression.quantifier)]}({array}, [&]({element}) {{ return {body}; }})"
                )
        if isinstance(expression, ex.DoubleConversion):
            return Printed(f"static_cast<double>({printed[0].text})")
        if isinstance(expression, ex.Conditional):
            condition, then, otherwise = printed
            then, otherwise = Printed(then.tight), Printed(otherwise.tight)
            then_text, other = self._whole(expression.then, then), self._whole(expression.otherwise, otherwise)
            return Printed(f"({condition.tight} ? {then_text} : {other})")
        return super().write(expression, printed)

    def binary(self, expression: ex.BinaryExpression, left: Printed, right: Printed) -> Printed:
        """Print a binary operator.

        A comparison with NaN is false, also `!=`. Integers never overflow in C++'s `int`.
        """
        if isinstance(expression, ex.Implication):
            return Printed(f"(!{left.tight} || {right.tight})")
        if isinstance(expression, ex.Inequation) and self._double(expression.left):
            return Printed(f"differ({left.text}, {right.text})")
        if isinstance(expression, ARITHMETIC) and self._constant(expression) and not self._double(expression):
            text = f"Integer({left.text}) {self.symbols[type(expression)]} {right.tight}"
            return Printed(text, PRECEDENCE[type(expression)])
        return super().binary(expression, left, right)

    def unary(self, expression: ex.UnaryExpression, operand: Printed) -> Printed:
        """Print an operator before its operand. C++ has no literal of the lowest integer."""
        if isinstance(expression, ex.UnaryMinus) and isinstance(expression.operand, ex.IntegerLiteral):
            return Printed(number(-expression.operand.value), PRECEDENCE[ex.UnaryMinus])
        return super().unary(expression, operand)

    def call(self, expression: ex.FunctionCall, printed: Sequence[Printed]) -> Printed:
        """Print a call of a function in the header `data.hpp`. Partial functions are methods of the reader."""
        row = operator_of(expression)
        assert row is not None
        arguments = map(self._whole, expression.arguments, printed)
        name = _FUNCTIONS.get(row.symbol, row.symbol)
        if row.rule is TypeRule.ELEMENTS:
            number = "double" if self._double(expression) else "Integer"
            name = f"{_OF_ARRAYS[row.symbol]}<{number}>"
        owner = f"{self._reader}." if row.is_partial else ""
        return Printed(f"{owner}{name}({', '.join(arguments)})")

    def _whole(self, expression: ex.Expression, printed: Printed) -> str:
        return f"Integer({printed.text})" if self._constant(expression) else printed.text

    def atom(self, expression: ex.Expression) -> str:
        """Return a literal, or a reference to the state, the node's variables or the incoming data."""
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
            case rosgraph.ErrorReason():
                return "reason_of(reason)"
            case rosgraph.NodeVariableReference():
                name = f"{self._node}.{self._names.variable(expression.variable)}"
                return f"static_cast<double>(static_cast<float>({name}))" if expression.single else name
        return super().atom(expression)

    def wire(self, access: rosgraph.WireAccess, indices: Sequence[str] = ()) -> str:
        """Return the place in the ROS data, not converted to a type of the model."""
        text = _element(access.quantifier) if access.quantifier else self._data
        if access.variable is not None:
            text = f"{self._node}.{self._names.variable(access.variable)}"
        rest = iter(indices)
        for step in access.steps:
            match step:
                case rosgraph.FieldStep():
                    text += f".{step.name}"
                case rosgraph.IndexStep():
                    index = step.index if step.position is None else next(rest)
                    text = f"{self._reader}.at({text}, {index})"
                case rosgraph.SliceStep():
                    text = f"{self._reader}.slice({text}, {next(rest)}, {next(rest)})"
        return text

    def integer(self, expression: ex.Expression, kind: ex.IntegerType) -> str:
        """Return an integer as an `Integer`, within the bounds of its type."""
        bounds = ""
        if kind.minimum is not None and kind.maximum is not None:
            bounds = f".within({number(kind.minimum)}, {number(kind.maximum)})"
        value = self.printed(expression)
        if self._constant(expression):
            return f"Integer({value.text}){bounds}"
        return f"{value.tight}{bounds}" if bounds else value.text

    def tight(self, expression: ex.Expression) -> str:
        """Return the text, in parentheses if it is not a single operand."""
        return self.printed(expression).tight

    def _constant(self, expression: ex.Expression) -> bool:
        return fold(_is_constant, expression, memo=self._constants)

    def _double(self, expression: ex.Expression) -> bool:
        return self._types(expression) == DOUBLE


def _element(quantifier: rosgraph.ArrayQuantifier) -> str:
    return f"element_{quantifier.name}"


def _is_constant(expression: ex.Expression, operands_constant: list[bool]) -> bool:
    """Return whether the expression consists of integer literals only."""
    return isinstance(expression, ex.IntegerLiteral) or (
        isinstance(expression, (ex.BinaryExpression, ex.UnaryExpression)) and all(operands_constant)
    )
