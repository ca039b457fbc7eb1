"""Nodes of a running ROS system with their topics, services and actions.

`reading` reads them from a JSON file. `robosc.run.runtime.ros2.node_graph` reads them from ROS 2.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

#: Types by the names of topics, services or actions.
Types: TypeAlias = "Mapping[str, Sequence[str]]"
#: The name of a node, one of `PARTS`, a name and a type.
Endpoint: TypeAlias = tuple[str, str, str, str]

#: The fields of a node.
PARTS = ("publishers", "subscribers", "service_servers", "service_clients", "action_servers", "action_clients")
KINDS = ("topic", "service", "action")
#: The parts in which a node takes commands, and those in which it sends them.
_TAKEN = {"topic": "subscribers", "service": "service_servers", "action": "action_servers"}
_SENT = {"topic": "publishers", "service": "service_clients", "action": "action_clients"}
#: Names of an action's services and topics, the service that takes its goals, and the end of its type.
_OF_ACTION, _SEND_GOAL, _SEND_GOAL_TYPE = "/_action/", "/_action/send_goal", "_SendGoal"
_PARTS_OF_ACTIONS = {"send_goal", "cancel_goal", "get_result", "feedback", "status"}


@dataclass(frozen=True)
class Node:
    """A node: its full name, and the types of its topics, services and actions, such as `geometry_msgs/Twist`."""

    name: str
    publishers: Types = field(default_factory=dict)
    subscribers: Types = field(default_factory=dict)
    service_servers: Types = field(default_factory=dict)
    service_clients: Types = field(default_factory=dict)
    action_servers: Types = field(default_factory=dict)
    action_clients: Types = field(default_factory=dict)

    def taken(self, kind: str) -> Types:
        """Return the topics that the node subscribes to, or the services or actions that it serves."""
        types: Types = getattr(self, _TAKEN[kind])
        return types

    def sent(self, kind: str) -> Types:
        """Return the topics that the node publishes, or the services or actions that it calls."""
        types: Types = getattr(self, _SENT[kind])
        return types


@dataclass(frozen=True)
class NodeGraph:
    """The nodes of a running ROS system, sorted by name. Nodes of one name are one node."""

    nodes: Sequence[Node]

    def named(self, patterns: Sequence[str]) -> list[Node]:
        """Return the nodes whose full names match a pattern, such as `/base` or `/arm/*`."""
        return [node for node in self.nodes if any(matches(node.name, pattern) for pattern in patterns)]

    def as_json(self) -> str:
        """Return the graph as JSON, as `schemas/node-graph.schema.json` describes it."""
        nodes = [{key: value for key, value in asdict(node).items() if value} for node in self.nodes]
        return json.dumps({"nodes": nodes}, indent=2) + "\n"


def node_graph(names: Iterable[str], endpoints: Iterable[Endpoint]) -> NodeGraph:
    """Return the graph of nodes and endpoints, as ROS names them.

    The services and topics of actions become actions. Everything is sorted, so that equal graphs have equal texts.
    """
    nodes: dict[str, dict[str, dict[str, set[str]]]] = {name: {} for name in names}
    for node, part, name, kind in endpoints:
        own, own_part, own_type = name, part, short_type(kind)
        if name.partition(_OF_ACTION)[2] in _PARTS_OF_ACTIONS:
            if not name.endswith(_SEND_GOAL) or not part.startswith("service"):
                continue
            own, own_part = name.removesuffix(_SEND_GOAL), part.replace("service", "action")
            own_type = own_type.removesuffix(_SEND_GOAL_TYPE)
        nodes.setdefault(node, {}).setdefault(own_part, {}).setdefault(own, set()).add(own_type)
    return NodeGraph([_node(name, parts) for name, parts in sorted(nodes.items())])


def _node(name: str, parts: Mapping[str, Mapping[str, Iterable[str]]]) -> Node:
    return Node(name, **{part: {own: sorted(known) for own, known in sorted(parts[part].items())} for part in parts})


def short_type(name: str) -> str:
    """Return a type as models name it: `geometry_msgs/Twist` for `geometry_msgs/msg/Twist`."""
    package, *_, kind = name.split("/")
    return f"{package}/{kind}"


def matches(name: str, pattern: str) -> bool:
    """Return whether a name matches a pattern with `*`. The leading `/` of the pattern may be missing."""
    return fnmatchcase(name, pattern if pattern.startswith(("/", "*")) else f"/{pattern}")
