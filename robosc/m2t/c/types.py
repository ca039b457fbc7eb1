"""How values of an sct model are stored in C: in the smallest type that holds them."""

from __future__ import annotations

from robosc.metamodel import expression as ex
from robosc.semantics.domains import Interval, domain


def signed(bits: int) -> Interval:
    """What a signed integer of so many bits holds."""
    return Interval(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def unsigned(bits: int) -> Interval:
    """What an unsigned integer of so many bits holds."""
    return Interval(0, 2**bits - 1)


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
    return "bool" if isinstance(kind, ex.BooleanType) else storage(domain(kind))


def index_type(count: int) -> str:
    """The C type that stores a position among so many."""
    return storage(Interval(0, max(count, 1)))


def unsigned_type(most: int) -> str:
    """The C type that stores a number up to `most` and mixes with `unsigned` ones."""
    return next(f"uint{bits}_t" for bits in (8, 16, 32) if unsigned(bits).high >= most)


def number(value: int) -> str:
    """A constant of any integer type; C's most negative number can't be written as one."""
    return f"(-{-(value + 1)} - 1)" if value == signed(64).low else str(value)
