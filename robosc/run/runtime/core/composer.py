"""Data of messages, requests and goals, from `provide` statements."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING

from robosc.model import rosgraph
from robosc.model.semantics.messages import holds_objects, parts_with_headers
from robosc.run.runtime.core.event_log import nest
from robosc.run.runtime.core.node_data import fill, hand_on, within_range

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.base.ros_types import Section
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.node_data import NodeData
    from robosc.run.runtime.core.port import ControllerPort, Message


@dataclass(frozen=True)
class Composer:
    """Create data of ROS with a port. `data`: the data of the node."""

    port: ControllerPort
    data: NodeData

    def default(
        self, sending: rosgraph.Sending, interface: rosgraph.Interface, section: Section, frame: str
    ) -> Message:
        """Return data with the defaults of ROS; headers that the model does not set get the time and a frame."""
        message = self.port.create(interface, section)
        for part in parts_with_headers(sending):
            self.port.stamp(reduce(getattr, part, message), frame)
        return message

    def compose(
        self, sending: rosgraph.Sending, interface: rosgraph.Interface, section: Section, frame: str
    ) -> tuple[Message, Mapping[str, Json] | None]:
        """Return the data of the `provide` statement that holds, else defaults, and the data for the event log.

        Raises NotFiniteError or UnreadableError if the data can't be sent.
        """
        message = self.default(sending, interface, section, frame)
        fields: dict[tuple[str, ...], Json] = {}
        alternatives = sending.alternatives
        chosen = next((data for data in alternatives if self.data.is_in(data.location)), None)
        assignments = [
            field
            for field in (chosen.fields if chosen is not None else ())
            if field.condition is None or self.data.value(field.condition)
        ]
        values = [within_range(self.data.value(field.value), field.type) for field in assignments]
        for field, value in zip(assignments, values, strict=True):
            if isinstance(field.value, rosgraph.WireAccess) and holds_objects(field.type):
                hand_on(self.port, message, field.path, value)
                continue
            fields[tuple(field.path)] = fill(self.port, message, field.path, value)
        if not alternatives:
            return message, None
        return message, {"value": fields["data",] if list(fields) == [("data",)] else nest(fields)}
