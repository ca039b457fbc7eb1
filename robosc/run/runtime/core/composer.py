"""Data of messages, requests and goals, from `provide` statements and limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from functools import reduce
from typing import TYPE_CHECKING, Any

from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.model.semantics.messages import doubles_read, holds_objects, parts_with_headers, path_of, stored_doubles
from robosc.model.semantics.operators import UnreadableError
from robosc.run.runtime.core.event_log import nest
from robosc.run.runtime.core.node_data import NotFiniteError, fill, hand_on, require_finite, within_range

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.base.ros_types import Section
    from robosc.model.semantics.messages import Path
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.node_data import NodeData
    from robosc.run.runtime.core.port import ControllerPort, Message


@dataclass(frozen=True)
class Composer:
    """Create data of ROS with a port. `data`: the data of the node."""

    port: ControllerPort
    data: NodeData
    #: Paths of the doubles that the limits and the inputs of a command read.
    _doubles: dict[rosgraph.Sending, list[Path]] = field(default_factory=dict)

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
        """Return the data that goes out, and the data for the event log.

        The data of the `provide` statement that holds, else defaults; then the limits change it. Its numbers are as the
        fields hold them. Raises NotFiniteError or UnreadableError if it can't be sent.
        """
        message = self.default(sending, interface, section, frame)
        fields: dict[Path, Json] = {}
        alternatives = sending.alternatives
        chosen = next((data for data in alternatives if self.data.is_in(data.location)), None)
        if chosen is not None:
            self._assign(chosen.fields, message, None, fields)
        self._limit(sending, message, fields)
        if not alternatives and not sending.limits:
            return message, None
        return message, {"value": fields["data",] if list(fields) == [("data",)] else nest(fields)}

    def limited(self, sending: rosgraph.Sending, message: Message) -> Message:
        """Return the data of a message after its limits.

        Raises NotFiniteError or UnreadableError if the limits can't be computed.
        """
        if sending.limits:
            message = deepcopy(message)
        self._limit(sending, message, {})
        return message

    def limited_fields(self, sending: rosgraph.Sending, message: Message) -> Mapping[Path, Json]:
        """Return the fields that the limits set in a message, by path, with their values. The message is unchanged.

        Raises NotFiniteError or UnreadableError if the limits can't be computed.
        """
        fields: dict[Path, Json] = {}
        self._limit(sending, deepcopy(message) if sending.limits else message, fields)
        return fields

    def inputs(self, sending: rosgraph.Sending, message: Message) -> dict[str, Any]:
        """Return the inputs of a command with this data, by name.

        Raises UnreadableError if an element is missing, or an integer is outside its range.
        """
        values = {assigned.input.name: self.data.value(assigned.value, message) for assigned in sending.inputs}
        for assigned in sending.inputs:
            kind, value = assigned.input.type, values[assigned.input.name]
            if not isinstance(kind, ex.IntegerType) or not isinstance(assigned.value, rosgraph.WireAccess):
                continue
            if within_range(value, kind) != value:
                path = ".".join(path_of(assigned.value))
                raise UnreadableError(f"its {path} is {value}, expected {kind.minimum} to {kind.maximum}")
        literals = ex.EnumerationLiteral
        return {name: value.name if isinstance(value, literals) else value for name, value in values.items()}

    def _limit(self, sending: rosgraph.Sending, message: Message, fields: dict[Path, Json]) -> None:
        if sending not in self._doubles:
            self._doubles[sending] = doubles_read(sending)
        for path in self._doubles[sending]:
            require_finite(message, path)
        for name, stored in stored_doubles(sending).items():
            value = self.data.value(stored)
            if not all(map(math.isfinite, value if isinstance(value, Sequence) else [value])):
                raise NotFiniteError([name])
        for limit in sending.limits:
            if limit.condition is None or self.data.value(limit.condition, message):
                self._assign(limit.fields, message, deepcopy(message), fields)

    def _assign(
        self,
        assignments: Sequence[rosgraph.FieldAssignment],
        message: Message,
        before: Message,
        fields: dict[Path, Json],
    ) -> None:
        """Change fields of a message and note their values by path, except those of objects.

        `before` is the data that the values may read.
        """
        chosen = [
            assigned
            for assigned in assignments
            if assigned.condition is None or self.data.value(assigned.condition, before)
        ]
        values = [within_range(self.data.value(assigned.value, before), assigned.type) for assigned in chosen]
        for assigned, value in zip(chosen, values, strict=True):
            path = tuple(assigned.path)
            if isinstance(assigned.value, rosgraph.WireAccess) and holds_objects(assigned.type):
                hand_on(self.port, message, path, value)
                for inside in [known for known in fields if known[: len(path)] == path]:
                    del fields[inside]
            else:
                fields[path] = fill(self.port, message, path, value)
