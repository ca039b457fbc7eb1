"""Initial values: folded to one literal, or the default that the language gives."""

import math

from robosc.metamodel import expression as ex
from robosc.metamodel import robosc
from robosc.semantics.evaluation import Value, evaluate, saturate


def initial_value(variable: robosc.Variable) -> Value:
    """The first value of a variable; an enum's value is its EnumValue.

    The variable's type is basic or an enum, and its initial expression is constant (rules `variable-type`, `type`).
    """
    kind = variable.type
    value = _default(kind) if variable.initial is None else evaluate(variable.initial, _enum_value)
    if isinstance(kind, robosc.IntegerDataType) and isinstance(value, int):
        return saturate(value, kind.minimum, kind.maximum)
    return value


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


def _enum_value(access: ex.Expression) -> Value:
    assert isinstance(access, robosc.Access)
    return access.item


def _default(kind: robosc.DataType) -> Value:
    match kind:
        case robosc.BooleanDataType():
            return False
        case robosc.IntegerDataType():
            return 0
        case robosc.DoubleDataType():
            return 0.0
        case robosc.StringDataType():
            return ""
    assert isinstance(kind, robosc.ComplexDataTypeReference)
    assert isinstance(kind.type, robosc.EnumDataType)
    return default_value(kind.type)
