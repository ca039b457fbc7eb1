"""Units of the data that a text reads and provides, as ROS defines its types."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.base.ros_types import DefinitionError, Section
from robosc.base.ros_types.units import UNITS
from robosc.base.ros_types.wire import PRIMITIVES, Basic, NestedType, Sequence
from robosc.language.document_symbols import own_elements, span
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import carrying_events, event, provided_event
from robosc.model.semantics.walks import branches

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.base.ros_types import RosTypes, WireType
    from robosc.language.scopes import File
    from robosc.model.semantics.communication import PortEvent


class _Measured(NamedTuple):
    """Value at the end of a path of fields: its type, the section of that type, and its unit."""

    wire: WireType
    section: Section
    unit: str | None = None


def units(file: File, ros_types: RosTypes) -> Iterator[tuple[int, str]]:
    """Yield the units of data read from events and provided to them, each with the offset behind the expression."""
    objects = _objects(file)
    for element in own_elements(file):
        if isinstance(element, rsc.Access) and element.value:
            measured = _read(element, objects)
            for segment in element.segments:
                if isinstance(segment, rsc.PropertySegment):
                    measured = _field(measured, segment.property, ros_types)
            yield from _unit_notes(file, element, measured)
        elif isinstance(element, rsc.DataStatement):
            reference = element.communicationType
            communication = reference.communicationType if reference is not None else None
            data = _data(communication, provided_event(element))
            yield from _provided(file, element.data, data, ros_types)


def _provided(file: File, value: Any, measured: _Measured | None, ros_types: RosTypes) -> Iterator[tuple[int, str]]:
    objects = [branch for _, branch in branches(value) if isinstance(branch, rsc.ObjectValue)]
    if not objects:
        yield from _unit_notes(file, value, measured)
    for field in (field for branch in objects for field in branch.properties):
        yield from _provided(file, field.value, _field(measured, field.property, ros_types), ros_types)


def _unit_notes(file: File, element: Any, measured: _Measured | None) -> Iterator[tuple[int, str]]:
    """Yield the unit of a number."""
    is_number = measured is not None and isinstance(measured.wire, Basic) and measured.wire.name in PRIMITIVES
    if measured is not None and is_number and measured.unit is not None and element is not None:
        yield span(file, element)[1], measured.unit


def _objects(file: File) -> Mapping[Any, _Measured]:
    """Return the ROS types of the objects that a text declares, from the interfaces of its communications."""
    measured_objects: dict[Any, _Measured] = {}
    for communication in own_elements(file):
        if isinstance(communication, rsc.CommunicationType):
            for row, declared in carrying_events(communication):
                data = _data(communication, row)
                named = declared.type if isinstance(declared, rsc.ComplexDataTypeReference) else None
                if isinstance(named, rsc.EnumDataType) and isinstance(named.type, rsc.ComplexDataTypeReference):
                    named = named.type.type
                if data is not None and isinstance(named, rsc.ObjectDataType):
                    measured_objects.setdefault(named, data)
    return measured_objects


def _data(communication: rsc.CommunicationType | None, row: PortEvent | None) -> _Measured | None:
    """Return the data of an event of a communication, if its ROS type is known."""
    if communication is None or communication.interface is None or row is None or row.section is None:
        return None
    return _Measured(NestedType(communication.interface.package, communication.interface.type), row.section)


def _read(access: rsc.Access, objects: Mapping[Any, _Measured]) -> _Measured | None:
    """Return the data that `value` refers to."""
    around: Any = access
    while around is not None:
        if isinstance(around, rsc.ResultTransition):
            reference = around.communicationType
            communication = reference.communicationType if reference is not None else None
            return _data(communication, event(communication, around.resultType))
        if isinstance(around, rsc.EnumDataType):
            if isinstance(around.type, rsc.InterfaceTypeReference):
                return _Measured(NestedType(around.type.package, around.type.rosType), Section.MESSAGE)
            return objects.get(around.type.type) if isinstance(around.type, rsc.ComplexDataTypeReference) else None
        around = around.eContainer()
    return None


def _field(measured: _Measured | None, field: rsc.ObjectProperty | None, ros_types: RosTypes) -> _Measured | None:
    if measured is None or field is None or not isinstance(measured.wire, NestedType):
        return None
    package, name = measured.wire.package, measured.wire.name
    for distribution in ros_types.distributions:
        try:
            fields = distribution.fields(package, name, measured.section)
        except DefinitionError:
            continue
        wire = fields.get(field.name) if fields is not None else None
        while isinstance(wire, Sequence):
            wire = wire.element
        if wire is not None:
            unit = UNITS.get((package, name), {}).get(field.name, measured.unit)
            return _Measured(wire, Section.MESSAGE, unit)
    return None
