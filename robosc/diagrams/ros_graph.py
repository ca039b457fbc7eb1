"""The node of a controller and what it is connected to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.diagnostics.visible import visible
from robosc.diagrams.graph import Arrow, Graph, Group, Node
from robosc.semantics.naming import controller_name
from robosc.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from robosc.diagrams.graph import Label
    from robosc.metamodel import rosgraph

_CONTROLLER = "controller"


def ros_graph(graph: rosgraph.RosGraph) -> Graph:
    """The controller's node with its topics, services and actions: their types, directions, and what uses them.

    An arrow goes the way that data goes; a service or an action, asked and answering, has one with two heads.
    """
    nodes = [*_topics(graph), *_servers("s", "service", graph.serviceClients)]
    nodes += _servers("a", "action", graph.actionClients)
    controller = Node(_CONTROLLER, "controller", visible(controller_name(graph)))
    subscribed = {visible(subscription.topic) for subscription in graph.subscriptions}
    published = {visible(publisher.topic) for publisher in graph.publishers}
    arrows = []
    for node in nodes:
        comes = node.kind != "topic" or node.title in subscribed
        goes = node.kind != "topic" or node.title in published
        ends = (node.key, _CONTROLLER) if node.kind == "topic" and comes else (_CONTROLLER, node.key)
        arrows.append(Arrow(*ends, both=comes and goes))
    return Graph(f"{visible(graph.name)}: ROS graph", [Group("g", "", (), [*nodes, controller], arrows)])


def _topics(graph: rosgraph.RosGraph) -> Iterator[Node]:
    types: dict[str, dict[Label, None]] = {}
    uses: dict[str, list[Label]] = {}
    ends: list[tuple[str, rosgraph.Interface, Sequence[rosgraph.Reception | rosgraph.Sending]]]
    ends = [(end.topic, end.interface, end.receptions) for end in graph.subscriptions]
    ends += [(end.topic, end.interface, end.sendings) for end in graph.publishers]
    for topic, interface, messages in ends:
        types.setdefault(topic, {})[_type(interface)] = None
        uses.setdefault(topic, []).extend(map(_use, messages))
    for number, topic in enumerate(types, 1):
        yield Node(f"t{number}", "topic", visible(topic), [*types[topic], *uses[topic]])


def _servers(
    prefix: str, kind: str, clients: Iterable[rosgraph.ServiceClient | rosgraph.ActionClient]
) -> Iterator[Node]:
    for number, client in enumerate(clients, 1):
        rows = [_type(client.interface), _use(client.request)]
        yield Node(f"{prefix}{number}", kind, visible(client.identifier), rows)


def _type(interface: rosgraph.Interface) -> Label:
    return (visible(f"{interface.package}/{interface.type}"),)


def _use(use: rosgraph.Reception | rosgraph.Sending) -> Label:
    return (visible(plant_of(use.event).origin or use.name),)
