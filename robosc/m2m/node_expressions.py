"""Expressions of a robot model that the ROS node evaluates, over its variables, the state and the data at hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc, rosgraph, sct
from robosc.metamodel.expression_types import is_double

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.m2m.enumerations import Enumerations
    from robosc.m2m.trace import Trace
    from robosc.semantics.instances import Instance, InstanceVariable

_NUMERIC = (ex.Addition, ex.Subtraction, ex.Multiplication)
_COMPARISONS = (
    ex.Equation,
    ex.Inequation,
    ex.LessThan,
    ex.LessOrEqual,
    ex.GreaterThan,
    ex.GreaterOrEqual,
)


class NodeExpressions:
    """Translates expressions and makes every conversion from integer to double explicit.

    `variables` are the node's own, those that the supervisor does not need.
    """

    def __init__(
        self,
        trace: Trace,
        variables: Mapping[InstanceVariable, rosgraph.NodeVariable],
        enumerations: Enumerations,
    ) -> None:
        self._trace = trace
        self._variables = variables
        self._enumerations = enumerations

    def __call__(
        self,
        expression: ex.Expression,
        within: Instance | None,
        data: Callable[[Sequence[robosc.AccessSegment]], ex.Expression] | None = None,
    ) -> ex.Expression:
        """The expression on the node's side; `within` is the instance whose text it is.

        `data` says what `value` with its segments means where the expression stands.
        """
        return self.translated(expression, within, data)

    def translated(
        self,
        expression: ex.Expression,
        within: Instance | None,
        data: Callable[[Sequence[robosc.AccessSegment]], ex.Expression] | None = None,
    ) -> ex.Expression:
        """The same, by a call that takes none of the C stack."""
        match expression:
            case robosc.Access():
                return self._access(expression, within, data)
            case ex.BooleanLiteral() | ex.IntegerLiteral() | ex.DoubleLiteral() | ex.StringLiteral():
                return type(expression)(value=expression.value)  # type: ignore[arg-type]
            case ex.UnaryExpression():
                return type(expression)(operand=self.translated(expression.operand, within, data))
        assert isinstance(expression, ex.BinaryExpression)
        left, right = self.translated(expression.left, within, data), self.translated(expression.right, within, data)
        if isinstance(expression, (*_NUMERIC, *_COMPARISONS, ex.Division)):
            double = isinstance(expression, ex.Division) or is_double(left) or is_double(right)
            if double:
                left, right = as_double(left), as_double(right)
        return type(expression)(left=left, right=right)

    def _access(
        self,
        access: robosc.Access,
        within: Instance | None,
        data: Callable[[Sequence[robosc.AccessSegment]], ex.Expression] | None,
    ) -> ex.Expression:
        if access.value:
            assert data is not None
            return data(access.segments)
        instances = self._trace.instances
        if isinstance(access.item, robosc.State):
            instance = instances.instance(access.component, within)
            assert instance is not None
            return sct.LocationReference(location=self._trace.locations[instance, access.item])
        if isinstance(access.item, robosc.EnumValue):
            return ex.EnumerationLiteralReference(literal=self._enumerations.literal(access.item))
        owned = instances.variable(access, within)
        assert owned is not None
        if owned in self._trace.variables:
            return sct.VariableReference(variable=self._trace.variables[owned])
        return rosgraph.NodeVariableReference(variable=self._variables[owned])


def as_double(expression: ex.Expression) -> ex.Expression:
    """The expression itself where it is a double, else its conversion."""
    if is_double(expression):
        return expression
    if isinstance(expression, ex.IntegerLiteral):
        return ex.DoubleLiteral(value=float(expression.value))
    return ex.DoubleConversion(operand=expression)
