"""Shapes of ROS data: the JSON schema, the faults of a JSON value, and its conversion to a message and back."""

from __future__ import annotations

import math
import struct
from abc import ABC, abstractmethod
from copy import deepcopy
from dataclasses import dataclass, field
from itertools import islice
from typing import TYPE_CHECKING, Any

from robosc.base.ros_types import DefinitionError, Section
from robosc.base.ros_types.units import UNITS
from robosc.base.ros_types.wire import PRIMITIVES, Basic, NestedType, Sequence
from robosc.language.document_symbols import span
from robosc.language.interface_types import is_made
from robosc.model import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.base.ros_types import RosDistribution, WireType
    from robosc.model import rosgraph
    from robosc.model.semantics.instances import Instance
    from robosc.run.runtime.core.port import ControllerPort, Message

#: Largest numbers of the types of floating-point fields, and their codes for `struct`.
_FLOATS = {
    "float32": (struct.unpack("<f", b"\xff\xff\x7f\x7f")[0], "f"),
    "float64": (struct.unpack("<d", b"\xff\xff\xff\xff\xff\xff\xef\x7f")[0], "d"),
}
#: Range of a `byte` of ROS 2, which is signed in ROS 1 only.
_OCTET = (0, 255)
#: Maximum number of faults in an answer.
_MOST_FAULTS = 10


@dataclass(frozen=True)
class Shape(ABC):
    """Shape of a value; `notes` are sentences for the description of its schema."""

    notes: tuple[str, ...] = field(default=(), kw_only=True)

    @property
    def schema(self) -> dict[str, Any]:
        """The JSON schema."""
        described = {"description": " ".join(self.notes)} if self.notes else {}
        return {**self._schema(), **described}

    @abstractmethod
    def _schema(self) -> dict[str, Any]:
        """Return the JSON schema without its description."""

    @abstractmethod
    def faults(self, value: Any, place: str) -> Iterator[str]:
        """Yield why a JSON value does not fit; `place` names it."""

    def converted(self, value: Any) -> Any:
        """Return a value that fits as its field holds it."""
        return value


@dataclass(frozen=True)
class Flag(Shape):
    """A boolean."""

    def _schema(self) -> dict[str, Any]:
        return {"type": "boolean"}

    def faults(self, value: Any, place: str) -> Iterator[str]:
        if not isinstance(value, bool):
            yield f"{place} is {_kind(value)}, expected true or false"


@dataclass(frozen=True)
class Text(Shape):
    """A string."""

    def _schema(self) -> dict[str, Any]:
        return {"type": "string"}

    def faults(self, value: Any, place: str) -> Iterator[str]:
        if not isinstance(value, str):
            yield f"{place} is {_kind(value)}, expected a string"
        elif "\0" in value or any("\ud800" <= character <= "\udfff" for character in value):
            yield f"{place} has a character that ROS cannot send"


@dataclass(frozen=True)
class Number(Shape):
    """A number between two bounds; `code` is that of `struct` for floating-point fields."""

    low: float
    high: float
    code: str = ""

    def _schema(self) -> dict[str, Any]:
        bounds = {"minimum": self.low, "maximum": self.high}
        if not self.code:
            return {"type": "integer", **bounds}
        is_whole_range = any(self.high == limit for limit, _ in _FLOATS.values())
        return {"type": "number", **({} if is_whole_range else bounds)}

    def faults(self, value: Any, place: str) -> Iterator[str]:
        if isinstance(value, bool) or not isinstance(value, int | float):
            yield f"{place} is {_kind(value)}, expected {'a number' if self.code else 'an integer'}"
        elif isinstance(value, float) and not math.isfinite(value):
            yield f"{place} is not finite"
        elif not self.code and value != math.floor(value):
            yield f"{place} is {value}, expected an integer"
        elif not self.low <= value <= self.high:
            yield f"{place} is not between {self.low} and {self.high}"

    def converted(self, value: Any) -> Any:
        if not self.code:
            return int(value)
        return struct.unpack(self.code, struct.pack(self.code, value))[0]


@dataclass(frozen=True)
class Choice(Shape):
    """One of some strings."""

    words: tuple[str, ...]

    def _schema(self) -> dict[str, Any]:
        return {"type": "string", "enum": list(self.words)}

    def faults(self, value: Any, place: str) -> Iterator[str]:
        if not isinstance(value, str) or value not in self.words:
            yield f"{place} is not one of: {', '.join(self.words)}"


@dataclass(frozen=True)
class Anything(Shape):
    """An object that is checked later."""

    def _schema(self) -> dict[str, Any]:
        return {"type": "object"}

    def faults(self, value: Any, place: str) -> Iterator[str]:
        if not isinstance(value, dict):
            yield f"{place} is {_kind(value)}, expected an object"


@dataclass(frozen=True)
class Items(Shape):
    """An array; `length` is None if it varies."""

    element: Shape
    length: int | None = None

    def _schema(self) -> dict[str, Any]:
        bounds = {} if self.length is None else {"minItems": self.length, "maxItems": self.length}
        return {"type": "array", "items": self.element.schema, **bounds}

    def faults(self, value: Any, place: str) -> Iterator[str]:
        if not isinstance(value, list):
            yield f"{place} is {_kind(value)}, expected an array"
        elif self.length is not None and len(value) != self.length:
            yield f"{place} has {len(value)} elements, expected {self.length}"
        else:
            for index, element in enumerate(value):
                yield from self.element.faults(element, f"{place}[{index}]")

    def converted(self, value: Any) -> Any:
        return [self.element.converted(element) for element in value]


@dataclass(frozen=True)
class Fields(Shape):
    """An object with some fields; those that are not `required` have defaults."""

    fields: Mapping[str, Shape]
    required: tuple[str, ...] = ()

    def _schema(self) -> dict[str, Any]:
        properties = {name: shape.schema for name, shape in self.fields.items()}
        required = {"required": list(self.required)} if self.required else {}
        return {"type": "object", "properties": properties, **required, "additionalProperties": False}

    def faults(self, value: Any, place: str) -> Iterator[str]:
        if not isinstance(value, dict):
            yield f"{place or 'the data'} is {_kind(value)}, expected an object"
            return
        for name, inner in value.items():
            inside = f"{place}.{name[:80]}" if place else name[:80]
            if name not in self.fields:
                known = ", ".join(self.fields) or "none"
                yield f"{inside} is not a field; the fields are: {known}"
            else:
                yield from self.fields[name].faults(inner, inside)
        yield from (f"{place + '.' if place else ''}{name} is missing" for name in self.required if name not in value)

    def converted(self, value: Any) -> Any:
        return {name: self.fields[name].converted(inner) for name, inner in value.items()}


def faults_of(shape: Fields, data: Any) -> list[str]:
    """Return the first faults of the data of a command."""
    faults = list(islice(shape.faults(data, ""), _MOST_FAULTS + 1))
    return [*faults[:_MOST_FAULTS], *(["further faults are left out"] if len(faults) > _MOST_FAULTS else [])]


def _kind(value: Any) -> str:
    names = {
        bool: "a boolean",
        int: "a number",
        float: "a number",
        str: "a string",
        list: "an array",
        dict: "an object",
    }
    return names.get(type(value), "null")


# Shapes of ROS types


@dataclass(frozen=True)
class Shapes:
    """Shapes of the types of a ROS version. `instance`: the component whose text declares the data, if it is known."""

    distribution: RosDistribution
    instance: Instance | None = None

    def of(self, package: str, name: str, section: Section, declared: rsc.DataType | None, basic: str) -> Fields:
        """Return the shape of a section of a type.

        Data that the model declares as an object has the fields of this object only. Other declared data is in the
        field `basic`. Raises DefinitionError if a type is unknown.
        """
        if isinstance(declared, rsc.NoneDataType):
            return Fields({})
        whole = NestedType(package, name)
        if isinstance(declared, rsc.BasicDataType):
            wire = self._fields(whole, section).get(basic)
            return Fields({} if wire is None else {basic: self._shape(wire, declared, _unit(whole, basic, None))})
        shape = self._object(whole, section, declared, None)
        assert isinstance(shape, Fields)
        return shape

    def _fields(self, kind: NestedType, section: Section) -> Mapping[str, WireType]:
        fields = self.distribution.fields(kind.package, kind.name, section)
        if fields is None:
            raise DefinitionError(f"{kind} is unknown in {self.distribution.name}")
        return fields

    def _object(self, kind: NestedType, section: Section, declared: rsc.DataType | None, unit: str | None) -> Shape:
        definition = _definition(declared)
        wires = {name: wire for name, wire in self._fields(kind, section).items() if _is_known(wire)}
        properties = dict.fromkeys(wires) if definition is None else _properties(definition)
        shapes = {
            name: self._shape(wires[name], None if known is None else known.type, _unit(kind, name, unit), known)
            for name, known in properties.items()
            if name in wires
        }
        return Fields(shapes)

    def _shape(
        self,
        wire: WireType,
        declared: rsc.DataType | None,
        unit: str | None,
        known: rsc.ObjectProperty | None = None,
    ) -> Shape:
        notes = tuple(filter(None, [f"In {unit}." if unit else None, None if known is None else comment(known)]))
        if isinstance(wire, NestedType):
            shape = self._object(wire, Section.MESSAGE, declared, unit)
            return Fields(shape.fields, notes=notes[unit is not None :]) if isinstance(shape, Fields) else shape
        if isinstance(wire, Sequence):
            element = declared.type if isinstance(declared, rsc.Array) else None
            return Items(self._shape(wire.element, element, unit), wire.length, notes=notes[unit is not None :])
        primitive = PRIMITIVES[wire.name]
        if wire.name in _FLOATS:
            limit, code = _FLOATS[wire.name]
            return Number(-limit, limit, code, notes=notes)
        if primitive.range is not None:
            low, high = _OCTET if wire.name == "byte" else primitive.range
            if self.instance is not None and isinstance(declared, rsc.IntegerDataType):
                bounds = self.instance.data_type(declared)
                assert isinstance(bounds, rsc.IntegerDataType)
                low = low if bounds.minimum is None else max(low, bounds.minimum)
                high = high if bounds.maximum is None else min(high, bounds.maximum)
            return Number(low, high, notes=notes)
        return Flag(notes=notes) if primitive.name == "boolean" else Text(notes=notes)


def _is_known(wire: WireType) -> bool:
    while isinstance(wire, Sequence):
        wire = wire.element
    return not isinstance(wire, Basic) or wire.name in PRIMITIVES


def _definition(declared: rsc.DataType | None) -> rsc.ObjectDataType | None:
    """Return the object that the model declares; None if ROS defines it."""
    named = declared.type if isinstance(declared, rsc.ComplexDataTypeReference) else None
    if isinstance(named, rsc.EnumDataType):
        return _definition(named.type)
    return named if isinstance(named, rsc.ObjectDataType) and not is_made(named) else None


def _properties(definition: rsc.ObjectDataType) -> dict[str, rsc.ObjectProperty | None]:
    return {known.name: known for known in definition.properties}


def _unit(kind: NestedType, name: str, around: str | None) -> str | None:
    return UNITS.get((kind.package, kind.name), {}).get(name, around)


def comment(element: Any) -> str | None:
    """Return the comment above an element of a text; None if there is none."""
    parsed = None if element.source is None or element.source.file is None else element.source.file.parsed
    text: str | None = None if parsed is None else parsed.text.comment_above(span(parsed, element)[0])
    return text


def source_text(element: Any) -> str | None:
    """Return the text of an element in one line; None if it is unknown."""
    parsed = None if element.source is None or element.source.file is None else element.source.file.parsed
    if parsed is None:
        return None
    start, end = span(parsed, element)
    return " ".join(parsed.text.content[start:end].split())


# Messages


@dataclass(frozen=True)
class Messages:
    """Conversion between JSON and the messages of a port."""

    port: ControllerPort
    #: New elements of arrays, by the place of the array in a type.
    _elements: dict[tuple[Any, ...], Message] = field(default_factory=dict)

    def create(
        self, interface: rosgraph.Interface, section: Section, data: Mapping[str, Any], frame: str = ""
    ) -> Message:
        """Return a message with converted data. Headers beside it that it leaves out get the time and the frame."""
        message = self.port.create(interface, section)
        self._fill(message, (interface, section), data, frame)
        return message

    def _fill(self, message: Message, place: tuple[Any, ...], data: Mapping[str, Any], frame: str) -> None:
        types = self.port.wire_types(message)
        if "header" in types and "header" not in data:
            self.port.stamp(message, frame)
        for name, value in data.items():
            inside = (*place, name)
            if isinstance(value, dict):
                self._fill(getattr(message, name), inside, value, frame)
            elif isinstance(value, list) and value and isinstance(value[0], dict):
                elements = [self._element(inside) for _ in value]
                for element, inner in zip(elements, value, strict=True):
                    self._fill(element, (*inside, "0"), inner, frame)
                setattr(message, name, elements)
            elif types[name] == "octet":
                setattr(message, name, bytes([value]))
            else:
                is_octets = "octet" in types[name] and isinstance(value, list)
                setattr(message, name, [bytes([number]) for number in value] if is_octets else value)

    def _element(self, place: tuple[Any, ...]) -> Message:
        if place not in self._elements:
            interface, section, *path = place
            self._elements[place] = self.port.unset(interface, section, (*path, "0"))
        return deepcopy(self._elements[place])

    def plain(self, value: Any) -> Any:
        """Return data of ROS as JSON; numbers that are not finite are null."""
        if isinstance(value, bool | int | str) or value is None:
            return value
        if isinstance(value, float):
            return value if math.isfinite(value) else None
        if isinstance(value, bytes):
            return value[0] if len(value) == 1 else list(value)
        if hasattr(value, "tolist"):
            return self.plain(value.tolist())  # an array or a number of numpy, or an array of Python
        if isinstance(value, list | tuple):
            return list(map(self.plain, value))
        return {name: self.plain(getattr(value, name)) for name in self.port.wire_types(value)}
