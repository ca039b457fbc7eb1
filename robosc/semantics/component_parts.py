"""What belongs to each component of a robot, as a node reports on it: its variables, commands, topics and servers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.metamodel import rosgraph, sct
from robosc.semantics.definition import reported
from robosc.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Sequence


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
    receptions = [reception for topic in graph.subscriptions for reception in topic.receptions]
    for event in [*(reception.event for reception in receptions), *(sending.event for sending in sendings)]:
        plants.setdefault(_owner(event), None)
    return [
        Parts(
            name,
            plant,
            [] if plant is None else reported(graph, plant),
            [sending for sending in sendings if _owner(sending.event) == name],
            [
                topic
                for topic in graph.subscriptions
                if any(_owner(reception.event) == name for reception in topic.receptions)
            ],
            [client for client in clients if _owner(client.request.event) == name],
        )
        for name, plant in plants.items()
    ]


def request(sending: rosgraph.Sending) -> str:
    """What a model calls the event of a command: `request to move`."""
    return f"request to {sending.name}"


def _owner(event: sct.Event) -> str:
    """The component that a communication is of."""
    return (plant_of(event).origin or "").rpartition(".")[0]
