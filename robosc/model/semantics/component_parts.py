"""Parts of each component of a robot for a node's reports: variables, commands, topics, clients and servers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from robosc.model import rosgraph, sct
from robosc.model.semantics.communication import event_word
from robosc.model.semantics.definition import reported_variables
from robosc.model.semantics.roles import component_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_Element = TypeVar("_Element")

#: Text in place of the state of a component without states.
STATELESS = "has no states"


@dataclass(frozen=True)
class Parts:
    """A component with its variables, its commands, and the interfaces that report on it.

    A component without behaviour has no plant and no variables.
    """

    name: str
    plant: sct.Plant | None
    stored: Sequence[rosgraph.NodeVariable]
    #: Messages, requests of services, goals of actions, answers of servers.
    commands: Sequence[rosgraph.Sending]
    topics: Sequence[rosgraph.Subscription]
    clients: Sequence[rosgraph.ServiceClient | rosgraph.ActionClient]
    servers: Sequence[rosgraph.ServiceServer | rosgraph.ActionServer]
    #: Topics of the commands.
    publishers: Sequence[rosgraph.Publisher]

    @property
    def connections(
        self,
    ) -> list[
        rosgraph.Subscription
        | rosgraph.Publisher
        | rosgraph.ServiceClient
        | rosgraph.ActionClient
        | rosgraph.ServiceServer
        | rosgraph.ActionServer
    ]:
        """All topics, services and actions of the component in the ROS graph."""
        return [*self.topics, *self.publishers, *self.clients, *self.servers]


def components(graph: rosgraph.RosGraph) -> list[Parts]:
    """Return the components of a robot: first those with behaviour, in the order of the model, then all others."""
    plants: dict[str, sct.Plant | None] = {
        plant.origin or plant.name: plant for plant in graph.model.plants if plant.kind == sct.PlantKind.behaviour
    }
    clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = [*graph.serviceClients, *graph.actionClients]
    sendings = [sending for publisher in graph.publishers for sending in publisher.sendings]
    sendings += [client.request for client in clients]
    sendings += [sending for server in servers(graph) for sending in answers(server).values()]
    listening = [
        (component_name(reception.event), topic) for topic in graph.subscriptions for reception in topic.receptions
    ]
    topics = _grouped(dict.fromkeys(listening))
    commands = _grouped((component_name(sending.event), sending) for sending in sendings)
    called = _grouped((component_name(client.request.event), client) for client in clients)
    served = _grouped((component_name(server.request.event), server) for server in servers(graph))
    for name in [*topics, *commands, *served]:
        plants.setdefault(name, None)
    stored = reported_variables(graph)
    publishers = {sending: publisher for publisher in graph.publishers for sending in publisher.sendings}
    return [
        Parts(
            name,
            plant,
            [] if plant is None else stored.get(plant.origin, []),
            commands.get(name, []),
            topics.get(name, []),
            called.get(name, []),
            served.get(name, []),
            list(dict.fromkeys(publishers[sending] for sending in commands.get(name, []) if sending in publishers)),
        )
        for name, plant in plants.items()
    ]


def servers(graph: rosgraph.RosGraph) -> list[rosgraph.ServiceServer | rosgraph.ActionServer]:
    """Return the services, then the actions that the node serves."""
    return [*graph.serviceServers, *graph.actionServers]


def answers(server: rosgraph.ServiceServer | rosgraph.ActionServer) -> dict[str, rosgraph.Sending]:
    """Return the answers of a server that exist, in the order of its plant, by their words in the language."""
    possible = {word: getattr(server, word, None) for word in ("feedback", "response", "error", "canceled")}
    return {word: sending for word, sending in possible.items() if sending is not None}


def request(sending: rosgraph.Sending) -> str:
    """Return the model's name for the event of a command: `request to move`, or `response to start` of a server."""
    return f"{event_word(sending.event)} to {sending.name}"


def _grouped(owned: Iterable[tuple[str, _Element]]) -> dict[str, list[_Element]]:
    """Group elements by their owner. Each group keeps the order of the elements."""
    groups: dict[str, list[_Element]] = {}
    for owner, element in owned:
        groups.setdefault(owner, []).append(element)
    return groups
