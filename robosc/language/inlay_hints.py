"""Inlay hints of a text: types of `value`, parameters of arguments, units."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.language.document_symbols import own_elements, span
from robosc.language.units import units
from robosc.model import robosc as rsc
from robosc.model.semantics.typing import UNKNOWN, ArrayType, ObjectType, Type, value_type

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.base.ros_types import RosTypes
    from robosc.language.scopes import File


class Note(NamedTuple):
    """A hint text and the offset at which an editor shows it.

    A type is shown behind a word, any other hint before one.
    """

    offset: int
    text: str
    is_type: bool


def notes(file: File, ros_types: RosTypes) -> list[Note]:
    """Return the hints of a text in order of their offsets."""
    own = [note for element in own_elements(file) for note in _notes(file, element)]
    return sorted([*own, *(Note(offset, f" {unit}", is_type=True) for offset, unit in units(file, ros_types))])


def _notes(file: File, element: Any) -> Iterator[Note]:
    match element:
        case rsc.Access() if element.value:
            kind = value_type(element)
            if kind is not None and kind != UNKNOWN:
                yield Note(span(file, element)[0] + len("value"), f": {_type_text(kind)}", is_type=True)
        case rsc.InstantiatedComponent() | rsc.ImportedComponent() if element.definition is not None:
            yield from _of_arguments(file, element.arguments, element.definition.parameters)
        case rsc.ComplexDataTypeReference() if isinstance(element.type, rsc.EnumDataType):
            yield from _of_arguments(file, element.arguments, element.type.parameters)
        case rsc.Call() if element.function is not None:
            for argument, parameter in zip(element.arguments, element.function.parameters, strict=False):
                yield Note(span(file, argument)[0], f"{parameter.name}:", is_type=False)


def _of_arguments(file: File, arguments: Sequence[rsc.Argument], parameters: Sequence[Any]) -> Iterator[Note]:
    for argument, parameter in zip(arguments, parameters, strict=False):
        if "parameter" in file.references.get(argument, ()):
            return  # The remaining arguments name their parameters.
        yield Note(span(file, argument)[0], f"{parameter.name}:", is_type=False)


def _type_text(kind: Type) -> str:
    if isinstance(kind, ArrayType):
        return f"array({_type_text(kind.element)})"
    return kind.qualified_name if isinstance(kind, ObjectType) else str(kind).removeprefix("enum ")
