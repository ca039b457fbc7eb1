"""The node of a controller and its connections."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, NamedTuple

from robosc.base.diagnostics.visible import visible
from robosc.model.semantics.naming import controller_name
from robosc.model.semantics.roles import plant_of
from robosc.tools.diagrams.graph import Arrow, DiagramNode, Graph, Group

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from robosc.model import rosgraph

_CONTROLLER = "controller"
_KEYS = {"topic": "t", "service": "s", "action": "a"}


class Connection(NamedTuple):
    """A topic, service or action: `direction` is `in`, `out` or `both`; `types` are ROS types.

    `uses` are the communications that use it, qualified by their components.
    """

    name: str
    kind: str
    direction: str
    types: Sequence[str]
    uses: Sequence[str]


def ros_graph(graph: rosgraph.RosGraph) -> Graph:
    """Return the controller's node with its topics, services and actions: their types, directions and uses.

    An arrow has the direction of the data. Services and actions have arrows with two heads.
    """
    connected = connections(graph)
    numbers = {kind: count(1) for kind in _KEYS}
    keys = [f"{_KEYS[connection.kind]}{next(numbers[connection.kind])}" for connection in connected]
    nodes = [
        DiagramNode(key, connection.kind, connection.name, [(row,) for row in (*connection.types, *connection.uses)])
        for key, connection in zip(keys, connected, strict=True)
    ]
    arrows = []
    for key, connection in zip(keys, connected, strict=True):
        comes_in = connection.kind == "topic" and connection.direction != "out"
        ends = (key, _CONTROLLER) if comes_in else (_CONTROLLER, key)
        arrows.append(Arrow(*ends, both=connection.direction == "both"))
    controller = DiagramNode(_CONTROLLER, "controller", visible(controller_name(graph)))
    return Graph(f"{visible(graph.name)}: ROS graph", [Group("g", "", (), [*nodes, controller], arrows)])


def connections(graph: rosgraph.RosGraph) -> list[Connection]:
    """Return the topics, services and actions of a controller, in this order, with printable names and types."""
    return [*_topics(graph), *_servers("service", graph.serviceClients), *_servers("action", graph.actionClients)]


def _topics(graph: rosgraph.RosGraph) -> Iterator[Connection]:
    ends: list[tuple[str, rosgraph.Interface, Sequence[rosgraph.Reception | rosgraph.Sending]]]
    ends = [(end.topic, end.interface, end.receptions) for end in graph.subscriptions]
    ends += [(end.topic, end.interface, end.sendings) for end in graph.publishers]
    types: dict[str, dict[str, None]] = {}
    uses: dict[str, list[str]] = {}
    for topic, interface, messages in ends:
        types.setdefault(topic, {})[_type(interface)] = None
        uses.setdefault(topic, []).extend(map(_use, messages))
    subscribed, published = ({end.topic for end in those} for those in (graph.subscriptions, graph.publishers))
    for topic, own_types in types.items():
        direction = "both" if topic in subscribed & published else "in" if topic in subscribed else "out"
        yield Connection(visible(topic), "topic", direction, list(own_types), uses[topic])


def _servers(kind: str, clients: Iterable[rosgraph.ServiceClient | rosgraph.ActionClient]) -> Iterator[Connection]:
    for client in clients:
        yield Connection(visible(client.identifier), kind, "both", [_type(client.interface)], [_use(client.request)])


def _type(interface: rosgraph.Interface) -> str:
    return visible(f"{interface.package}/{interface.type}")


def _use(use: rosgraph.Reception | rosgraph.Sending) -> str:
    return visible(plant_of(use.event).origin or use.name)
