"""CIF's operators and types, as far as synthesis supports them. Source: CIF's language reference.

A type is BOOLEAN, an enumeration, or, for integers, the range of an expression's possible values. Both readers of CIF
use this module: the reader of specifications and the reader of generated CIF. The generator does not use it. The
readers therefore check the generator's view of CIF independently.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

from robosc.model import expression as ex
from robosc.model import sct

if TYPE_CHECKING:
    from collections.abc import Mapping

BOOLEAN: Final = "bool"
#: Largest integer of CIF, which has 32 bits.
LARGEST = 2**31 - 1
Type: TypeAlias = str | range | ex.Enumeration

#: Precedence of each operator (higher binds tighter) and the class of its expression. All comparisons have the same
#: precedence. An implication does not chain.
OPERATORS: Mapping[str, tuple[int, type[ex.BinaryExpression]]] = {
    "=>": (1, ex.Implication),
    "<=>": (1, ex.Equation),
    "or": (2, ex.Disjunction),
    "and": (3, ex.Conjunction),
    "=": (4, ex.Equation),
    "!=": (4, ex.Inequation),
    "<": (4, ex.LessThan),
    "<=": (4, ex.LessOrEqual),
    ">": (4, ex.GreaterThan),
    ">=": (4, ex.GreaterOrEqual),
    "+": (5, ex.Addition),
    "-": (5, ex.Subtraction),
    "*": (6, ex.Multiplication),
    "div": (6, sct.Quotient),
    "mod": (6, sct.Quotient),
}
#: Operators of CIF that synthesis does not support, with their precedence.
FOREIGN = {"/": 6, "in": 4, "sub": 4}
_LOGICAL = ("=>", "<=>", "or", "and")


def format_type(kind: Type) -> str:
    """Return a type in CIF's notation."""
    match kind:
        case range():
            return f"int[{kind.start}..{kind.stop - 1}]"
        case ex.Enumeration():
            return str(kind.name)
    return str(kind)


def compatible(left: Type, right: Type) -> bool:
    """Return whether values of two types can be compared, or be alternatives of one expression. Ranges are ignored."""
    if isinstance(left, ex.Enumeration) and isinstance(right, ex.Enumeration):
        return [literal.name for literal in left.literals] == [literal.name for literal in right.literals]
    return isinstance(left, range) and isinstance(right, range) if isinstance(left, range) else left == right


def combine_types(operator: str, left: Type, right: Type) -> Type:
    """Return the type of a binary expression.

    Raises TypeError, with the cause, if the operator does not apply to the operands.
    """
    if operator in _LOGICAL:
        fits = left == right == BOOLEAN
    elif operator in ("=", "!="):
        fits = compatible(left, right)
    else:
        fits = isinstance(left, range) and isinstance(right, range)
    if not fits:
        raise TypeError(f"`{operator}` does not apply to {format_type(left)} and {format_type(right)}")
    if not isinstance(left, range) or not isinstance(right, range) or OPERATORS[operator][0] < 5:
        return BOOLEAN
    if operator in ("div", "mod"):
        return _divided(operator, left, right)
    low, high = right.start, right.stop - 1
    if operator == "+":
        values = range(left.start + low, left.stop + high)
    elif operator == "-":
        values = range(left.start - high, left.stop - low)
    else:
        corners = [left_end * right_end for left_end in (left.start, left.stop - 1) for right_end in (low, high)]
        values = range(min(corners), max(corners) + 1)
    return value_range(operator, values)


def value_range(operator: str, values: range) -> range:
    """Return the range of an operation's values. Raises TypeError if it exceeds CIF's integers."""
    if values.start < -LARGEST - 1 or values.stop - 1 > LARGEST:
        raise TypeError(f"`{operator}` could overflow: its values are {values.start} to {values.stop - 1}")
    return values


def _divided(operator: str, left: range, right: range) -> range:
    if len(right) != 1 or right.start < 1:
        raise TypeError(f"synthesis supports `{operator}` only by a positive constant")
    if left.start < 0:
        raise TypeError(f"synthesis supports `{operator}` only of values that are never negative")
    divisor, last = right.start, left.stop - 1
    return range(left.start // divisor, last // divisor + 1) if operator == "div" else range(min(last, divisor - 1) + 1)


def join_types(left: Type, right: Type) -> Type:
    """Return the type that holds the values of both types. Raises TypeError if they are not compatible."""
    if not compatible(left, right):
        raise TypeError(f"the alternatives are {format_type(left)} and {format_type(right)}")
    if isinstance(left, range) and isinstance(right, range):
        return range(min(left.start, right.start), max(left.stop, right.stop))
    return left


def overlap(variable: Type, value: Type) -> bool:
    """Return whether at least one of the values can be assigned to the variable."""
    if isinstance(variable, range) and isinstance(value, range):
        return variable.start < value.stop and value.start < variable.stop
    return compatible(variable, value)


def contains(variable: Type, value: Type) -> bool:
    """Return whether all of the values can be assigned to the variable."""
    if isinstance(variable, range) and isinstance(value, range):
        return variable.start <= value.start and value.stop <= variable.stop
    return compatible(variable, value)
