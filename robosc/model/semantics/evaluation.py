"""Evaluation of expressions, with the same results as every generated program."""

from __future__ import annotations

import math
import struct
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.model.semantics.operators import TypeRule, UnreadableError, Value, as_double, divide, operator_of
from robosc.model.semantics.walks import operands

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

__all__ = ["Program", "Value", "as_double", "divide", "evaluate", "literal", "saturate", "single_precision"]

_Result = TypeVar("_Result")
_LITERALS = (ex.BooleanLiteral, ex.IntegerLiteral, ex.DoubleLiteral, ex.StringLiteral)


def evaluate(
    expression: ex.Expression, value_of: Callable[[ex.Expression], Value], fit: Callable[[int], int] | None = None
) -> Value:
    """Return the value of a well-typed expression; `read` returns the value of each reference in it.

    Doubles follow IEEE 754, division by zero included; every comparison with NaN is false. `and`, `or` and `=>` skip
    the right operand if the left one decides. `fit` maps each computed integer; by default integers are unbounded.
    """
    return Program[Value](expression, lambda reference: partial(value_of, reference), fit)()


class Program(Generic[_Result]):
    """An expression compiled to instructions of a stack machine: compiled once, run many times, without recursion.

    A call of the program returns the value. The arguments of the call are passed to all readers. The body of a
    quantifier is a program of its own, whose first arguments are the elements that quantifiers around it have reached.
    """

    def __init__(
        self,
        expression: ex.Expression,
        reader: Callable[[ex.Expression], Callable[..., Any]],
        fit: Callable[[int], int] | None = None,
        around: Sequence[rosgraph.ArrayQuantifier] = (),
    ) -> None:
        """Compile an expression.

        `reader` returns the function that reads a reference; `fit` is as for `evaluate`. `around`: the quantifiers
        around the expression, the innermost first.
        """
        self._reader = reader
        self._fit = fit
        self._around = around
        self._code: list[tuple[int, Any]] = []
        pending: list[Any] = [expression]
        while pending:
            step = pending.pop()
            if isinstance(step, _Label):
                step.position = len(self._code)
            elif isinstance(step, tuple):
                self._code.append(step)
            else:
                pending += reversed(self._steps(step))

    def __call__(self, *source: Any) -> _Result:
        """Run the instructions."""
        stack: list[Any] = []
        code, position = self._code, 0
        while position < len(code):
            kind, argument = code[position]
            position += 1
            if kind == _READ_VALUE:
                stack.append(argument(*source))
            elif kind == _BINARY:
                right = stack.pop()
                stack[-1] = argument(stack[-1], right)
            elif kind == _UNARY:
                stack[-1] = argument(stack[-1])
            elif kind == _CONSTANT:
                stack.append(argument)
            elif kind == _DECIDE:
                decided, value, end = argument
                if bool(stack[-1]) is decided:
                    stack[-1], position = value, end.position
                else:
                    stack.pop()
            elif kind >= _CALL:
                count, function = argument
                behind = source if kind == _REACH else ()
                stack[len(stack) - count :] = [function(*stack[len(stack) - count :], *behind)]
            elif kind == _JUMP or not stack.pop():
                position = argument.position
        return stack[0]  # type: ignore[no-any-return]

    def _steps(self, expression: ex.Expression) -> list[Any]:
        """Return the instructions for an expression, with its operands and labels among them."""
        if isinstance(expression, _LITERALS):
            return [(_CONSTANT, expression.value)]
        end = _Label()
        if isinstance(expression, ex.Conditional):
            other = _Label()
            chosen = [expression.condition, (_UNLESS, other), expression.then, (_JUMP, end)]
            return [*chosen, other, expression.otherwise, end]
        if isinstance(expression, rosgraph.ArrayQuantifier):
            body = Program[Any](expression.body, self._reader, self._fit, [expression, *self._around])
            return [expression.array, (_REACH, (1, partial(_QUANTIFIERS[str(expression.quantifier)], body)))]
        if isinstance(expression, rosgraph.IfReadable):
            both = (Program[Any](part, self._reader, self._fit, self._around) for part in operands(expression))
            return [(_READ_VALUE, partial(_if_readable, *both))]
        row = operator_of(expression)
        if row is None:
            return self._read(expression)
        parts = operands(expression)
        if row.decided is not None:
            decide = (_DECIDE, (row.decided, row.compute(row.decided, False), end))
            return [parts[0], decide, parts[1], (_UNARY, bool), end]
        compute = row.compute
        if self._fit is not None and row.rule is TypeRule.ARITHMETIC:
            compute = partial(_fitted, self._fit, compute)
        if isinstance(expression, ex.FunctionCall):
            return [*parts, (_CALL, (len(parts), compute))]
        return [*parts, (_UNARY if len(parts) == 1 else _BINARY, compute)]

    def _read(self, reference: ex.Expression) -> list[Any]:
        """Return the instructions for a reference.

        The element of an array that it reads, if any, and its indices are computed first.
        """
        access = reference.argument if isinstance(reference, rosgraph.ConversionCall) else reference
        reader, skipped = self._reader(reference), len(self._around)
        parts: list[Any] = []
        if isinstance(access, rosgraph.WireAccess | rosgraph.ArrayLiteral):
            parts += operands(access)
        if isinstance(access, rosgraph.WireAccess) and access.quantifier is not None:
            reached = self._around.index(access.quantifier)
            if not parts:
                return [(_READ_VALUE, lambda *source: reader(source[reached], *source[skipped:]))]
            parts.insert(0, (_READ_VALUE, lambda *source: source[reached]))
        count = len(parts)
        if skipped == 0:
            return [*parts, (_REACH, (count, reader))] if parts else [(_READ_VALUE, reader)]
        if not parts:
            return [(_READ_VALUE, lambda *source: reader(*source[skipped:]))]
        return [*parts, (_REACH, (count, lambda *context: reader(*context[:count], *context[count + skipped :])))]


def _all(body: Program[Any], array: Any, *source: Any) -> bool:
    return all(body(element, *source) for element in array)


def _any(body: Program[Any], array: Any, *source: Any) -> bool:
    return any(body(element, *source) for element in array)


def _count(body: Program[Any], array: Any, *source: Any) -> int:
    return sum(bool(body(element, *source)) for element in array)


_QUANTIFIERS: dict[str, Callable[..., bool | int]] = {"all": _all, "any": _any, "count": _count}


class _Label:
    """Target of a jump in a program."""

    position = 0


#: Kinds of instructions. Each uses its argument and the values on the stack.
_READ_VALUE, _CONSTANT, _UNARY, _BINARY, _DECIDE, _UNLESS, _JUMP, _CALL, _REACH = range(9)


def _if_readable(value: Program[Any], otherwise: Program[Any], *source: Any) -> Any:
    try:
        return value(*source)
    except UnreadableError:
        return otherwise(*source)


def _fitted(fit: Callable[[int], int], compute: Callable[..., Any], *values: Any) -> Any:
    result = compute(*values)
    return fit(result) if isinstance(result, int) else result


def saturate(value: int, minimum: int | None, maximum: int | None) -> int:
    """Return the value, or the nearest bound if it is outside the range. A bound of None does not limit it."""
    if minimum is not None:
        value = max(value, minimum)
    return value if maximum is None else min(value, maximum)


def single_precision(value: float) -> float:
    """Return the value rounded to a float of 32 bits. A value beyond each of these stays."""
    try:
        (rounded,) = struct.unpack("f", struct.pack("f", value))
    except OverflowError:
        return value
    return float(rounded)


def literal(value: Value) -> ex.Expression:
    """Return the expression of a value. A negative number gets a minus sign.

    A double without a literal (infinity, NaN) becomes a division by zero, as in the text.
    """
    if isinstance(value, bool):
        return ex.BooleanLiteral(value=value)
    if isinstance(value, float) and not math.isfinite(value):
        dividend = 0.0 if math.isnan(value) else math.copysign(1.0, value)
        return ex.Division(left=literal(dividend), right=ex.DoubleLiteral(value=0.0))
    if isinstance(value, (int, float)):
        kind = ex.IntegerLiteral if isinstance(value, int) else ex.DoubleLiteral
        magnitude: ex.Expression = kind(value=abs(value))  # type: ignore[arg-type]
        return ex.UnaryMinus(operand=magnitude) if value < 0 else magnitude
    if isinstance(value, str):
        return ex.StringLiteral(value=value)
    assert isinstance(value, ex.EnumerationLiteral)
    return ex.EnumerationLiteralReference(literal=value)
