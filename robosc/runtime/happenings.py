"""What data that comes in means: to the supervisor, to the node's own variables, and to the event log."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph
from robosc.runtime.node_data import PastEndError
from robosc.runtime.reports import ReceivedData

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.metamodel import sct
    from robosc.runtime.json_text import Json
    from robosc.runtime.node_data import NodeData
    from robosc.runtime.port import Message
    from robosc.runtime.throttle import Throttle


class Happenings:
    """The data of the events of one graph. What reads past the end of an array is skipped, and the user warned."""

    def __init__(self, graph: rosgraph.RosGraph, data: NodeData, warn: Throttle) -> None:
        self._data = data
        self._warn = warn
        self._received = {each.event: self._reads(each) for each in receptions(graph)}

    def _reads(self, reception: rosgraph.Reception) -> ReceivedData:
        return ReceivedData([each.value for each in reception.inputs] + self._data.values_read(reception.event))

    def inputs(self, name: str, assignments: Sequence[rosgraph.InputAssignment], message: Message) -> dict[str, Any]:
        """What a message on the topic, service or action of that name tells the supervisor."""
        values: dict[str, Any] = {}
        for each in assignments:
            try:
                value = self._data.value(each.value, message)
                values[each.input.name] = value.name if isinstance(value, ex.EnumerationLiteral) else value
            except PastEndError as fault:
                self._warn((name, str(fault)), f"{name}: {fault}")
        return values

    def change(self, event: sct.Event, name: str, message: Message = None) -> None:
        """Changes the node's variables as the event does, from the present state on."""
        values, faults = self._data.assignments(event, message)
        for fault in faults:
            self._warn((name, str(fault)), f"{name}: {fault}")
        self._data.variables.update(values)

    def noted(self, event: sct.Event, message: Message) -> Mapping[str, Json] | None:
        """What the event log says of the event's data."""
        received = self._received.get(event)
        return None if received is None else received.read(self._data, message)


def receptions(graph: rosgraph.RosGraph) -> list[rosgraph.Reception]:
    """All data that comes in."""
    clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = [*graph.serviceClients, *graph.actionClients]
    return [
        *(each for topic in graph.subscriptions for each in topic.receptions),
        *(each.response for each in clients),
        *(each.feedback for each in graph.actionClients),
    ]
