"""Meaning of the constant data of `provide` statements: the values of the inputs that a command has with them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from robosc.analysis.verify.model_reading.machine import Literal
from robosc.analysis.verify.model_reading.names import Data
from robosc.model import expression as ex
from robosc.model import robosc
from robosc.model.semantics.evaluation import evaluate

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.analysis.verify.model_reading.names import Environment, Names

    #: Basic value, or for an object the values of its fields.
    Sent: TypeAlias = bool | int | float | str | dict[str, "Sent"]

_LITERALS = (ex.BooleanLiteral, ex.IntegerLiteral, ex.DoubleLiteral, ex.StringLiteral)


class _UnknownError(Exception):
    """The value of a part of the data is not known here."""


def constant_data(data: ex.Expression, place: Environment, names: Names) -> Sent | None:
    """Return data that consist of literals and constants; None for other data."""
    match data:
        case robosc.ObjectValue():
            fields: dict[str, Sent] = {}
            for field in data.properties:
                value = constant_data(field.value, place, names)
                if value is None:
                    return None
                fields[field.property.name] = value
            return fields
        case ex.UnaryMinus() if isinstance(data.operand, _LITERALS):
            return names.constant(data, place)  # type: ignore[no-any-return]
        case robosc.Access() if isinstance(data.item, robosc.EnumValue | robosc.Constant):
            return names.constant(data, place)  # type: ignore[no-any-return]
        case _ if isinstance(data, _LITERALS):
            return names.constant(data, place)  # type: ignore[no-any-return]
    return None


def computed_input(part: ex.Expression, sent: Sent, declared: robosc.DataType, names: Names) -> Any:
    """Return the value of an expression over sent data of a declared type; None if this reading does not compute it.

    Fields that the data leave out have their ROS default.
    """

    def value_of(reference: ex.Expression) -> Any:
        target = names.meaning(reference)
        if isinstance(target, Data):
            if target.path is None or target.words[0] != "value":
                raise _UnknownError
            return _field(sent, declared, target.path)
        if isinstance(target, Literal):
            return target
        raise _UnknownError

    try:
        return evaluate(part, value_of)
    except _UnknownError:
        return None


def _field(sent: Sent, declared: robosc.DataType, path: Sequence[str]) -> Any:
    value: Sent | None = sent
    kind: Any = declared
    for name in path:
        named = kind.type if isinstance(kind, robosc.ComplexDataTypeReference) else None
        properties = named.properties if isinstance(named, robosc.ObjectDataType) else ()
        kind = next((field.type for field in properties if field.name == name), None)
        value = value.get(name) if isinstance(value, dict) else None
    if isinstance(value, dict):
        raise _UnknownError
    return _default(kind) if value is None else value


def _default(declared: Any) -> bool | int | float | str:
    match declared:
        case robosc.BooleanDataType():
            return False
        case robosc.IntegerDataType():
            return 0
        case robosc.DoubleDataType():
            return 0.0
        case robosc.StringDataType():
            return ""
    raise _UnknownError
