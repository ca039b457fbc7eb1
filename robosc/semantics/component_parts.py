"""What belongs to each component of a robot, as a node reports on it: its variables, commands, topics and servers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from robosc.metamodel import rosgraph, sct
from robosc.semantics.definition import reported
from robosc.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_Element = TypeVar("_Element")

#: What is told in the place of the state of a component that has none.
STATELESS = "has no states"


@dataclass(frozen=True)
class Parts:
    """A component: the variables that the supervisor and the node keep for it, what it is told, what tells of it.

    One without behaviour has no plant, and no variables.
    """

    name: str
    plant: sct.Plant | None
    kept: Sequence[rosgraph.NodeVariable]
    #: Messages, requests of services, goals of actions.
    commands: Sequence[rosgraph.Sending]
    topics: Sequence[rosgraph.Subscription]
    clients: Sequence[rosgraph.ServiceClient | rosgraph.ActionClient]


def components(graph: rosgraph.RosGraph) -> list[Parts]:
    """The components of a robot: those with behaviour in the order of the model, then those that only communicate."""
    plants: dict[str, sct.Plant | None] = {
        plant.origin or plant.name: plant for plant in graph.model.plants if plant.kind == sct.PlantKind.behaviour
    }
    clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = [*graph.serviceClients, *graph.actionClients]
    sendings = [sending for publisher in graph.publishers for sending in publisher.sendings]
    sendings += [client.request for client in clients]
    listening = [(_owner(reception.event), topic) for topic in graph.subscriptions for reception in topic.receptions]
    topics = _grouped(dict.fromkeys(listening))
    commands = _grouped((_owner(sending.event), sending) for sending in sendings)
    called = _grouped((_owner(client.request.event), client) for client in clients)
    for name in [*topics, *commands]:
        plants.setdefault(name, None)
    kept = reported(graph)
    return [
        Parts(
            name,
            plant,
            [] if plant is None else kept.get(plant.origin, []),
            commands.get(name, []),
            topics.get(name, []),
            called.get(name, []),
        )
        for name, plant in plants.items()
    ]


def request(sending: rosgraph.Sending) -> str:
    """What a model calls the event of a command: `request to move`."""
    return f"request to {sending.name}"


def _grouped(owned: Iterable[tuple[str, _Element]]) -> dict[str, list[_Element]]:
    """Elements by their owner, each in the order given."""
    found: dict[str, list[_Element]] = {}
    for owner, element in owned:
        found.setdefault(owner, []).append(element)
    return found


def _owner(event: sct.Event) -> str:
    """The component that a communication is of."""
    return (plant_of(event).origin or "").rpartition(".")[0]
