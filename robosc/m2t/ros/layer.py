"""Template values of a layer that a controller does not have: passing and blocked messages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.ros.names import CppNames
from robosc.model.engine import Role

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.m2t.ros.gates import Gate
    from robosc.m2t.ros.node import EventHandler, GeneratedNode
    from robosc.model import engine, rosgraph


class LayerNode:
    """The layer of one graph.

    `node` is the part shared with the controller's node, `gates` are those of its commands.
    """

    def __init__(
        self, graph: rosgraph.RosGraph, node: GeneratedNode, gates: Iterable[Gate], executed: engine.EngineModel
    ) -> None:
        self.node = node
        messages = [message for publisher in self.node.publishers for message in publisher.messages]
        messages += [client.request for client in self.node.clients]
        #: Gates of the controller's commands, by the enumerator of the event.
        self.gates = {gate.event: gate for gate in gates}
        #: Events of commands whose data the layer limits, or with which the supervisor decides.
        self.decided = {message.event for _, message in node.decided}
        self.examined = {message.event for _, message in [*node.limited, *node.decided]}
        #: Messages that replace blocked ones, by the enumerator of the event.
        self.instead = {last.message.event: last for last in node.on_blocked}
        #: Events of the controller and internal events that change the node's own data.
        self.changing = [*self.node.internal, *(message.reaction for message in messages if message.reaction)]
        #: Events that select provided data. The layer does not handle them.
        names = CppNames(graph)
        self.ignored = [names.c.enumerator(event.event) for event in executed.events if event.role == Role.data]

    @property
    def received(self) -> list[EventHandler]:
        """Incoming events from the robot."""
        messages = [topic.receptions[0] for topic in self.node.subscriptions]
        clients = self.node.clients
        ends = (end for call in clients for end in (call.feedback, call.response, call.error, call.canceled))
        return [*messages, *filter(None, ends)]

    def remapped(self, parts_of_actions: Sequence[str]) -> list[str]:
        """Return the robot's names that are remapped for a controller. An action is remapped part by part."""
        node = self.node
        names = [topic.topic for topic in node.subscriptions] + [topic.topic for topic in node.publishers]
        names += [service.name for service in node.services]
        return names + [f"{action.name}/{part}" for action in node.actions for part in parts_of_actions]
