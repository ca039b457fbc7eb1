"""Expressions of a robot model as expressions of its sct model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.m2m.tabulation import TooLargeError, tabulate
from robosc.metamodel import expression as ex
from robosc.metamodel import robosc, sct
from robosc.metamodel.places import place
from robosc.semantics.cone_of_influence import Data, property_path
from robosc.semantics.evaluation import evaluate
from robosc.semantics.operators import COMPARISONS
from robosc.semantics.typing import DOUBLE, Types
from robosc.semantics.walks import fold, parts, with_operands

if TYPE_CHECKING:
    from robosc.m2m.trace import Trace
    from robosc.semantics.instances import Instance


class SctExpressions:
    """Translates the expressions that the supervisor needs; what they read is in the trace already."""

    def __init__(self, trace: Trace) -> None:
        self._trace = trace
        self._types = Types()

    def condition(self, expression: ex.Expression, within: Instance | None) -> ex.Expression:
        """A guard, a requirement, or a condition of provided data; `within` is the instance whose text it is."""
        return self._translate(expression, within, None)

    def value(self, expression: ex.Expression, within: Instance, transition: robosc.Transition) -> ex.Expression:
        """The right-hand side of an assignment of a transition, whose event's data it may read."""
        return self._translate(expression, within, transition)

    def _translate(
        self, expression: ex.Expression, within: Instance | None, transition: robosc.Transition | None
    ) -> ex.Expression:
        def translated(original: ex.Expression, operands: list[ex.Expression]) -> ex.Expression:
            match original:
                case robosc.Access():
                    return self._access(original, within, transition)
                case ex.BooleanLiteral() | ex.IntegerLiteral() | ex.DoubleLiteral() | ex.StringLiteral():
                    return type(original)(value=original.value)  # type: ignore[arg-type]
                case ex.Equation() | ex.Inequation() if isinstance(original.left, ex.StringLiteral):
                    # The supervisor needs no string, so that both sides are constants.
                    return ex.BooleanLiteral(value=bool(evaluate(original, lambda reference: reference)))
            made = with_operands(original, operands)
            if isinstance(made, COMPARISONS) and DOUBLE in [self._types(operand) for operand in operands]:
                return self._tabulate(made, original)
            return made

        return fold(translated, expression)

    def _access(
        self, access: robosc.Access, within: Instance | None, transition: robosc.Transition | None
    ) -> ex.Expression:
        instances = self._trace.instances
        if access.value:
            assert isinstance(transition, robosc.ResultTransition)
            port = instances.port(transition.communicationType, within)
            path = property_path(access)
            assert port is not None
            assert path is not None
            return sct.InputReference(input=self._trace.inputs[Data(port, transition.resultType, path)])
        if isinstance(access.item, robosc.State):
            instance = instances.instance(access.component, within)
            assert instance is not None
            return sct.LocationReference(location=self._trace.locations[instance, access.item])
        if isinstance(access.item, robosc.EnumValue):
            return ex.EnumerationLiteralReference(literal=self._trace.enumerations.literal(access.item))
        owned = instances.variable(access, within)
        assert owned is not None
        return sct.VariableReference(variable=self._trace.variables[owned])

    def _tabulate(self, comparison: ex.Expression, original: ex.Expression) -> ex.Expression:
        references = list({_declaration(reference): reference for reference in _references(comparison)}.values())
        try:
            return tabulate(comparison, references, [_range(reference) for reference in references], _copy)
        except TooLargeError as error:
            file, span = place(original)
            raise ModelError(
                [
                    Diagnostic(
                        file=file,
                        span=span,
                        severity=Severity.ERROR,
                        rule="integer-range",
                        message=f"this comparison of doubles depends on {error}, too many to tabulate",
                        hint="compare integers, or give the integers smaller ranges",
                    )
                ]
            ) from error


def _references(expression: ex.Expression) -> list[ex.Expression]:
    return [part for part in parts(expression) if isinstance(part, (sct.VariableReference, sct.InputReference))]


def _declaration(reference: ex.Expression) -> sct.DiscreteVariable | sct.Input:
    if isinstance(reference, sct.VariableReference):
        return reference.variable
    assert isinstance(reference, sct.InputReference)
    return reference.input


def _copy(reference: ex.Expression) -> ex.Expression:
    if isinstance(reference, sct.VariableReference):
        return sct.VariableReference(variable=reference.variable)
    assert isinstance(reference, sct.InputReference)
    return sct.InputReference(input=reference.input)


def _range(reference: ex.Expression) -> range:
    kind = _declaration(reference).type
    assert isinstance(kind, ex.IntegerType)
    assert kind.minimum is not None
    assert kind.maximum is not None
    return range(kind.minimum, kind.maximum + 1)
