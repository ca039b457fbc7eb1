"""Data that communications with an interface carry, and the parts of it that the model uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from robosc.base.ros_types.wire import NestedType, Section
from robosc.language.checks.definitions import communication_of, communications
from robosc.model import robosc as rsc
from robosc.model.reflection import tree
from robosc.model.semantics.communication import PortEvent, carrying_events, event_of, provided_event
from robosc.model.semantics.cone_of_influence import accesses

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.model import expression as ex

#: Properties that a text uses, each with the place of its first use.
Uses: TypeAlias = "dict[rsc.ObjectProperty, ex.Located]"


@dataclass(frozen=True)
class CommunicationData:
    """Data of one part of a communication with an interface."""

    communication: rsc.CommunicationType
    interface: rsc.Interface
    declared: rsc.DataType
    event: PortEvent

    @property
    def is_received(self) -> bool:
        """Whether the controller receives the data."""
        return not self.event.is_sent

    @property
    def part(self) -> Section:
        """Section of the ROS type that contains the data."""
        assert self.event.section is not None
        return self.event.section

    @property
    def ros_type(self) -> NestedType:
        """ROS type that the interface names."""
        return NestedType(self.interface.package, self.interface.type)


def carried_data(base: rsc.Base) -> Iterator[CommunicationData]:
    """Yield the data of all communications with an interface that the base defines, in the order of the text."""
    for communication in communications(base):
        interface = communication.interface
        if interface is not None and interface.package and interface.type:
            for event, declared in carrying_events(communication):
                yield CommunicationData(communication, interface, declared, event)


def carries(base: rsc.Base) -> bool:
    """Return whether the base defines a communication with an interface."""
    return any(True for _ in carried_data(base))


class UsedData:
    """Parts of the carried data that expressions and provided data of some texts use."""

    def __init__(self, bases: Iterable[rsc.Base]) -> None:
        self._touched: dict[object, list[rsc.PropertySegment | rsc.ObjectPropertyValue]] = {}
        for base in bases:
            for _, element in tree(base):
                if isinstance(element, rsc.ResultTransition):
                    self._received(element)
                elif isinstance(element, rsc.DataStatement):
                    self._provided(element)
                elif isinstance(element, rsc.EnumTransformationRule):
                    self._read(element.eContainer(), element.condition)

    def uses(self, data: CommunicationData) -> Uses:
        """Return the properties of some data that are used; an enum uses those that its rules read."""
        uses: Uses = {}
        sources: dict[object, None] = dict.fromkeys([(data.communication, data.event), *_enums(data.declared)])
        pending = list(sources)
        while pending:
            for touching in self._touched.get(pending.pop(0), ()):
                if touching.property is not None and touching.property not in uses:
                    uses[touching.property] = touching
                    new = [enum for enum in _enums(touching.property.type) if enum not in sources]
                    sources |= dict.fromkeys(new)
                    pending += new
        return uses

    def _received(self, transition: rsc.ResultTransition) -> None:
        event = event_of(transition.communicationType, transition.resultType)
        if event is not None and not event.is_sent:
            for assignment in transition.assignments:
                self._read((transition.communicationType.communicationType, event), assignment.value)

    def _provided(self, statement: rsc.DataStatement) -> None:
        communication = communication_of(statement.communicationType)
        source = communication, provided_event(statement)
        for expression in (statement.data, statement.condition):
            self._read(source, expression)
        touched = self._touched.setdefault(source, [])
        touched += [part for _, part in tree(statement) if isinstance(part, rsc.ObjectPropertyValue)]

    def _read(self, source: object, expression: ex.Expression | None) -> None:
        touched = self._touched.setdefault(source, [])
        for access in accesses(expression):
            if access.value or isinstance(access.item, rsc.ArrayElement):
                touched += [segment for segment in access.segments if isinstance(segment, rsc.PropertySegment)]


def _enums(declared: rsc.DataType | None) -> list[rsc.EnumDataType]:
    """Return the enum that a type names, also within arrays, as a list; empty for any other type."""
    while isinstance(declared, rsc.Array):
        declared = declared.type
    named = declared.type if isinstance(declared, rsc.ComplexDataTypeReference) else None
    return [named] if isinstance(named, rsc.EnumDataType) else []
