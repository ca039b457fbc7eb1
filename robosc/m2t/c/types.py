"""How values of an sct model are stored in C: in the smallest type that holds them."""

from __future__ import annotations

from typing import NamedTuple

from robosc.metamodel import expression as ex


class Interval(NamedTuple):
    """Values between two bounds, both included. False and true count as 0 and 1, literals as their positions."""

    low: int
    high: int

    def holds(self, other: Interval) -> bool:
        """Whether every value of the other interval is in this one."""
        return self.low <= other.low and other.high <= self.high

    def union(self, other: Interval) -> Interval:
        """The smallest interval with the values of both."""
        return Interval(min(self.low, other.low), max(self.high, other.high))

    @property
    def single(self) -> int | None:
        """The only value, where there is only one."""
        return self.low if self.low == self.high else None


BOOLEAN = Interval(0, 1)


def signed(bits: int) -> Interval:
    """What a signed integer of so many bits holds."""
    return Interval(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def unsigned(bits: int) -> Interval:
    """What an unsigned integer of so many bits holds."""
    return Interval(0, 2**bits - 1)


def interval_of(kind: ex.Type) -> Interval:
    """The values of a type of an sct model. Raises TypeError where it has no bounds: the preconditions refuse it."""
    match kind:
        case ex.BooleanType():
            return BOOLEAN
        case ex.EnumerationType():
            return Interval(0, len(kind.enumeration.literals) - 1)
        case ex.IntegerType(minimum=int(low), maximum=int(high)):
            return Interval(low, high)
    raise TypeError(f"no values of {type(kind).__name__} are known")


def storage(values: Interval) -> str:
    """The smallest integer type of <stdint.h> that holds the values; of two that C computes with as `int`s.

    Raises OverflowError where not even int64_t does.
    """
    if unsigned(8).holds(values):
        return "uint8_t"
    for bits in (8, 16, 32, 64):
        if signed(bits).holds(values):
            return f"int{bits}_t"
        if bits < 64 and unsigned(bits).holds(values):
            return f"uint{bits}_t"
    raise OverflowError(f"no C type holds {values.low} to {values.high}")


def type_name(kind: ex.Type) -> str:
    """The C type that stores a value of a type of an sct model."""
    return "bool" if isinstance(kind, ex.BooleanType) else storage(interval_of(kind))


def index_type(count: int) -> str:
    """The C type that stores a position among so many."""
    return storage(Interval(0, max(count, 1)))


def unsigned_type(most: int) -> str:
    """The C type that stores a number up to `most` and mixes with `unsigned` ones."""
    return next(f"uint{bits}_t" for bits in (8, 16, 32) if unsigned(bits).high >= most)


def number(value: int) -> str:
    """A constant of any integer type; C's most negative number can't be written as one."""
    return f"(-{-(value + 1)} - 1)" if value == signed(64).low else str(value)
