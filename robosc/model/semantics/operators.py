"""Table of the operators of expressions, shared by parsing, printing, typing and computation.

A new operator needs a class of `metamodel/expression.ecore`, an alternative in the grammar, and a row below. A new
function needs a word of the grammar and a row. Some facts do not fit in a row: the spelling in C++, and, for operators
that the supervisor computes, the expansion by cases or the encoding, C and CIF. `docs/architecture.md` lists their
places.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass
from enum import Enum, auto
from functools import reduce
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.semantics.domains import Interval, truth

if TYPE_CHECKING:
    from collections.abc import Callable

#: A value of the language. The value of an enumeration is its literal object.
Value: TypeAlias = bool | int | float | str | object


class TypeRule(Enum):
    """Types of the operands and of the value."""

    #: Booleans; a boolean.
    LOGICAL = auto()
    #: Two values of one type other than objects and arrays; a boolean.
    EQUALITY = auto()
    #: Numbers; a boolean.
    ORDERING = auto()
    #: Numbers; a double if one of them is a double, else an integer.
    ARITHMETIC = auto()
    #: Numbers, each converted to a double; a double.
    DOUBLE = auto()
    #: Integers; an integer.
    INTEGER = auto()
    #: A double; an integer.
    ROUNDING = auto()
    #: An array or a string; an integer.
    SIZE = auto()
    #: An array of numbers; one of its elements.
    ELEMENTS = auto()


#: Rules of the operators with a boolean value.
CONDITIONS = {TypeRule.LOGICAL, TypeRule.EQUALITY, TypeRule.ORDERING}


class Associativity(Enum):
    """Grouping of equal operators without parentheses, and the parentheses that a printer writes."""

    #: To the left. A chain of one operator needs no parentheses.
    CHAIN = auto()
    #: To the left. A printer writes the parentheses nevertheless.
    LEFT = auto()
    #: To the right.
    RIGHT = auto()


class UnreadableError(Exception):
    """Error of an expression without a value: a missing element of an array, or rounding of NaN."""


@dataclass(frozen=True)
class Operator:
    """An operator: its class in the metamodel, its text in RoboSC, and its meaning.

    `precedence` grows from the loosest to the tightest operator. `compute` returns the value for operands of the right
    types; doubles follow IEEE 754, integers are unbounded. It raises UnreadableError if there is no value; this is
    possible only if `is_partial`. `interval` returns the bounds of the value for operands between bounds. It is None
    for functions and for operators that no sct model has. `decided` is the value of the left operand that makes the
    right one irrelevant, if any: the value is then `compute(decided, anything)`. A function has a number of
    `parameters`. Its parameters in `divisors` (counted from 0) must be positive constants.
    """

    metaclass: type[ex.Expression]
    symbol: str
    precedence: int
    rule: TypeRule
    compute: Callable[..., Any]
    interval: Callable[..., Interval] | None
    associativity: Associativity = Associativity.LEFT
    decided: bool | None = None
    parameters: int = 0
    divisors: frozenset[int] = frozenset()

    @property
    def is_partial(self) -> bool:
        """Whether some operands have no value."""
        return self.rule in {TypeRule.ROUNDING, TypeRule.ELEMENTS}

    @property
    def is_supervised(self) -> bool:
        """Whether sct models have the operator, so that the supervisor computes it."""
        return self.rule not in {TypeRule.DOUBLE, TypeRule.ROUNDING, TypeRule.SIZE, TypeRule.ELEMENTS}


def as_double(number: Value) -> float:
    """Return the number as a double. An integer that is too large becomes infinite. Raises TypeError for a text."""
    if not isinstance(number, (int, float)):
        raise TypeError(f"{number!r} is not a number")
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf


def divide(left: float, right: float) -> float:
    """Return the quotient by IEEE 754: infinite or NaN if the divisor is zero."""
    if right:
        return left / right
    if left == 0 or math.isnan(left) or math.isnan(right):
        return math.nan
    return math.copysign(math.inf, left) * math.copysign(1.0, right)


def modulo(value: int, divisor: int) -> int:
    """Return the remainder, 0 to `divisor - 1` for any sign of the value.

    Returns 0 for divisors that the rule `argument` reports.
    """
    return value % divisor if divisor > 0 else 0


def _rounded(nearest: Callable[[float], int]) -> Callable[[float], int]:
    def compute(value: float) -> int:
        if math.isnan(value):
            raise UnreadableError("NaN cannot be rounded")
        return nearest(max(float(_LEAST), min(float(_MOST), value)))

    return compute


def _nearest(value: float) -> int:
    whole = math.trunc(value)
    return whole + int(math.copysign(1, value)) if abs(value - whole) >= 0.5 else whole


def _finite(compute: Callable[[float], float]) -> Callable[[float], float]:
    """Return a function that returns NaN where Python raises ValueError."""

    def computed(value: Value) -> float:
        try:
            return compute(as_double(value))
        except ValueError:
            return math.nan

    return computed


def _preferred(before: Callable[[Any, Any], bool]) -> Callable[[Any, Any], Any]:
    return _arithmetic(lambda left, right: right if before(right, left) or left != left else left)  # noqa: PLR0124


def _first(before: Callable[[Any, Any], bool]) -> Callable[[Any], Any]:
    def chosen(values: Any) -> Any:
        numbers = [value for value in values if value == value]  # noqa: PLR0124 - NaN is passed over
        if not numbers:
            raise UnreadableError(f"there is no number in an array of {len(values)}")
        return reduce(lambda best, value: value if before(value, best) else best, numbers)

    return chosen


def _remainder(value: int, divisor: int) -> int:
    return abs(value) % divisor * (-1 if value < 0 else 1)


def _remainder_in(value: Interval, divisor: Interval) -> Interval:
    last = divisor.high - 1
    return Interval(max(min(value.low, 0), -last), min(max(value.high, 0), last))


def _arithmetic(compute: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    def computed(left: Any, right: Any) -> Any:
        if isinstance(left, float) or isinstance(right, float):
            return compute(as_double(left), as_double(right))
        return compute(left, right)

    return computed


def _differ(left: Any, right: Any) -> bool:
    return bool(left != right and left == left and right == right)  # noqa: PLR0124 - false where one is NaN


def _equal_in(left: Interval, right: Interval) -> Interval:
    return truth(left.single is None or left != right, left.low <= right.high and right.low <= left.high)


def _denied(value: Interval) -> Interval:
    return Interval(1 - value.high, 1 - value.low)


def _less_in(left: Interval, right: Interval) -> Interval:
    return truth(left.high >= right.low, left.low < right.high)


def _product_in(left: Interval, right: Interval) -> Interval:
    corners = [left_end * right_end for left_end in left for right_end in right]
    return Interval(min(corners), max(corners))


def _both_in(left: Interval, right: Interval) -> Interval:
    return Interval(min(left.low, right.low), min(left.high, right.high))


def _either_in(left: Interval, right: Interval) -> Interval:
    return Interval(max(left.low, right.low), max(left.high, right.high))


_CHAIN, _RIGHT = Associativity.CHAIN, Associativity.RIGHT

#: Operators from the loosest to the tightest.
OPERATORS = (
    Operator(
        ex.Implication,
        "=>",
        1,
        TypeRule.LOGICAL,
        lambda left, right: not left or bool(right),
        lambda left, right: _either_in(_denied(left), right),
        _RIGHT,
        decided=False,
    ),
    Operator(
        ex.Disjunction,
        "or",
        2,
        TypeRule.LOGICAL,
        lambda left, right: bool(left or right),
        _either_in,
        _CHAIN,
        decided=True,
    ),
    Operator(
        ex.Conjunction,
        "and",
        3,
        TypeRule.LOGICAL,
        lambda left, right: bool(left and right),
        _both_in,
        _CHAIN,
        decided=False,
    ),
    Operator(ex.Equation, "=", 4, TypeRule.EQUALITY, operator.eq, _equal_in),
    Operator(ex.Inequation, "!=", 4, TypeRule.EQUALITY, _differ, lambda left, right: _denied(_equal_in(left, right))),
    Operator(ex.LessThan, "<", 5, TypeRule.ORDERING, operator.lt, _less_in),
    Operator(
        ex.LessOrEqual, "<=", 5, TypeRule.ORDERING, operator.le, lambda left, right: _denied(_less_in(right, left))
    ),
    Operator(ex.GreaterThan, ">", 5, TypeRule.ORDERING, operator.gt, lambda left, right: _less_in(right, left)),
    Operator(
        ex.GreaterOrEqual, ">=", 5, TypeRule.ORDERING, operator.ge, lambda left, right: _denied(_less_in(left, right))
    ),
    Operator(
        ex.Addition,
        "+",
        6,
        TypeRule.ARITHMETIC,
        _arithmetic(operator.add),
        lambda left, right: Interval(left.low + right.low, left.high + right.high),
        _CHAIN,
    ),
    Operator(
        ex.Subtraction,
        "-",
        6,
        TypeRule.ARITHMETIC,
        _arithmetic(operator.sub),
        lambda left, right: Interval(left.low - right.high, left.high - right.low),
    ),
    Operator(ex.Multiplication, "*", 7, TypeRule.ARITHMETIC, _arithmetic(operator.mul), _product_in, _CHAIN),
    Operator(ex.Division, "/", 7, TypeRule.DOUBLE, lambda left, right: divide(as_double(left), as_double(right)), None),
    Operator(ex.Negation, "!", 8, TypeRule.LOGICAL, operator.not_, _denied),
    Operator(ex.UnaryMinus, "-", 8, TypeRule.ARITHMETIC, operator.neg, lambda value: Interval(-value.high, -value.low)),
)


def _function(name: str, rule: TypeRule, compute: Callable[..., Any], parameters: int = 1) -> Operator:
    return Operator(ex.FunctionCall, name, 9, rule, compute, None, parameters=parameters)


#: Bounds of rounded values, which saturate at 32 bits.
_LEAST, _MOST = -(2**31), 2**31 - 1

#: Functions by name.
FUNCTIONS = {
    "mod": Operator(ex.FunctionCall, "mod", 9, TypeRule.INTEGER, modulo, None, parameters=2, divisors=frozenset({1}))
} | {
    row.symbol: row
    for row in (
        _function("abs", TypeRule.ARITHMETIC, abs),
        _function("min", TypeRule.ARITHMETIC, _preferred(operator.lt), 2),
        _function("max", TypeRule.ARITHMETIC, _preferred(operator.gt), 2),
        _function("floor", TypeRule.ROUNDING, _rounded(math.floor)),
        _function("ceil", TypeRule.ROUNDING, _rounded(math.ceil)),
        _function("round", TypeRule.ROUNDING, _rounded(_nearest)),
        _function("sqrt", TypeRule.DOUBLE, _finite(math.sqrt)),
        _function("sin", TypeRule.DOUBLE, _finite(math.sin)),
        _function("cos", TypeRule.DOUBLE, _finite(math.cos)),
        _function("atan2", TypeRule.DOUBLE, lambda y, x: math.atan2(as_double(y), as_double(x)), 2),
        # A call of `hypot` is that of an own function of this name, if there is one.
        _function("hypot", TypeRule.DOUBLE, lambda x, y: math.hypot(as_double(x), as_double(y)), 2),
        _function("double", TypeRule.DOUBLE, as_double),
        _function("size", TypeRule.SIZE, len),
    )
}
#: Functions that share a name with the above and take one array.
_OF_ARRAYS = {
    "min": _function("min", TypeRule.ELEMENTS, _first(operator.lt)),
    "max": _function("max", TypeRule.ELEMENTS, _first(operator.gt)),
}

BY_CLASS = {row.metaclass: row for row in OPERATORS} | {
    # Only transformations create these; they have no text.
    ex.DoubleConversion: Operator(ex.DoubleConversion, "", 9, TypeRule.DOUBLE, as_double, None),
    sct.Quotient: Operator(
        sct.Quotient,
        "div",
        7,
        TypeRule.INTEGER,
        operator.floordiv,
        lambda left, right: Interval(left.low // right.low, left.high // right.low),
    ),
    engine.Remainder: Operator(engine.Remainder, "%", 7, TypeRule.INTEGER, _remainder, _remainder_in),
}
PRECEDENCE = {row.metaclass: row.precedence for row in OPERATORS}
SYMBOLS = {row.metaclass: row.symbol for row in OPERATORS} | {sct.Quotient: "div"}
#: Precedence of an expression without an outer operator: binds tighter than all operators.
ATOM = 9


def _of(*rules: TypeRule) -> tuple[type[ex.Expression], ...]:
    return tuple(row.metaclass for row in OPERATORS if row.rule in rules)


#: Classes of operators by kind, for `isinstance`.
LOGICAL, EQUALITY, ORDERING, ARITHMETIC = map(
    _of, (TypeRule.LOGICAL, TypeRule.EQUALITY, TypeRule.ORDERING, TypeRule.ARITHMETIC)
)
COMPARISONS = cast("tuple[type[ex.BinaryExpression], ...]", (*EQUALITY, *ORDERING))


def operator_of(expression: ex.Expression | None) -> Operator | None:
    """Return the row of an expression's outermost operator or function.

    None for literals, references and conditionals.
    """
    if isinstance(expression, ex.FunctionCall):
        own = _OF_ARRAYS.get(expression.function) if len(expression.arguments) == 1 else None
        return own or FUNCTIONS[expression.function]
    return BY_CLASS.get(type(expression))  # type: ignore[arg-type]
