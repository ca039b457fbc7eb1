"""Sums of variables, which is what CIF's data-based synthesis can add and compare."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import reduce
from typing import TYPE_CHECKING, TypeAlias

from robosc.metamodel import expression as ex
from robosc.metamodel import sct

if TYPE_CHECKING:
    from collections.abc import Mapping

#: What holds a number: in CIF never a negative one, so that a negative range is shifted to start at 0.
Cell: TypeAlias = sct.DiscreteVariable | sct.Input

#: CIF's integers have 32 bits, and synthesis needs one value more than a type has.
LARGEST = 2**31 - 2
#: Repeated additions that are still shorter to read than a table.
_REPEATED = 4


class Unsupported(Exception):  # noqa: N818 - it says what the expression is
    """An expression that can't be said in CIF, with the reason."""

    def __init__(self, expression: ex.Expression, reason: str) -> None:
        super().__init__(reason)
        self.expression = expression
        self.reason = reason


def bounds(cell: Cell) -> tuple[int, int]:
    """The least and the greatest value of an integer variable or input."""
    kind = cell.type
    assert isinstance(kind, ex.IntegerType)
    assert kind.minimum is not None
    assert kind.maximum is not None
    return kind.minimum, kind.maximum


def shift(cell: Cell) -> int:
    """What is to be added to the value of a variable or input of the given model for the value that CIF holds."""
    return max(0, -bounds(cell)[0])


@dataclass(frozen=True)
class Linear:
    """Constant factors times what cells of the lowered model hold, plus a constant."""

    constant: int
    factors: Mapping[Cell, int] = field(default_factory=dict)

    def __add__(self, other: Linear) -> Linear:
        factors = dict(self.factors)
        for cell, factor in other.factors.items():
            factors[cell] = factors.get(cell, 0) + factor
        return Linear(self.constant + other.constant, {cell: factor for cell, factor in factors.items() if factor})

    def times(self, factor: int) -> Linear:
        """The sum multiplied by a constant."""
        if not factor:
            return Linear(0)
        return Linear(self.constant * factor, {cell: own * factor for cell, own in self.factors.items()})

    def range(self) -> tuple[int, int]:
        """The least and the greatest value."""
        ends = [sorted(factor * bound for bound in bounds(cell)) for cell, factor in self.factors.items()]
        return self.constant + sum(low for low, _ in ends), self.constant + sum(high for _, high in ends)

    def sides(self) -> tuple[Linear, Linear]:
        """Two sums without anything negative in them, of which this one is the difference."""
        positive = {cell: factor for cell, factor in self.factors.items() if factor > 0}
        negative = {cell: -factor for cell, factor in self.factors.items() if factor < 0}
        return Linear(max(self.constant, 0), positive), Linear(max(-self.constant, 0), negative)

    def tree(self) -> ex.Expression:
        """The sum as an expression. Nothing in it is negative."""
        terms = [_term(cell, factor) for cell, factor in self.factors.items()]
        if self.constant or not terms:
            terms.append(ex.IntegerLiteral(value=self.constant))
        return reduce(lambda left, right: ex.Addition(left=left, right=right), terms)


def reference(cell: Cell) -> ex.Expression:
    """Reads a cell."""
    if isinstance(cell, sct.Input):
        return sct.InputReference(input=cell)
    return sct.VariableReference(variable=cell)


def _term(cell: Cell, factor: int) -> ex.Expression:
    """A cell times a positive constant: added up, or looked up where that is shorter."""
    low, high = bounds(cell)
    if factor <= max(_REPEATED, high - low):
        terms = [reference(cell) for _ in range(factor)]
        return reduce(lambda left, right: ex.Addition(left=left, right=right), terms)
    table: ex.Expression = ex.IntegerLiteral(value=high * factor)
    for value in reversed(range(low, high)):
        table = ex.Conditional(
            condition=ex.Equation(left=reference(cell), right=ex.IntegerLiteral(value=value)),
            then=ex.IntegerLiteral(value=value * factor),
            otherwise=table,
        )
    return table
