"""The value of an expression, computed as every generated program computes it."""

from __future__ import annotations

import math
import operator
from typing import TYPE_CHECKING, TypeAlias

from robosc.metamodel import expression as ex

if TYPE_CHECKING:
    from collections.abc import Callable

#: An enumeration's value stands for itself (its literal object).
Value: TypeAlias = bool | int | float | str | object

_ORDERED: dict[type[ex.Expression], Callable[..., bool]] = {
    ex.LessThan: operator.lt,
    ex.LessOrEqual: operator.le,
    ex.GreaterThan: operator.gt,
    ex.GreaterOrEqual: operator.ge,
}
_ARITHMETIC: dict[type[ex.Expression], Callable[..., int | float]] = {
    ex.Addition: operator.add,
    ex.Subtraction: operator.sub,
    ex.Multiplication: operator.mul,
}


def evaluate(
    expression: ex.Expression, read: Callable[[ex.Expression], Value], fit: Callable[[int], int] = int
) -> Value:
    """The value of a well-typed expression; `read` gives the value of every reference in it.

    Doubles follow IEEE 754, division by zero included; every comparison with NaN is false. `fit` says what becomes of
    a computed integer; by default it stays, however large.
    """
    match expression:
        case ex.BooleanLiteral() | ex.IntegerLiteral() | ex.DoubleLiteral() | ex.StringLiteral():
            return expression.value
        case ex.Negation():
            return not evaluate(expression.operand, read, fit)
        case ex.UnaryMinus():
            negative = -_number(expression.operand, read, fit)
            return fit(negative) if isinstance(negative, int) else negative
        case ex.DoubleConversion():
            return as_double(_number(expression.operand, read, fit))
        case ex.Conditional():
            chosen = expression.then if evaluate(expression.condition, read, fit) else expression.otherwise
            return evaluate(chosen, read, fit)
        case ex.BinaryExpression():
            return _binary(expression, read, fit)
    return read(expression)


def _binary(
    expression: ex.BinaryExpression, read: Callable[[ex.Expression], Value], fit: Callable[[int], int]
) -> Value:
    kind = type(expression)
    left = evaluate(expression.left, read, fit)
    if kind is ex.Conjunction:
        return bool(left) and bool(evaluate(expression.right, read, fit))
    if kind is ex.Disjunction:
        return bool(left) or bool(evaluate(expression.right, read, fit))
    if kind is ex.Implication:
        return not left or bool(evaluate(expression.right, read, fit))
    right = evaluate(expression.right, read, fit)
    if kind is ex.Equation:
        return left == right
    if kind is ex.Inequation:
        return left != right and left == left and right == right  # noqa: PLR0124 - false where one is NaN
    if kind in _ORDERED:
        return _ORDERED[kind](left, right)
    if kind is ex.Division:
        return divide(as_double(left), as_double(right))
    if isinstance(left, float) or isinstance(right, float):
        return _ARITHMETIC[kind](as_double(left), as_double(right))
    return fit(int(_ARITHMETIC[kind](left, right)))


def _number(
    expression: ex.Expression, read: Callable[[ex.Expression], Value], fit: Callable[[int], int]
) -> int | float:
    value = evaluate(expression, read, fit)
    assert isinstance(value, (int, float))
    return value


def as_double(number: Value) -> float:
    """The number as a double; infinite where it is an integer too large to be one."""
    assert isinstance(number, (int, float))
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf


def divide(left: float, right: float) -> float:
    """The quotient as IEEE 754 has it: infinite or NaN where the divisor is zero."""
    if right:
        return left / right
    if left == 0 or math.isnan(left) or math.isnan(right):
        return math.nan
    return math.copysign(math.inf, left) * math.copysign(1.0, right)


def saturate(value: int, minimum: int | None, maximum: int | None) -> int:
    """The value, or the nearest bound where it is outside the range; an absent bound does not bound."""
    if minimum is not None:
        value = max(value, minimum)
    return value if maximum is None else min(value, maximum)
