"""The node of a controller and its connections."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, NamedTuple

from robosc.base.diagnostics.visible import visible
from robosc.model import rosgraph
from robosc.model.semantics.naming import controller_name
from robosc.model.semantics.roles import plant_of
from robosc.tools.diagrams.graph import Arrow, DiagramNode, Graph, Group

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    _User = rosgraph.ServiceClient | rosgraph.ActionClient | rosgraph.ServiceServer | rosgraph.ActionServer

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

    An arrow has the direction of the data. Services and actions that the controller calls have arrows
    with two heads. Those that it serves have an arrow to the controller.
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
        comes_in = connection.direction == "in" or (connection.kind == "topic" and connection.direction == "both")
        ends = (key, _CONTROLLER) if comes_in else (_CONTROLLER, key)
        arrows.append(Arrow(*ends, both=connection.direction == "both"))
    controller = DiagramNode(_CONTROLLER, "controller", visible(controller_name(graph)))
    return Graph(f"{visible(graph.name)}: ROS graph", [Group("g", "", (), [*nodes, controller], arrows)])


def connections(graph: rosgraph.RosGraph) -> list[Connection]:
    """Return the topics, services and actions of a controller, in this order, with printable names and types."""
    return [
        *_topics(graph),
        *_servers("service", graph.serviceClients),
        *_servers("service", graph.serviceServers),
        *_servers("action", graph.actionClients),
        *_servers("action", graph.actionServers),
    ]


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


def _servers(kind: str, users: Iterable[_User]) -> Iterator[Connection]:
    """Yield the services or actions that the controller calls, or those that it serves: their requests come in."""
    for user in users:
        direction = "both" if isinstance(user.request, rosgraph.Sending) else "in"
        yield Connection(visible(user.identifier), kind, direction, [_type(user.interface)], [_use(user.request)])


def _type(interface: rosgraph.Interface) -> str:
    return visible(f"{interface.package}/{interface.type}")


def _use(use: rosgraph.Reception | rosgraph.Sending) -> str:
    return visible(plant_of(use.event).origin or use.name)
