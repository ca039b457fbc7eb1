"""What the templates of a layer print beside what it shares with a controller: what passes it, and what it blocks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.ros.names import CppNames
from robosc.metamodel.engine import Role

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.m2t.ros.gates import Gate
    from robosc.m2t.ros.node import EventHandler, Node
    from robosc.metamodel import engine, rosgraph


class LayerNode:
    """The layer of one graph: `node` is what it shares with the controller's, `gates` are those of its commands."""

    def __init__(
        self, graph: rosgraph.RosGraph, node: Node, gates: Iterable[Gate], executed: engine.EngineModel
    ) -> None:
        self.node = node
        messages = [message for publisher in self.node.publishers for message in publisher.messages]
        messages += [client.request for client in self.node.clients]
        #: What the controller sends, by the enumerator of its event.
        self.gates = {gate.event: gate for gate in gates}
        #: What it sends in the place of blocked messages, by the enumerator of its event.
        self.instead = {last.message.event: last for last in node.on_blocked}
        #: Events of the controller and internal ones that change the node's own data.
        self.changing = [*self.node.internal, *(message.reaction for message in messages if message.reaction)]
        #: Events that choose provided data, which is none of the layer's business.
        names = CppNames(graph)
        self.ignored = [names.c.enumerator(event.event) for event in executed.events if event.role == Role.data]

    @property
    def received(self) -> list[EventHandler]:
        """What comes from the robot."""
        messages = [topic.receptions[0] for topic in self.node.subscriptions]
        clients = self.node.clients
        ends = (end for call in clients for end in (call.feedback, call.response, call.error, call.canceled))
        return [*messages, *filter(None, ends)]

    def remapped(self, parts_of_actions: Sequence[str]) -> list[str]:
        """The robot's names that a controller is started with others for; an action is re-mapped part by part."""
        node = self.node
        names = [topic.topic for topic in node.subscriptions] + [topic.topic for topic in node.publishers]
        names += [service.name for service in node.services]
        return names + [f"{action.name}/{part}" for action in node.actions for part in parts_of_actions]
