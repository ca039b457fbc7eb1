"""Translates expressions of a robot model for its sct model and for the ROS node."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.m2m.tabulation import TooLargeError, tabulate
from robosc.model import expression as ex
from robosc.model import robosc, rosgraph, sct
from robosc.model.places import place
from robosc.model.semantics.communication import RUNNING
from robosc.model.semantics.cone_of_influence import accesses, expanded_for, read_data
from robosc.model.semantics.evaluation import Value, evaluate, literal
from robosc.model.semantics.instances import PortInstance
from robosc.model.semantics.naming import Names
from robosc.model.semantics.operators import COMPARISONS, FUNCTIONS, TypeRule, operator_of
from robosc.model.semantics.printing import conjunction, disjunction
from robosc.model.semantics.typing import DOUBLE, STRING, ArrayType, ObjectType, Types, declared_type
from robosc.model.semantics.walks import fold, operands, with_operands

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.m2m.declarations import Declarations
    from robosc.m2m.trace import Trace
    from robosc.model.semantics.cone_of_influence import Carrier, InputRead
    from robosc.model.semantics.instances import Instance, InstanceParameter, InstanceVariable

    #: Translates an access with segments, whose indices are translated already. Returns the expression and the type of
    #: its value.
    Wire = Callable[
        [robosc.DataType, Instance | None, Sequence[str], robosc.Access, Sequence[ex.Expression]],
        tuple[ex.Expression, robosc.DataType],
    ]


class ReceivedValue(NamedTuple):
    """Meaning of `value` at the place of an expression: data of a type, below some fields of the received message.

    `within` is the instance that declares the type.
    """

    type: robosc.DataType
    within: Instance | None = None
    fields: Sequence[str] = ()


class _Expressions:
    """Common part of both translations: states, variables and enum values become references; literals stay."""

    def __init__(
        self,
        trace: Trace,
        declarations: Declarations,
        variables: Mapping[InstanceVariable, rosgraph.NodeVariable],
        parameters: Mapping[InstanceParameter, rosgraph.Parameter],
    ) -> None:
        self._trace = trace
        self._declarations = declarations
        self._variables = variables
        self._parameters = parameters
        self._types = Types()

    def _reference(self, access: robosc.Access, within: Instance | None) -> ex.Expression:
        instances = self._trace.instances
        if isinstance(access.item, robosc.State):
            instance = instances.instance_of(access, within)
            assert instance is not None
            return sct.LocationReference(location=self._trace.locations[instance, access.item])
        if isinstance(access.item, robosc.RequirementState):
            locations = self._trace.requirement_locations
            own = locations.get((within, access.item))
            return sct.LocationReference(location=own or locations[None, access.item])
        if isinstance(access.item, robosc.CommunicationType):
            instance = instances.instance_of(access, within)
            assert instance is not None
            plant = self._trace.plants[PortInstance(instance, access.item)]
            running = (location for location in plant.locations if location.name in RUNNING)
            either = disjunction(sct.LocationReference(location=location) for location in running)
            assert either is not None
            return either
        if isinstance(access.item, robosc.Parameter):
            return rosgraph.NodeVariableReference(variable=self._parameters[instances.parameter(access, within)])
        if isinstance(access.item, robosc.EnumValue):
            return ex.EnumerationLiteralReference(literal=self._declarations.literal(access.item))
        owned = instances.variable(access, within)
        assert owned is not None
        if owned in self._trace.variables:
            return sct.VariableReference(variable=self._trace.variables[owned])
        return rosgraph.NodeVariableReference(variable=self._variables[owned])

    def _some(self, expressions: Sequence[ex.Expression], *kinds: object) -> bool:
        return any(self._types(expression) in kinds for expression in expressions)


class SctExpressions(_Expressions):
    """Translates expressions that the supervisor needs. The elements that they read are in the trace already."""

    def __init__(self, trace: Trace) -> None:
        super().__init__(trace, trace.declarations, {}, {})

    def __call__(
        self,
        expression: ex.Expression,
        within: Instance | None,
        carrier: Carrier | None = None,
        assigned: InstanceVariable | None = None,
    ) -> ex.Expression:
        """Translate a condition, or the value that a transition assigns to a variable.

        The expression may read the data of the carrier's event. `within` is the instance whose text contains it.
        Raises ModelError if a comparison of doubles has too many cases.
        """
        written = expanded_for(self._trace.instances, expression, within, carrier)
        readings = list(read_data(self._trace.instances, written, within, carrier, assigned))
        inputs = [reading for reading in readings if reading.source is not None and not reading.is_readable]
        translated = self._translated(written, within, {reading.part: self._input(reading) for reading in inputs})
        demanded = [reading for reading in readings if reading.is_readable]
        present = conjunction(sct.InputReference(input=self._input(reading)) for reading in demanded)
        if present is None or assigned is None:
            return translated
        # An assignment without a readable value does not happen.
        unchanged = sct.VariableReference(variable=self._trace.variables[assigned])
        return ex.Conditional(condition=present, then=translated, otherwise=unchanged)

    def _translated(
        self, written: ex.Expression, within: Instance | None, inputs: Mapping[ex.Expression, sct.Input]
    ) -> ex.Expression:
        """Translate an expanded expression. Some of its parts are inputs."""

        def translated(original: ex.Expression, operands: list[ex.Expression]) -> ex.Expression:
            if original in inputs:
                return sct.InputReference(input=inputs[original])
            if isinstance(original, robosc.Access):
                return self._reference(original, within)
            if isinstance(original, ex.Conditional):
                return with_operands(original, operands)
            row = operator_of(original)
            if row is None:
                return type(original)(value=original.value)  # type: ignore[attr-defined,call-arg]
            if isinstance(original, ex.FunctionCall) and next(accesses(original), None) is None:
                return literal(evaluate(original, _no_name))
            copy = with_operands(original, operands)
            is_table = isinstance(copy, COMPARISONS) and self._some(operands, DOUBLE, STRING)
            return _table(copy, original) if is_table else copy

        return fold(translated, written, lambda part: () if part in inputs else operands(part))

    def _input(self, reading: InputRead) -> sct.Input:
        assert reading.source is not None
        return self._trace.inputs[reading.source]


class NodeExpressions(_Expressions):
    """Translates expressions and makes every conversion from integer to double explicit.

    `variables` are the variables that only the node needs, `parameters` the parameters that are set on the robot.
    `wire` translates reads of ROS data.
    """

    def __init__(
        self,
        trace: Trace,
        declarations: Declarations,
        variables: Mapping[InstanceVariable, rosgraph.NodeVariable],
        parameters: Mapping[InstanceParameter, rosgraph.Parameter],
        wire: Wire,
    ) -> None:
        super().__init__(trace, declarations, variables, parameters)
        self._wire = wire

    def __call__(
        self, expression: ex.Expression, within: Instance | None, data: ReceivedValue | None = None
    ) -> ex.Expression:
        """Translate an expression for the node. `within` is its instance, `data` the meaning of `value`."""
        names = Names()
        quantifiers: dict[robosc.ArrayElement, rosgraph.ArrayQuantifier] = {}
        reached: dict[ex.Expression, tuple[robosc.DataType, Instance | None]] = {}

        def access(original: robosc.Access, indices: list[ex.Expression]) -> ex.Expression:
            element = original.item
            if isinstance(element, robosc.ArrayElement):
                array, declaring = reached[element.eContainer().array]
                assert isinstance(array, robosc.Array)
                expression, kind = self._wire(array.type, declaring, (), original, indices)
                if element not in quantifiers:
                    quantifiers[element] = rosgraph.ArrayQuantifier(name=names.fresh(element.name))
                _start(expression).quantifier = quantifiers[element]
            elif original.value:
                assert data is not None
                declaring = data.within
                expression, kind = self._wire(data.type, declaring, data.fields, original, indices)
            else:
                owned = self._trace.instances.variable(original, within)
                if owned is None or not isinstance(declared_type(owned.type), ArrayType | ObjectType):
                    return self._reference(original, within)
                declaring = owned.instance
                expression, kind = self._wire(owned.type, declaring, (), original, indices)
                _start(expression).variable = self._variables[owned]
            reached[original] = kind, declaring
            return expression

        def translated(original: ex.Expression, operands: list[ex.Expression]) -> ex.Expression:
            if isinstance(original, robosc.Access):
                return access(original, operands)
            if isinstance(original, robosc.ErrorReason):
                assert original.enumeration is not None
                return rosgraph.ErrorReason(enumeration=self._declarations.enumeration(original.enumeration))
            if isinstance(original, robosc.ArrayQuantifier):
                quantifier = quantifiers.get(original.element) or rosgraph.ArrayQuantifier(
                    name=names.fresh(original.element.name)
                )
                quantifier.quantifier = getattr(rosgraph.Quantifier, str(original.quantifier))
                array, quantifier.body = operands
                assert isinstance(array, rosgraph.WireAccess)
                quantifier.array = array
                return quantifier
            return self._operation(original, operands)

        return fold(translated, self._trace.instances.expanded(expression, within))

    def _operation(self, original: ex.Expression, operands: list[ex.Expression]) -> ex.Expression:
        if isinstance(original, ex.Conditional):
            return with_operands(original, operands)
        row = operator_of(original)
        if row is None:
            return type(original)(value=original.value)  # type: ignore[attr-defined,call-arg]
        mixed = {TypeRule.ORDERING, TypeRule.EQUALITY, TypeRule.ARITHMETIC}
        if row.rule is TypeRule.DOUBLE or (row.rule in mixed and self._some(operands, DOUBLE)):
            operands = [self.as_double(operand) for operand in operands]
        if row is FUNCTIONS["double"]:
            return operands[0]
        return with_operands(original, operands)

    def as_double(self, expression: ex.Expression) -> ex.Expression:
        """Return the expression itself if it is a double, else its conversion."""
        if self._types(expression) == DOUBLE:
            return expression
        if isinstance(expression, ex.IntegerLiteral):
            return ex.DoubleLiteral(value=float(expression.value))
        return ex.DoubleConversion(operand=expression)


def _no_name(reference: ex.Expression) -> Value:
    raise TypeError(f"{type(reference).__name__} in a constant")


def _start(reference: ex.Expression) -> rosgraph.WireAccess:
    """Return the access to the data: the expression itself, or the argument of a conversion."""
    access = reference.argument if isinstance(reference, rosgraph.ConversionCall) else reference
    assert isinstance(access, rosgraph.WireAccess)
    return access


def _table(comparison: ex.Expression, original: ex.Expression) -> ex.Expression:
    try:
        return tabulate(comparison)
    except TooLargeError as error:
        finding = Diagnostic(
            *place(original),
            severity=Severity.ERROR,
            rule="integer-range",
            message=f"this comparison of doubles or strings depends on {error}, too many to tabulate",
            hint="compare integers, or give the integers smaller ranges",
        )
        raise ModelError([finding]) from error
