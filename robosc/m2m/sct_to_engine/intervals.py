"""The integers of a machine that hold the values of variables and computations."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, NamedTuple

from robosc.metamodel import engine
from robosc.semantics.domains import Interval, domain

if TYPE_CHECKING:
    from robosc.metamodel import expression as ex


def interval_of(kind: ex.Type) -> Interval:
    """The values of a type of an sct or engine model. Raises TypeError where it has no bounds."""
    return domain(kind.plant if isinstance(kind, engine.LocationType) else kind)


class Width(NamedTuple):
    """An integer type: its width in bits, and whether it has a sign (two's complement)."""

    bits: int
    signed: bool

    @property
    def values(self) -> Interval:
        """What it holds."""
        half = 1 << (self.bits - 1)
        return Interval(-half, half - 1) if self.signed else Interval(0, 2 * half - 1)


_WIDTHS = [Width(8, signed=False)] + [Width(bits, signed) for bits in (8, 16, 32, 64) for signed in (True, False)]


def storage(values: Interval) -> Width:
    """The smallest type that stores the values; of two the signed one, but of those of 8 bits.

    Raises OverflowError where not even 64 bits with a sign do.
    """
    for width in _WIDTHS[:-1]:
        if width.values.holds(values):
            return width
    raise OverflowError(f"no integer type holds {values.low} to {values.high}")


def working_width(values: Interval, least: int = 16) -> Width:
    """The signed type in which an operator computes whose operands and result have these values.

    It has at least `least` bits, and at most as many as are needed, even if no machine has them.
    """
    return next(width for power in count() if (width := Width(least << power, signed=True)).values.holds(values))
