"""Comparisons of doubles, which no sct model has, as conditions on the ranged integers that they are computed from."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

from robosc.m2m.constants import literal
from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.cone_of_influence import LARGEST_TABLE
from robosc.semantics.evaluation import Value, evaluate
from robosc.semantics.printing import conjunction, disjunction

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence


class TooLargeError(Exception):
    """The integers of a comparison have too many valuations to tabulate; `count` says how many."""

    def __init__(self, count: int) -> None:
        self.count = count
        super().__init__(f"{count} combinations of values")


def tabulate(
    comparison: ex.Expression,
    references: Sequence[ex.Expression],
    ranges: Sequence[range],
    copy: Callable[[ex.Expression], ex.Expression],
) -> ex.Expression:
    """A condition over integer comparisons that holds exactly where the comparison does.

    `references` are the integer references in it, each in another object than the comparison's own; `copy` makes a
    new reference of one of them. Raises TooLargeError.
    """
    count = 1
    for values in ranges:
        count *= len(values)
    if count > LARGEST_TABLE:
        raise TooLargeError(count)
    keys = [_key(reference) for reference in references]

    def table(depth: int, values: Mapping[object, int]) -> ex.Expression:
        if depth == len(keys):
            result = evaluate(comparison, lambda reference: values[_key(reference)])
            return ex.BooleanLiteral(value=bool(result))
        columns = [(value, table(depth + 1, {**values, keys[depth]: value})) for value in ranges[depth]]
        alternatives: list[ex.Expression] = []
        for shape, group in groupby(columns, key=lambda column: _shape(column[1])):
            run = list(group)
            if shape == "false":
                continue
            inside = _between(references[depth], run[0][0], run[-1][0], ranges[depth], copy)
            rest = None if shape == "true" else run[0][1]
            alternatives.append(conjunction(part for part in (inside, rest) if part) or ex.BooleanLiteral(value=True))
        return disjunction(alternatives) or ex.BooleanLiteral(value=False)

    return table(0, {})


def _between(
    reference: ex.Expression, low: int, high: int, whole: range, copy: Callable[[ex.Expression], ex.Expression]
) -> ex.Expression | None:
    """`low <= reference <= high`, without the bounds that the range has anyway."""
    if low == high and len(whole) > 1:
        return ex.Equation(left=copy(reference), right=literal(low))
    parts: list[ex.Expression] = []
    if low > whole[0]:
        parts.append(ex.GreaterOrEqual(left=copy(reference), right=literal(low)))
    if high < whole[-1]:
        parts.append(ex.LessOrEqual(left=copy(reference), right=literal(high)))
    return conjunction(parts)


def _key(reference: ex.Expression) -> Value:
    if isinstance(reference, sct.VariableReference):
        return reference.variable
    assert isinstance(reference, sct.InputReference)
    return reference.input


def _shape(expression: ex.Expression) -> str:
    """Equal for equal trees over the same references, as tables of one comparison are."""
    match expression:
        case ex.BooleanLiteral():
            return "true" if expression.value else "false"
        case ex.IntegerLiteral():
            return str(expression.value)
        case ex.UnaryMinus():
            return f"-{_shape(expression.operand)}"
        case ex.BinaryExpression():
            return f"({_shape(expression.left)} {type(expression).__name__} {_shape(expression.right)})"
    return str(id(_key(expression)))
