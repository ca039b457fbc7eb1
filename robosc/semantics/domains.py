"""Which values a type has: the finite domain of each type of an sct model, as an interval of whole numbers."""

from __future__ import annotations

from typing import NamedTuple

from robosc.metamodel import expression as ex
from robosc.metamodel import sct


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
    """The values of a type, or the positions of a plant's locations.

    Raises TypeError for a type without bounds: doubles, strings, integers without range.
    """
    match declared:
        case sct.Plant():
            return Interval(0, len(declared.locations) - 1)
        case ex.BooleanType():
            return BOOLEAN
        case ex.EnumerationType():
            return Interval(0, len(declared.enumeration.literals) - 1)
        case ex.IntegerType(minimum=int(low), maximum=int(high)):
            return Interval(low, high)
    raise TypeError(f"an sct model holds no {type(declared).__name__} without bounds")


def truth(can_be_false: bool, can_be_true: bool) -> Interval:
    """The values of a condition, at least one of which it has."""
    return Interval(0 if can_be_false else 1, 1 if can_be_true else 0)
