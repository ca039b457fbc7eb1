"""Sums of variables: CIF's data-based synthesis can add and compare them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import reduce
from typing import TYPE_CHECKING, TypeAlias

from robosc.model import expression as ex
from robosc.model import sct

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Element that holds a number. CIF has no negative ones here, so that a negative range is shifted to start at 0.
Cell: TypeAlias = sct.DiscreteVariable | sct.Input

#: Largest integer: CIF has 32 bits, and synthesis needs one value beyond the range of a type.
LARGEST = 2**31 - 2
#: Maximum number of repeated additions; a table is shorter than more of them.
_REPEATED = 4


class Unsupported(Exception):  # noqa: N818 - the name states the property of the expression
    """Error of an expression that CIF cannot express, with the reason."""

    def __init__(self, expression: ex.Expression, reason: str) -> None:
        super().__init__(reason)
        self.expression = expression
        self.reason = reason


def bounds(cell: Cell) -> tuple[int, int]:
    """Return the lowest and the highest value of an integer variable or input."""
    kind = cell.type
    assert isinstance(kind, ex.IntegerType)
    assert kind.minimum is not None
    assert kind.maximum is not None
    return kind.minimum, kind.maximum


def shift(cell: Cell) -> int:
    """Return the offset from the value of a variable or input in the original model to its value in CIF."""
    return max(0, -bounds(cell)[0])


@dataclass(frozen=True)
class Linear:
    """A sum of constant factors times cells of the lowered model, plus a constant."""

    constant: int
    factors: Mapping[Cell, int] = field(default_factory=dict)

    def __add__(self, other: Linear) -> Linear:
        factors = dict(self.factors)
        for cell, factor in other.factors.items():
            factors[cell] = factors.get(cell, 0) + factor
        return Linear(self.constant + other.constant, {cell: factor for cell, factor in factors.items() if factor})

    def times(self, factor: int) -> Linear:
        """Return the sum multiplied by a constant."""
        if not factor:
            return Linear(0)
        return Linear(self.constant * factor, {cell: own * factor for cell, own in self.factors.items()})

    def range(self) -> tuple[int, int]:
        """Return the lowest and the highest value."""
        ends = [sorted(factor * bound for bound in bounds(cell)) for cell, factor in self.factors.items()]
        return self.constant + sum(low for low, _ in ends), self.constant + sum(high for _, high in ends)

    def sides(self) -> tuple[Linear, Linear]:
        """Return two sums without negative terms whose difference is this sum."""
        positive = {cell: factor for cell, factor in self.factors.items() if factor > 0}
        negative = {cell: -factor for cell, factor in self.factors.items() if factor < 0}
        return Linear(max(self.constant, 0), positive), Linear(max(-self.constant, 0), negative)

    def tree(self) -> ex.Expression:
        """Return the sum as an expression. Precondition: it has no negative terms."""
        terms = [_term(cell, factor) for cell, factor in self.factors.items()]
        if self.constant or not terms:
            terms.append(ex.IntegerLiteral(value=self.constant))
        return reduce(lambda left, right: ex.Addition(left=left, right=right), terms)


def reference(cell: Cell) -> ex.Expression:
    """Return an expression that reads a cell."""
    if isinstance(cell, sct.Input):
        return sct.InputReference(input=cell)
    return sct.VariableReference(variable=cell)


def _term(cell: Cell, factor: int) -> ex.Expression:
    """Return a cell times a positive constant: as repeated addition, or as a table if that is shorter."""
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
