"""CIF's types as far as generated specifications have them, and what its operators make of them.

By CIF's language reference and tutorial, and not by what is generated. A type is BOOLEAN, an enumeration, or for
integers the range of the values that an expression may have.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

from robosc.metamodel import expression as ex

if TYPE_CHECKING:
    from collections.abc import Mapping

BOOLEAN: Final = "bool"
#: CIF's integers have 32 bits.
LARGEST = 2**31 - 1
Type: TypeAlias = str | range | ex.Enumeration

OPERATORS: Mapping[str, type[ex.BinaryExpression]] = {
    "=>": ex.Implication,
    "<=>": ex.Equation,
    "or": ex.Disjunction,
    "and": ex.Conjunction,
    "=": ex.Equation,
    "!=": ex.Inequation,
    "<": ex.LessThan,
    "<=": ex.LessOrEqual,
    ">": ex.GreaterThan,
    ">=": ex.GreaterOrEqual,
    "+": ex.Addition,
    "-": ex.Subtraction,
}


def shown(kind: Type) -> str:
    """A type as CIF writes it."""
    match kind:
        case range():
            return f"int[{kind.start}..{kind.stop - 1}]"
        case ex.Enumeration():
            return str(kind.name)
    return str(kind)


def compatible(one: Type, other: Type) -> bool:
    """Whether values of the types can be compared, and be alternatives of each other: ranges don't matter for that."""
    if isinstance(one, ex.Enumeration) and isinstance(other, ex.Enumeration):
        return [literal.name for literal in one.literals] == [literal.name for literal in other.literals]
    return isinstance(one, range) and isinstance(other, range) if isinstance(one, range) else one == other


def combined(operator: str, left: Type, right: Type) -> Type:
    """The type of a binary expression. Raises TypeError, saying why there is none."""
    if operator in ("=>", "<=>", "or", "and"):
        fits = left == right == BOOLEAN
    elif operator in ("=", "!="):
        fits = compatible(left, right)
    else:
        fits = isinstance(left, range) and isinstance(right, range)
    if not fits:
        raise TypeError(f"'{operator}' does not apply to {shown(left)} and {shown(right)}")
    if not isinstance(left, range) or not isinstance(right, range) or operator not in ("+", "-"):
        return BOOLEAN
    low, high = right.start, right.stop - 1
    made = range(left.start + low, left.stop + high) if operator == "+" else range(left.start - high, left.stop - low)
    if made.start < -LARGEST - 1 or made.stop - 1 > LARGEST:
        raise TypeError(f"'{operator}' of {shown(left)} and {shown(right)} could overflow")
    return made


def joined(one: Type, other: Type) -> Type:
    """The type of something that is one or the other. Raises TypeError where they are not compatible."""
    if not compatible(one, other):
        raise TypeError(f"the alternatives are {shown(one)} and {shown(other)}")
    if isinstance(one, range) and isinstance(other, range):
        return range(min(one.start, other.start), max(one.stop, other.stop))
    return one


def overlap(variable: Type, value: Type) -> bool:
    """Whether a variable can be assigned some of the values."""
    if isinstance(variable, range) and isinstance(value, range):
        return variable.start < value.stop and value.start < variable.stop
    return compatible(variable, value)


def contains(variable: Type, value: Type) -> bool:
    """Whether a variable can have all of the values."""
    if isinstance(variable, range) and isinstance(value, range):
        return variable.start <= value.start and value.stop <= variable.stop
    return compatible(variable, value)
