"""Rule `data-type`: types that no ROS data has, or that cannot be converted back to ROS data."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.language.checks.definitions import circles, communications, of_kind
from robosc.language.checks.edits import Choice, Removal, Replacement
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import carrying_events, sent_type
from robosc.model.semantics.failures import FAILURE, is_failure
from robosc.model.semantics.naming import escape_keyword
from robosc.model.semantics.typing import NONE, ArrayType, EnumType, declared_type

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.checks.edits import Hint

_BASIC = ("boolean", "integer", "double", "string")


@rule("data-type")
def data_type(base: rsc.Base) -> Iterator[Finding]:
    """Arrays occur only in objects, enums are based on data, objects are finite, and the controller sends no enum."""
    for enum in of_kind(rsc.EnumDataType, base.definitions):
        yield from _base_of(enum)
    yield from _endless(base)
    for communication in communications(base):
        for _, declared in carrying_events(communication):
            if _has_failure(declared, set()):
                yield Finding(
                    declared,
                    f"`{communication.name}` carries `{FAILURE}`, expected data of ROS: the controller itself"
                    " detects why a service or an action fails",
                    "read `error` at `on error from …` instead",
                )
            if isinstance(declared, rsc.Array):
                yield Finding(
                    declared,
                    f"the data of `{communication.name}` is an array, expected one in an object only: a ROS message"
                    " has fields, and an array is one of them",
                    f"declare `datatype object … {{ data: {_text(declared)} }}` and use that",
                )
        sent = sent_type(communication)
        path = _enum_in(sent, set())
        if sent is not None and path is not None and not _has_failure(sent, set()):
            through = f" in its property `{'.'.join(path)}`" if path else ""
            yield Finding(
                sent,
                f"`{communication.name}` sends an enum{through}, expected the type of the ROS data: an enum value"
                " cannot be converted back to its data",
                _sent_as(sent) if not path else "declare an object without the enum for the sent data",
            )


def _has_failure(declared: rsc.DataType | None, seen: set[rsc.ObjectDataType]) -> bool:
    """Return whether data of a type contains the predefined enum; objects in `seen` do not."""
    while isinstance(declared, rsc.Array):
        declared = declared.type
    named = declared.type if isinstance(declared, rsc.ComplexDataTypeReference) else None
    if isinstance(named, rsc.ObjectDataType) and named not in seen:
        seen.add(named)
        return any(_has_failure(part.type, seen) for part in named.properties)
    return is_failure(named)


def _sent_as(sent: rsc.DataType) -> Hint:
    hint = "write the source type of the enum, and provide a value of that type"
    while isinstance(sent, rsc.Array):
        sent = sent.type
    assert isinstance(sent, rsc.ComplexDataTypeReference)
    return _without_enum(hint, sent) or hint


def _without_enum(hint: str, declared: rsc.ComplexDataTypeReference) -> Replacement | None:
    """Return a hint that replaces an enum by its base type."""
    base_type: rsc.DataType | None = declared
    seen = set()
    while isinstance(base_type, rsc.ComplexDataTypeReference) and isinstance(base_type.type, rsc.EnumDataType):
        if base_type.type in seen:
            return None
        seen.add(base_type.type)
        base_type = base_type.type.type
    return Replacement(hint, _text(base_type), declared, is_choice=True) if base_type is not None else None


def _base_of(enum: rsc.EnumDataType) -> Iterator[Finding]:
    base_type = declared_type(enum.type)
    repair: Hint | None = None
    if isinstance(base_type, EnumType):
        repair = f"declare it from the type that `{base_type.definition.name}` is from"
        if isinstance(enum.type, rsc.ComplexDataTypeReference):
            repair = _without_enum(repair, enum.type) or repair
    elif isinstance(base_type, ArrayType):
        repair = "declare it from the object that has the array, and read elements by `value.….[0]`"
    elif base_type == NONE:
        repair = Choice(
            "declare it from `boolean`, `integer`, `double`, `string` or an object",
            tuple(Replacement(f"declare it from `{name}`", name, enum.type) for name in _BASIC),
        )
    if repair:
        what = {EnumType: "another enum", ArrayType: "an array"}.get(type(base_type), "no data")
        yield Finding(
            enum.type,
            f"enum `{enum.name}` is from {what}, expected boolean, integer, double, string or an object",
            repair,
        )


def _endless(base: rsc.Base) -> Iterator[Finding]:
    """Report properties that make an object contain itself, one for each cycle."""

    def parts(whole: rsc.ObjectDataType) -> Iterator[tuple[rsc.ObjectProperty, rsc.ObjectDataType]]:
        for part in whole.properties:
            inner = _object_of(part.type)
            if inner is not None and inner.eContainer() is base:
                yield part, inner

    for part, circle in circles(of_kind(rsc.ObjectDataType, base.definitions), parts):
        yield Finding(
            part,
            f"property `{part.name}` makes object `{circle[0].name}` contain itself, expected data of finite size",
            Removal("leave the property out, or give it a type that does not contain the object", part),
        )


def _object_of(declared: rsc.DataType | None) -> rsc.ObjectDataType | None:
    """Return the object in a property, also within arrays and below enums."""
    seen = set()
    while declared is not None:
        while isinstance(declared, rsc.Array):
            declared = declared.type
        named = declared.type if isinstance(declared, rsc.ComplexDataTypeReference) else None
        if not isinstance(named, rsc.EnumDataType) or named in seen:
            return named if isinstance(named, rsc.ObjectDataType) else None
        seen.add(named)
        declared = named.type
    return None


def _enum_in(declared: rsc.DataType | None, seen: set[rsc.ObjectDataType]) -> list[str] | None:
    """Return the path of properties to the first enum in data of a type; None if there is no enum.

    Objects in `seen` contain none. The search adds all objects that it visits.
    """
    while isinstance(declared, rsc.Array):
        declared = declared.type
    named = declared.type if isinstance(declared, rsc.ComplexDataTypeReference) else None
    if isinstance(named, rsc.EnumDataType):
        return []
    if isinstance(named, rsc.ObjectDataType) and named not in seen:
        seen.add(named)
        for part in named.properties:
            rest = _enum_in(part.type, seen)
            if rest is not None:
                return [part.name, *rest]
    return None


def _text(declared: rsc.DataType) -> str:
    """Return the type in the syntax of models."""
    match declared:
        case rsc.Array():
            return f"array({_text(declared.type)})"
        case rsc.InterfaceTypeReference():
            return f"{declared.package}/{declared.rosType}"
        case rsc.ComplexDataTypeReference() if declared.type is not None:
            return escape_keyword(declared.type.name)
    return str(declared_type(declared))
