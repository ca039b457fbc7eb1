"""Passages of commands to a robot in a node graph: through the supervisory layer, and around it."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from enum import StrEnum
from itertools import chain
from typing import TYPE_CHECKING

from robosc.base.node_graph import KINDS, matches
from robosc.model.semantics.naming import below_layer

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.base.node_graph import Node, NodeGraph
    from robosc.model import rosgraph

#: Topics that every node may use.
_COMMON_TOPICS = {"/clock", "/diagnostics", "/parameter_events", "/rosout", "/tf", "/tf_static"}
#: Packages of the services that every node serves by itself.
_COMMON_SERVICES = {"rcl_interfaces", "type_description_interfaces"}
#: Types of data that sensors and maps send: no commands.
_SENSOR_PACKAGES = {"map_msgs", "rosgraph_msgs", "sensor_msgs", "tf2_msgs"}
_SENSOR_TYPES = {"nav_msgs/MapMetaData", "nav_msgs/OccupancyGrid", "nav_msgs/Odometry"}
_COMMAND_TYPES_OF_SENSORS = {"sensor_msgs/JointState", "sensor_msgs/Joy"}
_SENDS = {"topic": "publishes it", "service": "calls it", "action": "sends goals"}


class Outcome(StrEnum):
    """How commands reach the robot at one topic, service or action."""

    PASSES = "passes the layer"
    #: Another node sends commands, too.
    AROUND = "goes around"
    #: The model does not have it, and any node may use it.
    MISSING = "not in the model"
    #: The robot and the layer use different types.
    OTHER_TYPE = "other type"
    #: The model has it, but no layer sends it.
    NOT_SENT = "not sent by the layer"
    #: The model has it, but no node takes it.
    NOT_TAKEN = "not taken"
    #: Only the robot's own nodes send it.
    INTERNAL = "inside the robot"
    SENSOR = "sensor data"
    #: The robot and the layer both hear it: an emergency stop, for example. The model does not command it.
    HEARD = "heard by the layer"


#: Outcomes that leave a way around the layer.
OPEN = (Outcome.AROUND, Outcome.MISSING, Outcome.OTHER_TYPE, Outcome.NOT_SENT)


@dataclass(frozen=True)
class Passage:
    """Commands at one topic, service or action of the robot.

    `senders` are the nodes that send to the layer, `around` those that send to the robot, `takers` the robot's nodes.
    """

    kind: str
    name: str
    types: Sequence[str]
    outcome: Outcome
    senders: Sequence[str]
    around: Sequence[str]
    takers: Sequence[str]

    @property
    def is_open(self) -> bool:
        """Whether commands can reach the robot around the layer, or do not reach it at all."""
        return self.outcome in OPEN

    @property
    def evidence(self) -> str:
        """The nodes of the passage, in words."""
        to = f"to {_listed(self.takers)}" if self.takers else "no node takes it"
        match self.outcome:
            case Outcome.PASSES:
                return f"from {_listed(self.senders) or 'no node yet'} {to}"
            case Outcome.AROUND:
                return f"{_listed(self.around)} {_SENDS[self.kind]}"
            case Outcome.MISSING:
                users = f"{_listed(self.around)} {_SENDS[self.kind]}" if self.around else "no node uses it yet"
                return f"{users}; taken by {_listed(self.takers)}"
            case Outcome.OTHER_TYPE:
                return f"the layer sends {self.types[0]}; {_listed(self.takers)}: {', '.join(self.types[1:])}"
            case Outcome.NOT_SENT | Outcome.NOT_TAKEN:
                return to
        return f"from {_listed(self.around) or 'no node'} {to}"


@dataclass(frozen=True)
class Passages:
    """All passages to a robot, sorted: topics, services, actions. `layers` and `robot` are names of nodes."""

    layers: Sequence[str]
    robot: Sequence[str]
    passages: Sequence[Passage]

    @property
    def is_complete(self) -> bool:
        """Whether no command goes around the layer."""
        return not any(passage.is_open for passage in self.passages)

    def as_json(self, robot: str) -> str:
        """Return the passages as JSON, as `schemas/guard.schema.json` describes them."""
        answer = {
            "robot": robot,
            "complete": self.is_complete,
            "layers": self.layers,
            "robot_nodes": self.robot,
            "passages": [{**asdict(passage), "outcome": passage.outcome.name.lower()} for passage in self.passages],
        }
        return json.dumps(answer, indent=2) + "\n"


def passages(
    graph: rosgraph.RosGraph, nodes: NodeGraph, layer: str, robot: Sequence[str] = (), exceptions: Sequence[str] = ()
) -> Passages:
    """Return the passages of commands to a robot.

    `layer` is the name of the layer's node, in any namespace. `robot` are patterns of the robot's nodes; without them,
    they are the nodes that take a command of the model. `exceptions` are patterns of names to leave out.
    """
    layers = [node for node in nodes.nodes if node.name.rpartition("/")[2] == layer]
    spaces = [node.name.rpartition("/")[0] for node in layers] or [""]
    guarded = {
        (kind, resolved(name, space)): (type_name, name)
        for kind, name, type_name in commands(graph)
        for space in spaces
    }
    heard = {resolved(subscription.topic, space) for subscription in graph.subscriptions for space in spaces}
    others = [node for node in nodes.nodes if node not in layers]
    own = (
        nodes.named(robot)
        if robot
        else [node for node in others if any(name in node.taken(kind) for kind, name in guarded)]
    )
    own = [node for node in own if node not in layers]
    endpoints = sorted({*guarded, *endpoints_of(own)}, key=lambda each: (KINDS.index(each[0]), each[1]))
    result = []
    for kind, name in endpoints:
        if any(matches(name, pattern) for pattern in exceptions):
            continue
        if (kind, name) in guarded:
            type_name, model_name = guarded[kind, name]
            inside = [f"{node.name}/{below_layer(model_name)}" for node in layers]
            result.append(_guarded((kind, name, type_name), inside, layers, others))
        else:
            is_heard = kind == "topic" and name in heard
            result.append(_unguarded(kind, name, own, others, is_heard=is_heard))
    return Passages([node.name for node in layers], [node.name for node in own], result)


def commands(graph: rosgraph.RosGraph) -> list[tuple[str, str, str]]:
    """Return kind, name and type of each topic, service and action on which the model commands the robot."""
    topics = [("topic", publisher.topic, publisher.interface) for publisher in graph.publishers]
    services = [("service", client.identifier, client.interface) for client in graph.serviceClients]
    actions = [("action", client.identifier, client.interface) for client in graph.actionClients]
    return [(kind, name, f"{used.package}/{used.type}") for kind, name, used in chain(topics, services, actions)]


def resolved(name: str, namespace: str) -> str:
    """Return the full name of a topic, service or action of a node in a namespace, which has no `/` at its end."""
    return name if name.startswith("/") else f"{namespace}/{name}"


def endpoints_of(robot: Iterable[Node]) -> list[tuple[str, str]]:
    """Return kind and name of all topics, services and actions that the nodes take, except those of every node."""
    return sorted(
        {
            (kind, name)
            for node in robot
            for kind in KINDS
            for name, types in node.taken(kind).items()
            if not _is_common(kind, name, types)
        }
    )


def _is_common(kind: str, name: str, types: Sequence[str]) -> bool:
    if kind == "topic" and name in _COMMON_TOPICS:
        return True
    return kind == "service" and all(type_name.partition("/")[0] in _COMMON_SERVICES for type_name in types)


def is_sensor_data(types: Iterable[str]) -> bool:
    """Return whether all types are those of sensors and maps."""
    return all(
        type_name in _SENSOR_TYPES
        or (type_name.partition("/")[0] in _SENSOR_PACKAGES and type_name not in _COMMAND_TYPES_OF_SENSORS)
        for type_name in types
    )


def senders(kind: str, name: str, nodes: Iterable[Node]) -> list[str]:
    """Return the names of the nodes that publish a topic, or call a service or action."""
    return [node.name for node in nodes if name in node.sent(kind)]


def takers(kind: str, name: str, nodes: Iterable[Node]) -> Mapping[str, Sequence[str]]:
    """Return the types with which nodes take a topic, service or action, by the names of the nodes."""
    return {node.name: node.taken(kind)[name] for node in nodes if name in node.taken(kind)}


def _guarded(
    command: tuple[str, str, str], inside: Sequence[str], layers: Sequence[Node], others: Sequence[Node]
) -> Passage:
    kind, name, type_name = command
    around, taken = senders(kind, name, others), takers(kind, name, others)
    other_types = sorted({other for types in taken.values() for other in types if other != type_name})
    if around:
        outcome = Outcome.AROUND
    elif not senders(kind, name, layers):
        outcome = Outcome.NOT_SENT
    elif not taken:
        outcome = Outcome.NOT_TAKEN
    else:
        outcome = Outcome.OTHER_TYPE if other_types else Outcome.PASSES
    through = sorted({node for one in inside for node in senders(kind, one, others)})
    return Passage(kind, name, [type_name, *other_types], outcome, through, around, list(taken))


def _unguarded(
    kind: str, name: str, robot: Sequence[Node], others: Sequence[Node], *, is_heard: bool = False
) -> Passage:
    taken = takers(kind, name, robot)
    types = sorted({type_name for known in taken.values() for type_name in known})
    users = senders(kind, name, others)
    own = {node.name for node in robot}
    if kind == "topic" and is_sensor_data(types):
        outcome = Outcome.SENSOR
    elif users and own.issuperset(users):
        outcome = Outcome.INTERNAL
    else:
        outcome = Outcome.HEARD if is_heard else Outcome.MISSING
    return Passage(kind, name, types, outcome, [], users, list(taken))


def _listed(names: Sequence[str]) -> str:
    *others, last = names or [""]
    return f"{', '.join(others)} and {last}" if others else last
