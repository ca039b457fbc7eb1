"""Objects that ROS defines: their properties are created from ROS fields when names in a text refer to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.diagnostics import Repair
from robosc.base.ros_types import OWN_OBJECT, DefinitionError, Section
from robosc.base.ros_types.wire import PRIMITIVES, Basic, Sequence
from robosc.model import robosc as rsc
from robosc.model.reflection import contents, tree
from robosc.model.semantics.communication import section_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.base.ros_types import Fields, RosDistribution, RosTypes, WireType

#: Integer types whose range becomes the range of the property.
_NARROW = ("int8", "uint8", "int16", "uint16")
_TYPES = {
    "boolean": rsc.BooleanDataType,
    "integer": rsc.IntegerDataType,
    "double": rsc.DoubleDataType,
    "string": rsc.StringDataType,
}


def declare(reference: rsc.InterfaceTypeReference, interfaces: RosTypes) -> tuple[str, Repair | str] | None:
    """Set the object of a reference; return a message and a hint if the ROS type is unknown."""
    if next(_definitions(reference, interfaces), None) is None:
        part = section_of(reference)
        message, hint, meant = interfaces.why_unknown(reference.package, reference.rosType, part)
        if part is Section.MESSAGE and interfaces.other_kinds(reference.package, reference.rosType, part.kind):
            return message, OWN_OBJECT
        return message, Repair(hint, choices=("/".join(meant),)) if meant is not None else hint
    reference.definition = rsc.ObjectDataType(name=reference.rosType, source=reference.source)
    reference.type = reference.definition
    return None


def link_interface(communication: rsc.CommunicationType) -> None:
    """Set the interface of a communication without one to that of its data, or of its enum, if ROS defines it."""
    for _, declared in contents(communication):
        is_enum = isinstance(declared, rsc.ComplexDataTypeReference) and isinstance(declared.type, rsc.EnumDataType)
        named = declared.type.type if is_enum else declared
        if isinstance(named, rsc.InterfaceTypeReference) and communication.interface is None:
            if named.interface is None:
                named.interface = rsc.Interface(
                    name=named.rosType, package=named.package, type=named.rosType, source=named.source
                )
            communication.interface = named.interface


def is_made(definition: rsc.ComplexDataType) -> bool:
    """Return whether ROS, not a text, defines an object."""
    return isinstance(definition.eContainer(), rsc.InterfaceTypeReference)


def ros_property(definition: rsc.ObjectDataType, name: str, interfaces: RosTypes) -> rsc.ObjectProperty | None:
    """Return the property for a field of a ROS object, or None if the field or a data type for it does not exist."""
    for known in definition.properties:
        if known.name == name:
            return known
    for distribution, fields in _definitions(definition.eContainer(), interfaces):
        if name in fields:
            kind = _data_type(fields[name], distribution)
            if kind is not None:
                prop = rsc.ObjectProperty(name=name, type=kind)
                for _, part in tree(prop):
                    part.source = definition.source
                definition.properties.append(prop)
                for _, part in tree(kind):
                    if isinstance(part, rsc.InterfaceTypeReference):
                        declare(part, interfaces)
                return prop
    return None


def ros_properties(definition: rsc.ObjectDataType, interfaces: RosTypes) -> list[str]:
    """Return the names of all properties that a ROS object can have, those of ROS 2 first."""
    known = _definitions(definition.eContainer(), interfaces)
    fields = [(name, wire, distribution) for distribution, fields in known for name, wire in fields.items()]
    return list(
        dict.fromkeys(name for name, wire, distribution in fields if _data_type(wire, distribution) is not None)
    )


def _definitions(
    reference: rsc.InterfaceTypeReference, interfaces: RosTypes
) -> Iterator[tuple[RosDistribution, Fields]]:
    for distribution in interfaces.distributions:
        try:
            fields = distribution.fields(reference.package, reference.rosType, section_of(reference))
        except DefinitionError:
            continue
        if fields is not None:
            yield distribution, fields


def _data_type(wire: WireType, distribution: RosDistribution) -> rsc.DataType | None:
    match wire:
        case Sequence():
            element = _data_type(wire.element, distribution)
            return None if element is None else rsc.Array(type=element)
        case Basic():
            return _basic(wire.name)
    try:
        known = distribution.fields(wire.package, wire.name, Section.MESSAGE) is not None
    except DefinitionError:
        known = False
    return rsc.InterfaceTypeReference(package=wire.package, rosType=wire.name) if known else None


def _basic(name: str) -> rsc.DataType | None:
    primitive = PRIMITIVES.get(name)
    if primitive is None:
        return None
    kind: rsc.DataType = _TYPES[primitive.name]()
    if isinstance(kind, rsc.IntegerDataType) and primitive.range is not None and name in _NARROW:
        kind.minimum, kind.maximum = primitive.range
    return kind
