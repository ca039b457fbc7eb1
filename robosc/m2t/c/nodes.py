"""Conditions put together from expressions of a model without moving these out of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from robosc.metamodel import expression as ex
from robosc.metamodel import sct
from robosc.semantics.walks import operands

if TYPE_CHECKING:
    from collections.abc import Sequence

COMPARISONS = (
    ex.Equation,
    ex.Inequation,
    ex.LessThan,
    ex.LessOrEqual,
    ex.GreaterThan,
    ex.GreaterOrEqual,
)
_LOGICAL = (ex.Implication, ex.Disjunction, ex.Conjunction, ex.Negation, ex.BooleanLiteral, sct.LocationReference)


@dataclass(frozen=True, eq=False)
class All:
    """A conjunction of any number of conditions; of none: true."""

    parts: Sequence[Node]


@dataclass(frozen=True, eq=False)
class Some:
    """A disjunction of any number of conditions; of none: false."""

    parts: Sequence[Node]


@dataclass(frozen=True)
class Not:
    """A negation."""

    operand: Node


#: An expression, or conditions put together from several without moving them out of their model.
Node = ex.Expression | All | Some | Not


class Junction(NamedTuple):
    """A conjunction (`neutral` is true) or disjunction (false), and its parts, none of which is of the same kind."""

    neutral: bool
    parts: list[Node]


def junction(node: Node) -> Junction | None:
    """A node as conjunction or disjunction, an implication as `not left or right`; None of anything else."""
    match node:
        case All():
            return _junction(True, node.parts)
        case ex.Conjunction():
            return _junction(True, [node.left, node.right])
        case Some():
            return _junction(False, node.parts)
        case ex.Disjunction():
            return _junction(False, [node.left, node.right])
        case ex.Implication():
            return _junction(False, [Not(node.left), node.right])
    return None


def _junction(neutral: bool, parts: Sequence[Node]) -> Junction:
    nested = [(part, junction(part)) for part in parts]
    return Junction(
        neutral,
        [each for part, inner in nested for each in (inner.parts if inner and inner.neutral is neutral else [part])],
    )


def children_of(node: Node) -> list[Node]:
    """The operands of an expression, from left to right."""
    match node:
        case All() | Some():
            return list(node.parts)
        case Not():
            return [node.operand]
    return list(operands(node))


def is_condition(node: Node) -> bool:
    """Whether the value is a boolean."""
    match node:
        case All() | Some() | Not():
            return True
        case sct.VariableReference():
            return isinstance(node.variable.type, ex.BooleanType)
        case sct.InputReference():
            return isinstance(node.input.type, ex.BooleanType)
        case ex.Conditional():
            return is_condition(node.then)
    return isinstance(node, (*_LOGICAL, *COMPARISONS))
