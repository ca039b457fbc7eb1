"""Expressions of a robot model that the ROS node evaluates, over its variables, the state and the data at hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc, rosgraph, sct
from robosc.semantics.operators import Rule, operator_of
from robosc.semantics.typing import DOUBLE, Types
from robosc.semantics.walks import fold, with_operands

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.m2m.enumerations import Enumerations
    from robosc.m2m.trace import Trace
    from robosc.semantics.instances import Instance, InstanceVariable


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
        self._types = Types()

    def __call__(
        self,
        expression: ex.Expression,
        within: Instance | None,
        data: Callable[[Sequence[robosc.AccessSegment]], ex.Expression] | None = None,
    ) -> ex.Expression:
        """The expression on the node's side; `within` is the instance whose text it is.

        `data` says what `value` with its segments means where the expression stands.
        """

        def translated(original: ex.Expression, operands: list[ex.Expression]) -> ex.Expression:
            if isinstance(original, robosc.Access):
                return self._access(original, within, data)
            row = operator_of(original)
            if row is None:
                return type(original)(value=original.value)  # type: ignore[attr-defined,call-arg]
            if row.rule is Rule.DOUBLE or (
                row.rule in {Rule.ORDERING, Rule.EQUALITY, Rule.ARITHMETIC}
                and DOUBLE in [self._types(operand) for operand in operands]
            ):
                operands = [self.as_double(operand) for operand in operands]
            return with_operands(original, operands)

        return fold(translated, expression)

    def as_double(self, expression: ex.Expression) -> ex.Expression:
        """The expression itself where it is a double, else its conversion."""
        if self._types(expression) == DOUBLE:
            return expression
        if isinstance(expression, ex.IntegerLiteral):
            return ex.DoubleLiteral(value=float(expression.value))
        return ex.DoubleConversion(operand=expression)

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
