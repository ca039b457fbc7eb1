"""Values of types as intervals of integers, and the machine integers that hold them."""

from __future__ import annotations

from itertools import count
from typing import NamedTuple

from robosc.model import engine, sct
from robosc.model import expression as ex


class Interval(NamedTuple):
    """Integers between two bounds, both included. False and true count as 0 and 1, literals as their positions."""

    low: int
    high: int

    @property
    def size(self) -> int:
        """Number of values. `len` of a range would be limited to 2^63."""
        return self.high - self.low + 1

    @property
    def single(self) -> int | None:
        """The only value of the interval. None if there are several."""
        return self.low if self.low == self.high else None

    def holds(self, other: Interval) -> bool:
        """Return whether every value of the other interval is in this one."""
        return self.low <= other.low and other.high <= self.high

    def union(self, other: Interval) -> Interval:
        """Return the smallest interval that contains both intervals."""
        return Interval(min(self.low, other.low), max(self.high, other.high))

    def clamp(self, value: int) -> int:
        """Return the value of the interval that is nearest to `value`."""
        return min(max(value, self.low), self.high)


BOOLEAN = Interval(0, 1)


def domain(declared: sct.Plant | ex.Type) -> Interval:
    """Return the values of a type of an sct or engine model, or the positions of a plant's locations.

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
    """Return the values of a condition. At least one of the arguments is true."""
    return Interval(0 if can_be_false else 1, 1 if can_be_true else 0)


class Width(NamedTuple):
    """An integer type: its width in bits, and whether it has a sign (two's complement)."""

    bits: int
    signed: bool

    @property
    def values(self) -> Interval:
        """Values that the type can hold."""
        half = 1 << (self.bits - 1)
        return Interval(-half, half - 1) if self.signed else Interval(0, 2 * half - 1)


_WIDTHS = [Width(8, signed=False)] + [Width(bits, signed) for bits in (8, 16, 32, 64) for signed in (True, False)]


def storage(values: Interval) -> Width:
    """Return the smallest type that stores the values. Signed types are preferred, except for 8 bits.

    Raises OverflowError if the values exceed 64 signed bits.
    """
    for width in _WIDTHS[:-1]:
        if width.values.holds(values):
            return width
    raise OverflowError(f"no integer type holds {values.low} to {values.high}")


def working_width(values: Interval, least: int = 16) -> Width:
    """Return the signed type in which to compute an operator whose operands and result have these values.

    The type has at least `least` bits and no more than needed. It may be wider than the integers of any machine.
    """
    return next(width for power in count() if (width := Width(least << power, signed=True)).values.holds(values))
