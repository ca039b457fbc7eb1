"""The operators of expressions, each fact about them once: who parses, prints, types or computes reads it here.

A new operator is a class of `metamodel/expression.ecore`, an alternative in the grammar, and a row below; a function is
a word of the grammar and a row. The rest is what can not be said by its symbol: the encoding of synthesis, C, CIF, C++.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass
from enum import Enum, auto
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from robosc.metamodel import engine
from robosc.metamodel import expression as ex
from robosc.semantics.domains import Interval, truth

if TYPE_CHECKING:
    from collections.abc import Callable

#: A value of the language; an enumeration's value stands for itself (its literal object).
Value: TypeAlias = bool | int | float | str | object


class Rule(Enum):
    """What the operands must be, and what the value is."""

    #: Booleans; a boolean.
    LOGICAL = auto()
    #: Two values of one type that is no object and no array; a boolean.
    EQUALITY = auto()
    #: Numbers; a boolean.
    ORDERING = auto()
    #: Numbers; a double where one of them is a double, else an integer.
    ARITHMETIC = auto()
    #: Numbers, each read as a double; a double.
    DOUBLE = auto()
    #: Integers; an integer.
    INTEGER = auto()


#: The operators with a boolean value.
CONDITIONS = {Rule.LOGICAL, Rule.EQUALITY, Rule.ORDERING}


class Associativity(Enum):
    """How operators of one kind in a row group without parentheses, and which of these a printer writes."""

    #: To the left; a chain of one and the same operator needs no parentheses.
    CHAIN = auto()
    #: To the left; a printer writes the parentheses all the same.
    LEFT = auto()
    #: To the right.
    RIGHT = auto()


@dataclass(frozen=True)
class Operator:
    """One operator: its class in the metamodel, its text in RoboSC, and what it means.

    `precedence` grows from the loosest to the tightest. `compute` gives the value for those of the operands, which
    are of the right types: by IEEE 754 for doubles, integers however large. `interval` does the same for all values
    between bounds (None: no sct model has it). `decided` is the left operand's value at which the right one is not
    looked at, if there is such: the value is then `compute(decided, anything)`.
    A function has a number of `parameters`, and those of them that are `divisors` (from 0) must be positive constants.
    """

    metaclass: type[ex.Expression]
    symbol: str
    precedence: int
    rule: Rule
    compute: Callable[..., Any]
    interval: Callable[..., Interval] | None
    associativity: Associativity = Associativity.LEFT
    decided: bool | None = None
    parameters: int = 0
    divisors: frozenset[int] = frozenset()


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


def modulo(value: int, divisor: int) -> int:
    """The remainder, 0 to `divisor - 1` whatever the value's sign; 0 where the rule `argument` reports the divisor."""
    return value % divisor if divisor > 0 else 0


def _modulo_in(value: Interval, divisor: Interval) -> Interval:
    return value if Interval(0, divisor.low - 1).holds(value) else Interval(0, max(divisor.high - 1, 0))


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
    corners = [one * other for one in left for other in right]
    return Interval(min(corners), max(corners))


def _both_in(left: Interval, right: Interval) -> Interval:
    return Interval(min(left.low, right.low), min(left.high, right.high))


def _either_in(left: Interval, right: Interval) -> Interval:
    return Interval(max(left.low, right.low), max(left.high, right.high))


_CHAIN, _RIGHT = Associativity.CHAIN, Associativity.RIGHT

#: Loosest to tightest.
OPERATORS = (
    Operator(
        ex.Implication,
        "=>",
        1,
        Rule.LOGICAL,
        lambda left, right: not left or bool(right),
        lambda left, right: _either_in(_denied(left), right),
        _RIGHT,
        decided=False,
    ),
    Operator(
        ex.Disjunction,
        "or",
        2,
        Rule.LOGICAL,
        lambda left, right: bool(left or right),
        _either_in,
        _CHAIN,
        decided=True,
    ),
    Operator(
        ex.Conjunction,
        "and",
        3,
        Rule.LOGICAL,
        lambda left, right: bool(left and right),
        _both_in,
        _CHAIN,
        decided=False,
    ),
    Operator(ex.Equation, "=", 4, Rule.EQUALITY, operator.eq, _equal_in),
    Operator(ex.Inequation, "!=", 4, Rule.EQUALITY, _differ, lambda left, right: _denied(_equal_in(left, right))),
    Operator(ex.LessThan, "<", 5, Rule.ORDERING, operator.lt, _less_in),
    Operator(ex.LessOrEqual, "<=", 5, Rule.ORDERING, operator.le, lambda left, right: _denied(_less_in(right, left))),
    Operator(ex.GreaterThan, ">", 5, Rule.ORDERING, operator.gt, lambda left, right: _less_in(right, left)),
    Operator(
        ex.GreaterOrEqual, ">=", 5, Rule.ORDERING, operator.ge, lambda left, right: _denied(_less_in(left, right))
    ),
    Operator(
        ex.Addition,
        "+",
        6,
        Rule.ARITHMETIC,
        _arithmetic(operator.add),
        lambda left, right: Interval(left.low + right.low, left.high + right.high),
        _CHAIN,
    ),
    Operator(
        ex.Subtraction,
        "-",
        6,
        Rule.ARITHMETIC,
        _arithmetic(operator.sub),
        lambda left, right: Interval(left.low - right.high, left.high - right.low),
    ),
    Operator(ex.Multiplication, "*", 7, Rule.ARITHMETIC, _arithmetic(operator.mul), _product_in, _CHAIN),
    Operator(ex.Division, "/", 7, Rule.DOUBLE, lambda left, right: divide(as_double(left), as_double(right)), None),
    Operator(ex.Negation, "!", 8, Rule.LOGICAL, operator.not_, _denied),
    Operator(ex.UnaryMinus, "-", 8, Rule.ARITHMETIC, operator.neg, lambda value: Interval(-value.high, -value.low)),
)

#: The functions, by their names.
FUNCTIONS = {
    "mod": Operator(ex.FunctionCall, "mod", 9, Rule.INTEGER, modulo, _modulo_in, parameters=2, divisors=frozenset({1}))
}

BY_CLASS = {row.metaclass: row for row in OPERATORS} | {
    # Only transformations make these; no text has them.
    ex.DoubleConversion: Operator(ex.DoubleConversion, "", 9, Rule.DOUBLE, as_double, None),
    engine.Remainder: Operator(engine.Remainder, "%", 7, Rule.INTEGER, _remainder, _remainder_in),
}
PRECEDENCE = {row.metaclass: row.precedence for row in OPERATORS}
SYMBOLS = {row.metaclass: row.symbol for row in OPERATORS}
#: What has no operator outside binds tighter than any.
ATOM = 9


def _of(*rules: Rule) -> tuple[type[ex.Expression], ...]:
    return tuple(row.metaclass for row in OPERATORS if row.rule in rules)


#: For `isinstance`: the operators by what they do.
LOGICAL, EQUALITY, ORDERING, ARITHMETIC = map(_of, (Rule.LOGICAL, Rule.EQUALITY, Rule.ORDERING, Rule.ARITHMETIC))
COMPARISONS = cast("tuple[type[ex.BinaryExpression], ...]", (*EQUALITY, *ORDERING))


def operator_of(expression: ex.Expression | None) -> Operator | None:
    """The row of an expression's outermost operator or function; None of literals, references and choices."""
    if isinstance(expression, ex.FunctionCall):
        return FUNCTIONS[expression.function]
    return BY_CLASS.get(type(expression))  # type: ignore[arg-type]
