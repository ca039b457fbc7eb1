"""What comes in, as events: of the supervisor, of the node's own variables, and of the event log."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.runtime.core.node_data import PastEndError
from robosc.runtime.core.reports import ReceivedData
from robosc.semantics.received import receptions
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.engine import ControlLoop
    from robosc.metamodel import rosgraph, sct
    from robosc.runtime.core.json_text import Json
    from robosc.runtime.core.node_data import NodeData
    from robosc.runtime.core.port import Message


class Happenings:
    """Lets the events of one graph happen, with their data; where that can't be read, they don't."""

    def __init__(self, graph: rosgraph.RosGraph, data: NodeData, loop: ControlLoop) -> None:
        self._data = data
        self._loop = loop
        #: What the event that is happening came with: the message, and the event that would have been made of it.
        self._came: tuple[sct.Event, Message] | None = None
        self._received = {each.event: self._reads(each) for each in receptions(graph)}

    def _reads(self, reception: rosgraph.Reception) -> ReceivedData:
        return ReceivedData([each.value for each in reception.inputs] + self._data.values_read(reception.event))

    def perform(
        self, event: sct.Event, inputs: Sequence[rosgraph.InputAssignment] = (), message: Message = None
    ) -> PastEndError | None:
        """Lets an event of the robot happen, if it can now; what keeps its data from being read, and so it itself."""
        if not self._loop.enabled(event_name(event)):
            return None
        try:
            received = self._data.received(event, inputs, message)
        except PastEndError as fault:
            return fault
        self._data.variables.update(received.variables)
        self._came = event, message
        self._loop.perform(event_name(event), received.inputs)
        self._came = None
        return None

    def reject(self, client: rosgraph.ServiceClient | rosgraph.ActionClient, message: Message) -> None:
        """An answer that can't be read is the error of its service or action; the log shows what can be read of it."""
        if self._loop.enabled(event_name(client.error)):
            self.change(client.error)
            self._came = client.response.event, message
            self._loop.perform(event_name(client.error))
            self._came = None

    def change(self, event: sct.Event) -> None:
        """Changes the node's variables as an event without data does, from the present state on."""
        self._data.variables.update(self._data.received(event).variables)

    def noted(self, event: sct.Event) -> Mapping[str, Json] | None:
        """What the event log says of the data of an event that happens now."""
        if self._came is None:
            return None
        came, message = self._came
        shown = self._received[came].read(self._data, message) if came in self._received else None
        return shown if came is event else shown or {"value": {}}
