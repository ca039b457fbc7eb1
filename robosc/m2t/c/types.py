"""How values of an engine model are stored in C, and how its constants are written."""

from __future__ import annotations

from robosc.metamodel import expression as ex
from robosc.semantics.domains import Width, domain, storage


def integer_type(bits: int, *, signed: bool) -> str:
    """The type of <stdint.h> of a width."""
    return f"{'' if signed else 'u'}int{bits}_t"


def type_name(kind: ex.Type) -> str:
    """The C type that stores a value of a type of an sct or engine model."""
    if isinstance(kind, ex.BooleanType):
        return "bool"
    width = storage(domain(kind))
    return integer_type(width.bits, signed=width.signed)


def unsigned_type(most: int) -> str:
    """The C type that stores a number up to `most` and mixes with `unsigned` ones."""
    return next(f"uint{bits}_t" for bits in (8, 16, 32) if Width(bits, signed=False).values.high >= most)


def number(value: int) -> str:
    """A constant of any integer type; C's most negative number can't be written as one."""
    return f"(-{-(value + 1)} - 1)" if value == -(2**63) else str(value)
