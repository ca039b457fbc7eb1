"""Commands of a robot in a node graph."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.analysis.passages import endpoints_of, is_sensor_data, senders, takers
from robosc.base.node_graph import KINDS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.base.node_graph import Node, NodeGraph

#: Types of commands, for robots whose nodes are unknown.
COMMAND_TYPES = {
    "topic": (
        "ackermann_msgs/AckermannDrive",
        "ackermann_msgs/AckermannDriveStamped",
        "control_msgs/JointJog",
        "geometry_msgs/Twist",
        "geometry_msgs/TwistStamped",
        "std_msgs/Float64MultiArray",
        "trajectory_msgs/JointTrajectory",
        "trajectory_msgs/MultiDOFJointTrajectory",
    ),
    "service": (),
    "action": (
        "control_msgs/FollowJointTrajectory",
        "control_msgs/GripperCommand",
        "control_msgs/ParallelGripperCommand",
        "nav2_msgs/DockRobot",
        "nav2_msgs/FollowWaypoints",
        "nav2_msgs/NavigateThroughPoses",
        "nav2_msgs/NavigateToPose",
        "nav2_msgs/UndockRobot",
    ),
}
_POSE = "geometry_msgs/PoseWithCovarianceStamped"


@dataclass(frozen=True)
class Suggestion:
    """Commands of the robot as NAME:TYPE, the topic of its localization, and what is left out, in words."""

    topics: tuple[str, ...]
    services: tuple[str, ...]
    actions: tuple[str, ...]
    pose: str | None
    left_out: tuple[str, ...]


def suggestion(graph: NodeGraph, robot: Sequence[str]) -> Suggestion:
    """Return the commands that the nodes of a robot take.

    `robot` are patterns of these nodes. Without them, the commands are those of `COMMAND_TYPES`. A topic of them counts
    only if a node takes it and publishes no such topic: others, such as smoothers, only pass commands on.
    """
    own = graph.named(robot) if robot else list(graph.nodes)
    chosen: dict[str, list[str]] = {kind: [] for kind in KINDS}
    left_out = []
    for kind, name in endpoints_of(own):
        taken = takers(kind, name, own)
        type_name = min(known for types in taken.values() for known in types)
        if not robot and type_name not in COMMAND_TYPES[kind]:
            continue
        reason = _reason(graph, own, (kind, name, type_name)) if robot else _passed_on(kind, name, own)
        if reason:
            left_out.append(f"{kind} {name} ({type_name}): {reason}")
        else:
            chosen[kind].append(f"{name}:{type_name}")
    poses = [name for node in graph.nodes for name, types in node.publishers.items() if _POSE in types]
    poses = sorted(name for name in poses if not name.endswith("initialpose"))
    topics, services, actions = (tuple(chosen[kind]) for kind in KINDS)
    return Suggestion(topics, services, actions, poses[0] if poses else None, tuple(left_out))


def _reason(graph: NodeGraph, own: Sequence[Node], endpoint: tuple[str, str, str]) -> str | None:
    """Return why an endpoint of the robot is no command, or None if it is one."""
    kind, name, type_name = endpoint
    if kind == "topic" and is_sensor_data([type_name]):
        return "sensor data"
    users = senders(kind, name, graph.nodes)
    return "inside the robot" if users and {node.name for node in own}.issuperset(users) else None


def _passed_on(kind: str, name: str, nodes: Sequence[Node]) -> str | None:
    """Return why a topic of commands does not lead to the robot, or None if it does."""
    ends = [node for node in nodes if name in node.taken(kind) and not _passes_on(kind, name, node)]
    return None if ends else "its nodes pass commands on"


def _passes_on(kind: str, name: str, node: Node) -> bool:
    """Return whether a node also sends commands: of any type on topics, of the same type to actions."""
    sent = COMMAND_TYPES[kind] if kind == "topic" else node.taken(kind)[name]
    return any(known in sent for types in node.sent(kind).values() for known in types)
