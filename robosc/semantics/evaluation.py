"""The value of an expression, computed as every generated program computes it."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from robosc.metamodel import expression as ex
from robosc.semantics.operators import Rule, Value, as_double, divide, operator_of
from robosc.semantics.walks import operands

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Program", "Value", "as_double", "divide", "evaluate", "literal", "saturate"]

_Result = TypeVar("_Result")
_LITERALS = (ex.BooleanLiteral, ex.IntegerLiteral, ex.DoubleLiteral, ex.StringLiteral)


def evaluate(
    expression: ex.Expression, read: Callable[[ex.Expression], Value], fit: Callable[[int], int] | None = None
) -> Value:
    """The value of a well-typed expression; `read` gives the value of every reference in it.

    Doubles follow IEEE 754, division by zero included; every comparison with NaN is false. `and`, `or` and `=>` go no
    further to the right than needed. `fit` says what becomes of a computed integer; by default it stays, however large.
    """
    return Program[Value](expression, lambda reference: partial(read, reference), fit)()


class Program(Generic[_Result]):
    """An expression as instructions for a stack of values, made once and run many times; nothing in it recurses.

    Calling it gives the value; the arguments of the call go to all that reads.
    """

    def __init__(
        self,
        expression: ex.Expression,
        reader: Callable[[ex.Expression], Callable[..., Any]],
        fit: Callable[[int], int] | None = None,
    ) -> None:
        """`reader` gives for each reference the function that reads it; `fit` is as for `evaluate`."""
        self._reader = reader
        self._fit = fit
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
        """Runs the instructions."""
        stack: list[Any] = []
        code, position = self._code, 0
        while position < len(code):
            kind, argument = code[position]
            position += 1
            if kind == _READ:
                stack.append(argument(*source))
            elif kind == _BINARY:
                right = stack.pop()
                stack[-1] = argument(stack[-1], right)
            elif kind == _UNARY:
                stack[-1] = argument(stack[-1])
            elif kind == _CONSTANT:
                stack.append(argument)
            elif kind == _CALL:
                count, function = argument
                stack[len(stack) - count :] = [function(*stack[len(stack) - count :])]
            elif kind == _DECIDE:
                decided, value, end = argument
                if bool(stack[-1]) is decided:
                    stack[-1], position = value, end.position
                else:
                    stack.pop()
            elif kind == _JUMP or not stack.pop():
                position = argument.position
        return stack[0]  # type: ignore[no-any-return]

    def _steps(self, expression: ex.Expression) -> list[Any]:
        """The instructions for an expression, with its operands and labels among them."""
        if isinstance(expression, _LITERALS):
            return [(_CONSTANT, expression.value)]
        end = _Label()
        if isinstance(expression, ex.Conditional):
            other = _Label()
            chosen = [expression.condition, (_UNLESS, other), expression.then, (_JUMP, end)]
            return [*chosen, other, expression.otherwise, end]
        row = operator_of(expression)
        if row is None:
            return [(_READ, self._reader(expression))]
        given = operands(expression)
        if row.decided is not None:
            decide = (_DECIDE, (row.decided, row.compute(row.decided, False), end))
            return [given[0], decide, given[1], (_UNARY, bool), end]
        compute = row.compute
        if self._fit is not None and row.rule is Rule.ARITHMETIC:
            compute = partial(_fitted, self._fit, compute)
        if isinstance(expression, ex.FunctionCall):
            return [*given, (_CALL, (len(given), compute))]
        return [*given, (_UNARY if len(given) == 1 else _BINARY, compute)]


class _Label:
    """A place in a program to which an instruction jumps."""

    position = 0


#: The instructions: what each does with its argument and the values on the stack.
_READ, _CONSTANT, _UNARY, _BINARY, _DECIDE, _UNLESS, _JUMP, _CALL = range(8)


def _fitted(fit: Callable[[int], int], compute: Callable[..., Any], *values: Any) -> Any:
    result = compute(*values)
    return fit(result) if isinstance(result, int) else result


def saturate(value: int, minimum: int | None, maximum: int | None) -> int:
    """The value, or the nearest bound where it is outside the range; an absent bound does not bound."""
    if minimum is not None:
        value = max(value, minimum)
    return value if maximum is None else min(value, maximum)


def literal(value: Value) -> ex.Expression:
    """The expression that stands for a value, with a minus sign where it is negative.

    What no literal stands for is a division by zero, as it was in the text.
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
