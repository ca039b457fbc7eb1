"""Simplification of requirements under the states in which they matter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import expression as ex
from robosc.model.semantics.walks import copy_tree, walk

if TYPE_CHECKING:
    from collections.abc import Generator

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Encoding

    #: A part of the expression with the states in which it matters.
    Part = tuple[ex.Expression, Diagram]


def simplify(expression: ex.Expression, states: Diagram, encoding: Encoding) -> ex.Expression:
    """Return a copy of a boolean expression without its redundant parts, equal to it in all of `states`.

    Each operand is simplified in the states in which the other operand does not decide the result. If two operands are
    equivalent, the first stays. If nothing is redundant, the copy is identical to the expression.
    """

    def step(part: Part) -> Generator[Part, ex.Expression, ex.Expression]:
        whole, where = part
        meaning = encoding.holds(whole)
        if not (where & ~meaning).satisfiable():
            return ex.BooleanLiteral(value=True)
        if not (where & meaning).satisfiable():
            return ex.BooleanLiteral(value=False)
        match whole:
            case ex.Negation():
                return _negated((yield whole.operand, where))
            case ex.Conjunction() | ex.Disjunction() | ex.Implication():
                # Simplify the right operand where the left one does not decide, then the left one where the right does
                # not.
                decides = encoding.holds(whole.left)
                right = yield whole.right, where & (~decides if isinstance(whole, ex.Disjunction) else decides)
                decides = encoding.holds(right)
                left = yield whole.left, where & (decides if isinstance(whole, ex.Conjunction) else ~decides)
                # The whole is neither true nor false everywhere. At most one operand is constant, and it never decides.
                if isinstance(left, ex.BooleanLiteral):
                    return right
                if isinstance(right, ex.BooleanLiteral):
                    return _negated(left) if isinstance(whole, ex.Implication) else left
                return type(whole)(left=left, right=right, source=whole.source)
            case ex.Conditional():
                condition = yield whole.condition, where
                if isinstance(condition, ex.BooleanLiteral):
                    return (yield whole.then if condition.value else whole.otherwise, where)
                chosen = encoding.holds(condition)
                then = yield whole.then, where & chosen
                otherwise = yield whole.otherwise, where & ~chosen
                return ex.Conditional(condition=condition, then=then, otherwise=otherwise, source=whole.source)
        return copy_tree(whole)

    return walk(step, (expression, states))


def _negated(expression: ex.Expression) -> ex.Expression:
    return expression.operand if isinstance(expression, ex.Negation) else ex.Negation(operand=expression)
