"""The node of a controller and what it is connected to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.diagnostics.visible import visible
from robosc.diagrams.graph import Arrow, Graph, Group, Node
from robosc.semantics.naming import controller_name
from robosc.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

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
    heard = {visible(subscription.topic) for subscription in graph.subscriptions}
    told = {visible(publisher.topic) for publisher in graph.publishers}
    arrows = []
    for node in nodes:
        comes = node.kind != "topic" or node.title in heard
        goes = node.kind != "topic" or node.title in told
        ends = (node.key, _CONTROLLER) if node.kind == "topic" and comes else (_CONTROLLER, node.key)
        arrows.append(Arrow(*ends, both=comes and goes))
    return Graph(f"{visible(graph.name)}: ROS graph", [Group("g", "", (), [*nodes, controller], arrows)])


def _topics(graph: rosgraph.RosGraph) -> Iterator[Node]:
    types: dict[str, dict[Label, None]] = {}
    uses: dict[str, list[Label]] = {}
    for heard in graph.subscriptions:
        types.setdefault(heard.topic, {})[_type(heard.interface)] = None
        uses.setdefault(heard.topic, []).extend(map(_use, heard.receptions))
    for told in graph.publishers:
        types.setdefault(told.topic, {})[_type(told.interface)] = None
        uses.setdefault(told.topic, []).extend(map(_use, told.sendings))
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
