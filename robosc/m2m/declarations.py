"""Types, enumerations and initial values of a robot model in the models that are made of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc
from robosc.semantics.evaluation import Value, evaluate, saturate
from robosc.semantics.naming import Names

if TYPE_CHECKING:
    from robosc.metamodel import rosgraph, sct

#: The type that becomes of a basic type without bounds, and the value of a variable without initial one.
_BASIC: dict[type[robosc.DataType], tuple[type[ex.Type], Value]] = {
    robosc.BooleanDataType: (ex.BooleanType, False),
    robosc.IntegerDataType: (ex.IntegerType, 0),
    robosc.DoubleDataType: (ex.DoubleType, 0.0),
    robosc.StringDataType: (ex.StringType, ""),
}


class Declarations:
    """The types of one model, whose enumerations (thesis listing 5.6) it owns and that are made when first asked for.

    Enumerations of `others`, of the model that it refers to, are not made again.
    """

    def __init__(
        self, owner: sct.SupervisoryControlModel | rosgraph.RosGraph, others: Declarations | None = None
    ) -> None:
        self._owner = owner
        self.enumerations: dict[robosc.EnumDataType, ex.Enumeration] = {}
        self.literals: dict[robosc.EnumValue, ex.EnumerationLiteral] = {}
        if others is not None:
            self.enumerations |= others.enumerations
            self.literals |= others.literals
        self._names = Names(enumeration.name for enumeration in self.enumerations.values())

    def type(self, declared: robosc.DataType) -> ex.Type:
        """The type of a variable or of data, which is basic or an enum (rule `variable-type`)."""
        if isinstance(declared, robosc.IntegerDataType):
            return ex.IntegerType(minimum=declared.minimum, maximum=declared.maximum)
        if type(declared) in _BASIC:
            return _BASIC[type(declared)][0]()
        return ex.EnumerationType(enumeration=self.enumeration(_enum(declared)))

    def enumeration(self, enum: robosc.EnumDataType) -> ex.Enumeration:
        """The enumeration of an enum."""
        if enum not in self.enumerations:
            enumeration = ex.Enumeration(name=self._names.fresh(enum.name), source=enum.source)
            for rule in enum.rules:
                literal = ex.EnumerationLiteral(name=rule.value.name, source=rule.value.source)
                enumeration.literals.append(literal)
                self.literals[rule.value] = literal
            self._owner.enumerations.append(enumeration)
            self.enumerations[enum] = enumeration
        return self.enumerations[enum]

    def literal(self, value: robosc.EnumValue) -> ex.EnumerationLiteral:
        """The literal of an enum value."""
        self.enumeration(value.eContainer().eContainer())
        return self.literals[value]

    def initial(self, variable: robosc.Variable) -> ex.Expression:
        """The first value of a variable as one literal: its initial expression is constant (rule `type`)."""
        kind = variable.type
        if variable.initial is not None:
            value = evaluate(variable.initial, _enum_value)
        elif type(kind) in _BASIC:
            value = _BASIC[type(kind)][1]
        else:
            value = default_value(_enum(kind))
        if isinstance(kind, robosc.IntegerDataType) and isinstance(value, int):
            value = saturate(value, kind.minimum, kind.maximum)
        return literal(self.literal(value) if isinstance(value, robosc.EnumValue) else value)


def literal(value: Value) -> ex.Expression:
    """The expression that stands for a value, with a minus sign where it is negative.

    What no literal stands for is a division by zero, as it was in the text.
    """
    if isinstance(value, bool):
        return ex.BooleanLiteral(value=value)
    if isinstance(value, float) and not math.isfinite(value):
        dividend = 0.0 if math.isnan(value) else math.copysign(1.0, value)
        return ex.Division(left=literal(dividend), right=ex.DoubleLiteral(value=0.0))
    if isinstance(value, (int, float)):
        kind = ex.IntegerLiteral if isinstance(value, int) else ex.DoubleLiteral
        magnitude: ex.Expression = kind(value=abs(value))  # type: ignore[arg-type]
        return ex.UnaryMinus(operand=magnitude) if value < 0 else magnitude
    if isinstance(value, str):
        return ex.StringLiteral(value=value)
    assert isinstance(value, ex.EnumerationLiteral)
    return ex.EnumerationLiteralReference(literal=value)


def default_value(enum: robosc.EnumDataType) -> robosc.EnumValue:
    """The value of an enum's default rule."""
    return next(rule.value for rule in enum.rules if isinstance(rule, robosc.EnumDefaultRule))


def _enum(declared: robosc.DataType) -> robosc.EnumDataType:
    assert isinstance(declared, robosc.ComplexDataTypeReference)
    assert isinstance(declared.type, robosc.EnumDataType)
    return declared.type


def _enum_value(access: ex.Expression) -> Value:
    assert isinstance(access, robosc.Access)
    return access.item
