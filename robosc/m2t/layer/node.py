"""What the templates of a layer print: all that passes it, in both directions, as text of C++."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.cpp.names import CppNames
from robosc.m2t.cpp.node import Node
from robosc.m2t.layer.passages import Passage, Passages
from robosc.metamodel import rosgraph, sct
from robosc.semantics.roles import Roles, plant_of

if TYPE_CHECKING:
    from robosc.m2t.cpp.node import Happening


@dataclass(frozen=True)
class Inward:
    """A message from the robot to the controller, and the event that it is."""

    word: str
    topic: str
    interface: rosgraph.Interface
    event: Happening
    unread: bool


@dataclass(frozen=True)
class Outward:
    """A message from the controller to the robot."""

    word: str
    topic: str
    interface: rosgraph.Interface
    passage: Passage


@dataclass(frozen=True)
class Call:
    """A service or action that the controller uses; only an action has feedback and is cancelled by an event."""

    word: str
    name: str
    interface: rosgraph.Interface
    passage: Passage
    response: Happening
    error: Happening
    feedback: Happening | None
    cancel: str | None


class LayerNode:
    """The layer of one graph: `node` is what it has in common with the controller's node."""

    def __init__(self, graph: rosgraph.RosGraph) -> None:
        self.node = Node(graph)
        names = CppNames(graph)
        passages = Passages(graph.model, names)
        self.inward = [
            Inward(
                _word(source.receptions[0].event, names), each.topic, each.interface, each.receptions[0], each.unread
            )
            for source, each in zip(graph.subscriptions, self.node.subscriptions, strict=True)
        ]
        self.outward = [
            Outward(_word(each.sendings[0].event, names), each.topic, each.interface, passages(each.sendings[0].event))
            for each in graph.publishers
        ]
        clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = [*graph.serviceClients, *graph.actionClients]
        self.calls = [
            Call(
                _word(source.request.event, names),
                source.identifier,
                source.interface,
                passages(source.request.event),
                each.response,
                each.error,
                each.feedback,
                each.cancel,
            )
            for source, each in zip(clients, self.node.clients, strict=True)
        ]
        sent = [message for topic in self.node.publishers for message in topic.messages]
        sent += [each.request for each in self.node.clients]
        #: Events of the controller and silent ones that change the node's own data.
        self.changing = [*self.node.silent, *(each.reaction for each in sent if each.reaction)]
        roles = Roles(graph.model)
        #: Events that choose provided data, which is none of the layer's business.
        self.ignored = [names.c.enumerator(event) for events in roles.data for event in events]

    @property
    def services(self) -> list[Call]:
        """The services."""
        return [each for each in self.calls if each.interface.kind == rosgraph.InterfaceKind.service]

    @property
    def actions(self) -> list[Call]:
        """The actions."""
        return [each for each in self.calls if each.interface.kind == rosgraph.InterfaceKind.action]

    @property
    def passages(self) -> list[Passage]:
        """What the controller sends."""
        return [*(each.passage for each in self.outward), *(each.passage for each in self.calls)]

    @property
    def received(self) -> list[Happening]:
        """What comes from the robot."""
        answers = [each for call in self.calls for each in (call.feedback, call.response, call.error) if each]
        return [*(each.event for each in self.inward), *answers]


def _word(event: sct.Event, names: CppNames) -> str:
    return names.c.member(plant_of(event))
