"""Tabulation of comparisons of doubles and strings, which no sct model has, to conditions on integers."""

from __future__ import annotations

import math
from itertools import groupby, product
from operator import itemgetter
from typing import NamedTuple, TypeAlias

from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.semantics.cone_of_influence import LARGEST_TABLE
from robosc.model.semantics.evaluation import Program, Value, literal
from robosc.model.semantics.printing import conjunction, disjunction
from robosc.model.semantics.typing import BOOLEAN, infer
from robosc.model.semantics.walks import copy_tree, fold, operands, parts, with_operands


class TooLargeError(Exception):
    """Error of a comparison whose integers have too many valuations; `count` is their number."""

    def __init__(self, count: int) -> None:
        self.count = count
        super().__init__(f"{count} combinations of values")


class _Column(NamedTuple):
    """Runs of values of the integer at `depth`, each with the remaining table. For values outside, it is false."""

    depth: int
    runs: tuple[tuple[int, int, _Table], ...]


#: Truth table of a comparison, integer by integer. Equal conditions have equal tables.
_Table: TypeAlias = bool | _Column


def tabulate(comparison: ex.Expression) -> ex.Expression:
    """Return a condition over integer comparisons that is equivalent to the comparison. Raises TooLargeError.

    The condition of a conditional number becomes a part of the result.
    """
    choices: dict[sct.DiscreteVariable, ex.Expression] = {}
    comparison = fold(lambda part, operands: _decided(part, operands, choices), comparison, _numbers)
    references = {_declaration(part): part for part in parts(comparison) if _declaration(part) is not None}
    ranges = [_range(reference) for reference in references]
    count = math.prod(map(len, ranges))
    if count > LARGEST_TABLE:
        raise TooLargeError(count)
    position = {reference: number for number, reference in enumerate(references)}
    holds = Program[Value](comparison, lambda reference: itemgetter(position[_declaration(reference)]))
    rows: list[_Table] = [bool(holds(values)) for values in product(*ranges)]
    for depth in range(len(ranges) - 1, -1, -1):
        width = len(ranges[depth])
        rows = [_column(depth, ranges[depth], rows[first : first + width]) for first in range(0, len(rows), width)]
    return _condition(rows[0], [choices.get(of, part) for of, part in references.items()], ranges)  # type: ignore[arg-type]


def _numbers(part: ex.Expression) -> list[ex.Expression]:
    """Return the operands that determine a number. A conditional has its branches."""
    return [part.then, part.otherwise] if isinstance(part, ex.Conditional) else operands(part)


def _decided(
    part: ex.Expression, inside: list[ex.Expression], choices: dict[sct.DiscreteVariable, ex.Expression]
) -> ex.Expression:
    """Return the part, with a variable in place of each condition."""
    if not isinstance(part, ex.Conditional):
        return with_operands(part, inside) if inside else copy_tree(part)
    variable = sct.DiscreteVariable(name="choice", type=ex.BooleanType())
    choices[variable] = part.condition
    return with_operands(part, [sct.VariableReference(variable=variable), *inside])


def _column(depth: int, whole: range, rows: list[_Table]) -> _Table:
    """Return the runs of values with equal tables. If all tables are equal, return this table."""
    runs: list[tuple[int, int, _Table]] = []
    table: _Table
    for table, group in groupby(zip(whole, rows, strict=True), key=lambda row: row[1]):
        values = [value for value, _ in group]
        if len(values) == len(whole):
            return table
        if table is not False:
            runs.append((values[0], values[-1], table))
    return _Column(depth, tuple(runs))


def _condition(table: _Table, references: list[ex.Expression], ranges: list[range]) -> ex.Expression:
    """Return the condition of a table.

    Its depth is the number of integers with two or more values, which is limited.
    """
    if isinstance(table, bool):
        return ex.BooleanLiteral(value=table)
    alternatives = []
    for low, high, rest in table.runs:
        inside = _between(references[table.depth], low, high, ranges[table.depth])
        alternatives.append(_all(inside if rest is True else [*inside, _condition(rest, references, ranges)]))
    condition = disjunction(alternatives)
    assert condition is not None
    return condition


def _between(reference: ex.Expression, low: int, high: int, whole: range) -> list[ex.Expression]:
    """Return `low <= reference <= high`, without bounds that the range implies."""
    if _is_condition(reference):
        return [copy_tree(reference) if low else ex.Negation(operand=copy_tree(reference))]
    if low == high:
        return [ex.Equation(left=copy_tree(reference), right=literal(low))]
    bounds: list[ex.Expression] = []
    if low > whole[0]:
        bounds.append(ex.GreaterOrEqual(left=copy_tree(reference), right=literal(low)))
    if high < whole[-1]:
        bounds.append(ex.LessOrEqual(left=copy_tree(reference), right=literal(high)))
    return bounds


def _is_condition(reference: ex.Expression) -> bool:
    return infer(reference) == BOOLEAN


def _all(conditions: list[ex.Expression]) -> ex.Expression:
    condition = conjunction(conditions)
    assert condition is not None
    return condition


def _declaration(reference: ex.Expression) -> sct.DiscreteVariable | sct.Input | None:
    match reference:
        case sct.VariableReference():
            return reference.variable
        case sct.InputReference():
            return reference.input
    return None


def _range(declared: sct.DiscreteVariable | sct.Input | None) -> range:
    kind = declared.type if declared is not None else None
    if isinstance(kind, ex.BooleanType):
        return range(2)
    assert isinstance(kind, ex.IntegerType)
    assert kind.minimum is not None
    assert kind.maximum is not None
    return range(kind.minimum, kind.maximum + 1)
