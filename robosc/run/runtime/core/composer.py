"""Data of messages, requests and goals, from `provide` statements and limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import copy, deepcopy
from dataclasses import dataclass, field
from functools import reduce
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.model.semantics.messages import doubles_read, holds_objects, parts_with_headers, path_of, stored_doubles
from robosc.model.semantics.operators import UnreadableError
from robosc.run.runtime.core.event_log import nest
from robosc.run.runtime.core.node_data import NotFiniteError, fill, hand_on, require_finite, within_range

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.base.ros_types import Section
    from robosc.model.semantics.messages import Path
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.node_data import NodeData
    from robosc.run.runtime.core.port import ControllerPort, Message


class _Assignment(NamedTuple):
    """Assignment of a value to a field. `hands_on`: the value is an object, or an array of objects."""

    path: Path
    value: ex.Expression
    condition: ex.Expression | None
    type: ex.Type
    hands_on: bool


def _assignments(fields: Iterable[rosgraph.FieldAssignment]) -> list[_Assignment]:
    return [
        _Assignment(
            tuple(field.path),
            field.value,
            field.condition,
            field.type,
            isinstance(field.value, rosgraph.WireAccess) and holds_objects(field.type),
        )
        for field in fields
    ]


class _Limit(NamedTuple):
    """Limit of a command. `hands_on`: one of its assignments does."""

    condition: ex.Expression | None
    assignments: list[_Assignment]
    hands_on: bool


class _Input(NamedTuple):
    """Input of a command. `range`: bounds of an integer of the message, which is at `path`."""

    name: str
    value: ex.Expression
    range: ex.IntegerType | None
    path: Path


class _Command:
    """Parts of a sending in the form that is quick to use for each message."""

    def __init__(self, sending: rosgraph.Sending) -> None:
        #: Provided data: assignments that apply in a location.
        self.alternatives = [(data.location, _assignments(data.fields)) for data in sending.alternatives]
        #: Paths of the doubles that the limits and the inputs read, and stored doubles that the limits read.
        self.doubles = doubles_read(sending)
        self.stored = list(stored_doubles(sending).items())
        self.limits: list[_Limit] = []
        for limit in sending.limits:
            assignments = _assignments(limit.fields)
            hands_on = any(assigned.hands_on for assigned in assignments)
            self.limits.append(_Limit(limit.condition, assignments, hands_on))
        limited = {assigned.path for limit in self.limits for assigned in limit.assignments}
        #: Parts of a message on the way to the fields that limits change, the outer ones first.
        self.changed = sorted({path[:length] for path in limited for length in range(1, len(path))}, key=len)
        self.inputs = [
            _Input(
                assigned.input.name,
                assigned.value,
                kind if isinstance(kind, ex.IntegerType) and isinstance(assigned.value, rosgraph.WireAccess) else None,
                path_of(assigned.value) if isinstance(assigned.value, rosgraph.WireAccess) else (),
            )
            for assigned in sending.inputs
            for kind in [assigned.input.type]
        ]


def _copied(command: _Command, message: Message) -> Message:
    """Return a message for the limits of a command to change: they leave the original as it is."""
    if command.limits:
        message = copy(message)
        for *owners, name in command.changed:
            owner = reduce(getattr, owners, message)
            setattr(owner, name, copy(getattr(owner, name)))
    return message


@dataclass(frozen=True)
class Composer:
    """Create data of ROS with a port. `data`: the data of the node."""

    port: ControllerPort
    data: NodeData
    _commands: dict[rosgraph.Sending, _Command] = field(default_factory=dict)

    def _command(self, sending: rosgraph.Sending) -> _Command:
        command = self._commands.get(sending)
        if command is None:
            command = self._commands[sending] = _Command(sending)
        return command

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
        command = self._command(sending)
        for location, assignments in command.alternatives:
            if self.data.is_in(location):
                self._assign(assignments, message, None, fields)
                break
        self._limit(command, message, fields)
        if not command.alternatives and not command.limits:
            return message, None
        return message, {"value": fields["data",] if list(fields) == [("data",)] else nest(fields)}

    def limited(self, sending: rosgraph.Sending, message: Message) -> Message:
        """Return the data of a message after its limits.

        Raises NotFiniteError or UnreadableError if the limits can't be computed.
        """
        command = self._command(sending)
        message = _copied(command, message)
        self._limit(command, message, {})
        return message

    def limited_fields(self, sending: rosgraph.Sending, message: Message) -> Mapping[Path, Json]:
        """Return the fields that the limits set in a message, by path, with their values. The message is unchanged.

        Raises NotFiniteError or UnreadableError if the limits can't be computed.
        """
        command = self._command(sending)
        fields: dict[Path, Json] = {}
        self._limit(command, _copied(command, message), fields)
        return fields

    def inputs(self, sending: rosgraph.Sending, message: Message) -> dict[str, Any]:
        """Return the inputs of a command with this data, by name.

        Raises UnreadableError if an element is missing, or an integer is outside its range.
        """
        inputs = self._command(sending).inputs
        values = {each.name: self.data.value(each.value, message) for each in inputs}
        for name, _, bounds, path in inputs:
            value = values[name]
            if bounds is not None and within_range(value, bounds) != value:
                where = ".".join(path)
                raise UnreadableError(f"its {where} is {value}, expected {bounds.minimum} to {bounds.maximum}")
            if isinstance(value, ex.EnumerationLiteral):
                values[name] = value.name
        return values

    def _limit(self, command: _Command, message: Message, fields: dict[Path, Json]) -> None:
        for path in command.doubles:
            require_finite(message, path)
        for name, stored in command.stored:
            value = self.data.value(stored)
            if not all(map(math.isfinite, value if isinstance(value, Sequence) else [value])):
                raise NotFiniteError([name])
        for condition, assignments, hands_on in command.limits:
            if condition is None or self.data.value(condition, message):
                # All values are computed before a field changes, but an object is copied when its field changes.
                self._assign(assignments, message, deepcopy(message) if hands_on else message, fields)

    def _assign(
        self,
        assignments: Sequence[_Assignment],
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
        for (path, *_, hands_on), value in zip(chosen, values, strict=True):
            if hands_on:
                hand_on(self.port, message, path, value)
                for inside in [known for known in fields if known[: len(path)] == path]:
                    del fields[inside]
            else:
                fields[path] = fill(self.port, message, path, value)
