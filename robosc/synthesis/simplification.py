"""Requirements made shorter by what is known of the states in which they are asked."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.semantics.walks import copied

if TYPE_CHECKING:
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Encoding


def simplified(expression: ex.Expression, states: Diagram, encoding: Encoding) -> ex.Expression:
    """A copy of a boolean expression that has the same value in all of `states`, without the parts that say nothing.

    Each operand is simplified in the states in which it matters beside the other: of two that say the same the first
    stays. Where nothing can be left out the copy is the expression as it stands.
    """
    meaning = encoding.holds(expression)
    if not (states & ~meaning).satisfiable():
        return ex.BooleanLiteral(value=True)
    if not (states & meaning).satisfiable():
        return ex.BooleanLiteral(value=False)
    match expression:
        case ex.Conjunction():
            return _binary(expression, states & encoding.holds(expression.left), states, encoding)
        case ex.Disjunction():
            return _binary(expression, states & ~encoding.holds(expression.left), states, encoding)
        case ex.Implication():
            return _binary(expression, states & encoding.holds(expression.left), states, encoding)
        case ex.Negation():
            return _negated(simplified(expression.operand, states, encoding))
        case ex.Conditional():
            return _conditional(expression, states, encoding)
    return copied(expression)


def _binary(
    expression: ex.BinaryExpression, states_for_right: Diagram, states: Diagram, encoding: Encoding
) -> ex.Expression:
    right = simplified(expression.right, states_for_right, encoding)
    decides = encoding.holds(right)
    left = simplified(
        expression.left, states & (decides if isinstance(expression, ex.Conjunction) else ~decides), encoding
    )
    # The whole is neither true nor false everywhere: at most one operand is constant, and it never decides.
    if isinstance(left, ex.BooleanLiteral):
        return right
    if isinstance(right, ex.BooleanLiteral):
        return _negated(left) if isinstance(expression, ex.Implication) else left
    return type(expression)(left=left, right=right, source=expression.source)


def _conditional(expression: ex.Conditional, states: Diagram, encoding: Encoding) -> ex.Expression:
    condition = simplified(expression.condition, states, encoding)
    if isinstance(condition, ex.BooleanLiteral):
        return simplified(expression.then if condition.value else expression.otherwise, states, encoding)
    chosen = encoding.holds(condition)
    return ex.Conditional(
        condition=condition,
        then=simplified(expression.then, states & chosen, encoding),
        otherwise=simplified(expression.otherwise, states & ~chosen, encoding),
        source=expression.source,
    )


def _negated(expression: ex.Expression) -> ex.Expression:
    return expression.operand if isinstance(expression, ex.Negation) else ex.Negation(operand=expression)
