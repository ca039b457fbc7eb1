"""Comparison of the topics and servers of a ROS node with the text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.analysis.verify.controller_reading.loop import event_names
from robosc.analysis.verify.model_reading.lockstep import DifferenceError
from robosc.analysis.verify.model_reading.machine import SERVERS, EventName

if TYPE_CHECKING:
    from robosc.analysis.verify.model_reading.controller import ControllerText
    from robosc.analysis.verify.model_reading.machine import Machine, Plant
    from robosc.model import rosgraph


def compare_topics(controller: ControllerText, plants: Machine, graph: rosgraph.RosGraph) -> None:
    """Raise DifferenceError unless the node has one subscription or publisher for each topic of the text.

    Also raises it if messages of a topic are in another order, or if a server has another name.
    """
    names = event_names(plants)
    text = controller.text
    heard = [(end.topic, end.interface, [names[part.event] for part in end.receptions]) for end in graph.subscriptions]
    sent = [(end.topic, end.interface, [names[part.event] for part in end.sendings]) for end in graph.publishers]
    for event, ends in (("u_response", heard), ("c_trigger", sent)):
        ours = [EventName(plant, event) for plant in text.order if plant.kind == "message"]
        ours = [name for name in ours if name in text.events]
        theirs = [name for _, _, events in ends for name in events]
        if sorted(ours) != sorted(theirs):
            missing = ", ".join(f"`{name.plant.origin}`" for name in sorted({*ours} ^ {*theirs}))
            raise DifferenceError(f"the text and the node do not have the same messages: {missing}")
        seen: set[tuple[str, object]] = set()
        for topic, interface, events in ends:
            key = topic.removeprefix("/"), interface
            if key in seen:
                raise DifferenceError(f"topic `{topic}` is one in the text, and has two ends in the node")
            seen.add(key)
            for name in events:
                _compare(name.plant, text, topic, is_same=controller.topic(name.plant) == key[0])
            if events != sorted(events, key=ours.index):
                messages = f"the messages on topic `{topic}`"
                raise DifferenceError(f"{messages} are in another order in the node than in the text")
    users: list[Any] = [*graph.serviceClients, *graph.actionClients, *graph.serviceServers, *graph.actionServers]
    for user in users:
        plant = names[user.request.event].plant
        _compare(plant, text, user.identifier, is_same=user.identifier == text.topics[plant])
    served = sorted(plant for plant in text.order if plant.kind in SERVERS)
    servers = sorted(plant for plant in (names[user.request.event].plant for user in users) if plant.kind in SERVERS)
    if served != servers:
        missing = ", ".join(f"`{plant.origin}`" for plant in sorted({*served} ^ {*servers}))
        raise DifferenceError(f"the text and the node do not serve the same: {missing}")


def _compare(plant: Plant, text: Machine, shown: str, *, is_same: bool) -> None:
    if not is_same:
        ours = f"`{plant.origin}` is `{text.topics[plant]}` in ROS by the text"
        raise DifferenceError(f"{ours}, and `{shown}` in the node")
