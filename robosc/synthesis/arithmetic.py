"""Exact integer arithmetic on vectors of decision diagrams.

A vector holds the bits of an integer in two's complement, least significant first; the last bit is the sign. A vector
is as wide as its values need, so nothing overflows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.synthesis.bdd import Diagram, Diagrams

Vector: TypeAlias = "tuple[Diagram, ...]"


def constant(diagrams: Diagrams, value: int) -> Vector:
    """Return the vector of a constant."""
    width = (value if value >= 0 else ~value).bit_length() + 1
    return tuple(diagrams.true if value >> bit & 1 else diagrams.false for bit in range(width))


def value_of(vector: Vector) -> int | None:
    """Return the value of a constant vector, or None if the vector depends on the state."""
    if not all(bit.valid() or not bit.satisfiable() for bit in vector):
        return None
    *bits, sign = (int(bit.valid()) for bit in vector)
    return sum(bit << place for place, bit in enumerate(bits)) - (sign << len(bits))


def choose(condition: Diagram, then: Vector, otherwise: Vector) -> Vector:
    """Return `then` in the states of the condition and `otherwise` elsewhere."""
    return _trimmed([condition.ite(a, b) for a, b in zip(*_aligned(then, otherwise), strict=True)])


def add(left: Vector, right: Vector) -> Vector:
    """Return the sum of two vectors."""
    return _sum(left, right, _false(left))


def negate(vector: Vector) -> Vector:
    """Return the negated value."""
    return subtract((_false(vector),), vector)


def subtract(left: Vector, right: Vector) -> Vector:
    """Return the difference."""
    return _sum(left, tuple(~bit for bit in right), ~_false(left))


def multiply(left: Vector, right: Vector) -> Vector:
    """Return the product: the sum of shifted copies of `left`, the copy of the sign bit subtracted."""
    false = _false(left)
    result: Vector = (false,)
    for place, bit in enumerate(right):
        shifted = (*(false for _ in range(place)), *(bit & other for other in left))
        result = add(result, shifted) if place < len(right) - 1 else subtract(result, shifted)
    return result


def equal(left: Vector, right: Vector) -> Diagram:
    """Return the states in which both vectors have the same value."""
    result = None
    for a, b in zip(*_aligned(left, right), strict=True):
        same = a.equiv(b)
        result = same if result is None else same & result
    assert result is not None
    return result


def less(left: Vector, right: Vector) -> Diagram:
    """Return the states in which the left value is smaller than the right one."""
    (*lefts, left_sign), (*rights, right_sign) = _aligned(left, right)
    result = _false(left)
    for a, b in zip(lefts, rights, strict=True):
        result = a.equiv(b).ite(result, b)
    return left_sign.equiv(right_sign).ite(result, left_sign)


def _false(vector: Vector) -> Diagram:
    return vector[0] & ~vector[0]


def _sum(left: Vector, right: Vector, carry: Diagram) -> Vector:
    width = max(len(left), len(right)) + 1
    bits = []
    for a, b in zip(_widen(left, width), _widen(right, width), strict=True):
        either = a ^ b
        bits.append(either ^ carry)
        carry = either.ite(carry, a)
    return _trimmed(bits)


def _aligned(left: Vector, right: Vector) -> tuple[Vector, Vector]:
    width = max(len(left), len(right))
    return _widen(left, width), _widen(right, width)


def _widen(vector: Vector, width: int) -> Vector:
    return (*vector, *(vector[-1] for _ in range(width - len(vector))))


def _trimmed(bits: Sequence[Diagram]) -> Vector:
    width = len(bits)
    while width > 1 and bits[width - 1] == bits[width - 2]:
        width -= 1
    return tuple(bits[:width])
