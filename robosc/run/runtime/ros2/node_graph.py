"""The node graph of the running ROS 2 system."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from robosc.base.node_graph import NodeGraph, node_graph
from robosc.run.runtime.ros2.node import start

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.base.node_graph import Endpoint

_NAME = "robosc_graph"
#: Seconds between two looks at the graph, seconds without a change until it is complete, and seconds at most.
#: Nodes announce themselves again every 3 s, so a busy computer may show nothing new for that long.
_LOOK, _QUIET, _LONGEST = 0.2, 4.0, 15.0
#: Part of the name of a node that the middleware has not discovered yet.
_UNKNOWN = "UNKNOWN"


def read_running() -> NodeGraph:
    """Return the graph as soon as it has not changed for four seconds, or after 15 s.

    The reader itself is left out. Raises StartError if ROS 2 does not start.
    """
    import rclpy  # noqa: PLC0415  # `start` reports whether it is missing

    node = start(_NAME, [])
    try:
        began = changed = time.monotonic()
        graph = _look(node)
        while time.monotonic() < min(changed + _QUIET, began + _LONGEST):
            time.sleep(_LOOK)
            before, graph = graph, _look(node)
            if graph != before or any(_UNKNOWN in each.name for each in graph.nodes):
                changed = time.monotonic()
        return graph
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def _look(node: Any) -> NodeGraph:
    own = node.get_fully_qualified_name()
    names = [_full_name(name, space) for name, space in node.get_node_names_and_namespaces()]
    endpoints = [endpoint for endpoint in [*_topics(node), *_services(node)] if endpoint[0] != own]
    return node_graph([name for name in names if name != own], endpoints)


def _topics(node: Any) -> Iterator[Endpoint]:
    """Yield publishers and subscriptions, also those of programs without a node."""
    for topic, _ in node.get_topic_names_and_types():
        for part in ("publishers", "subscribers"):
            known = node.get_publishers_info_by_topic if part == "publishers" else node.get_subscriptions_info_by_topic
            for info in known(topic):
                yield _full_name(info.node_name, info.node_namespace), part, topic, info.topic_type


def _services(node: Any) -> Iterator[Endpoint]:
    from rclpy.node import NodeNameNonExistentError  # noqa: PLC0415

    for name, space in node.get_node_names_and_namespaces():
        try:
            served = node.get_service_names_and_types_by_node(name, space)
            called = node.get_client_names_and_types_by_node(name, space)
        except NodeNameNonExistentError:
            continue  # it has just gone
        for part, services in (("service_servers", served), ("service_clients", called)):
            for service, types in services:
                for kind in types:
                    yield _full_name(name, space), part, service, kind


def _full_name(name: str, space: str) -> str:
    """Return the full name of a node. A program without a node, or an unknown node, has no namespace."""
    return f"{space.rstrip('/')}/{name}" if space.startswith("/") else f"/{name}"
