"""Which values a type has, as an interval of whole numbers, and the integers of a machine that hold them."""

from __future__ import annotations

from itertools import count
from typing import NamedTuple

from robosc.metamodel import engine, sct
from robosc.metamodel import expression as ex


class Interval(NamedTuple):
    """Values between two bounds, both included. False and true count as 0 and 1, literals as their positions."""

    low: int
    high: int

    @property
    def size(self) -> int:
        """How many values there are; `len` of a range ends at 2^63."""
        return self.high - self.low + 1

    @property
    def single(self) -> int | None:
        """The only value, where there is only one."""
        return self.low if self.low == self.high else None

    def holds(self, other: Interval) -> bool:
        """Whether every value of the other interval is in this one."""
        return self.low <= other.low and other.high <= self.high

    def union(self, other: Interval) -> Interval:
        """The smallest interval with the values of both."""
        return Interval(min(self.low, other.low), max(self.high, other.high))

    def clamp(self, value: int) -> int:
        """The nearest value of the interval."""
        return min(max(value, self.low), self.high)


BOOLEAN = Interval(0, 1)


def domain(declared: sct.Plant | ex.Type) -> Interval:
    """The values of a type of an sct or engine model, or the positions of a plant's locations.

    Raises TypeError for a type without bounds: doubles, strings, integers without range.
    """
    match declared:
        case engine.LocationType():
            return domain(declared.plant)
        case sct.Plant():
            return Interval(0, len(declared.locations) - 1)
        case ex.BooleanType():
            return BOOLEAN
        case ex.EnumerationType():
            literals = list(declared.enumeration.literals)
            low = 0 if declared.first is None else literals.index(declared.first)
            high = len(literals) - 1 if declared.last is None else literals.index(declared.last)
            return Interval(low, high)
        case ex.IntegerType(minimum=int(low), maximum=int(high)):
            return Interval(low, high)
    raise TypeError(f"an sct model holds no {type(declared).__name__} without bounds")


def truth(can_be_false: bool, can_be_true: bool) -> Interval:
    """The values of a condition, at least one of which it has."""
    return Interval(0 if can_be_false else 1, 1 if can_be_true else 0)


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
