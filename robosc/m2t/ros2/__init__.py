"""The controller as a ROS 2 package: a node, as a component and as an executable, with its build and launch files."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robosc.m2t.cpp.node import Node, Publisher, Subscription
from robosc.m2t.cpp.packages import Target, message_packages, package
from robosc.m2t.cpp.preconditions import preconditions

if TYPE_CHECKING:
    from robosc.config import Configuration
    from robosc.metamodel import rosgraph
    from robosc.models import Models

__all__ = ["generate", "preconditions"]

_TARGET = Target("robosc.m2t.ros2", launch_file=".launch.py")

_DEPTH = 10


def generate(models: Models, configuration: Configuration) -> dict[str, str]:
    """The files of the package, by their path in it. `preconditions` must have found nothing."""
    graph = models.rosgraph
    assert graph is not None
    node = Node(graph)
    messages = message_packages(node, configuration)
    values = {
        "headers": _headers(node, configuration),
        "messages": sorted(messages),
        "dependencies": sorted({"rclcpp", "rclcpp_components", *messages}),
        "subscription_qos": lambda topic: _quality(topic, configuration, sensor=_is_sensor(topic)),
        "publisher_qos": lambda topic: _quality(topic, configuration, sensor=False),
    }
    return package(_TARGET, graph, node, configuration, values)


def header(interface: rosgraph.Interface) -> str:
    """The header of a message type, in the spelling of rosidl (`LaserScan`: `sensor_msgs/msg/laser_scan.hpp`)."""
    words = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", interface.type)
    name = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", words).lower()
    return f"{interface.package}/msg/{name}.hpp"


def _headers(node: Node, configuration: Configuration) -> list[str]:
    reports = {"std_msgs/msg/string.hpp"} if configuration.publish_state_information else set()
    own = {"rclcpp/rclcpp.hpp", "rclcpp_components/register_node_macro.hpp"}
    return sorted({header(each) for each in node.interfaces} | reports | own)


def _is_sensor(topic: Subscription) -> bool:
    return topic.interface.package == "sensor_msgs"


def _quality(topic: Subscription | Publisher, configuration: Configuration, *, sensor: bool) -> str:
    """The quality of service of a topic, as C++; what the configuration says of the topic goes first."""
    text = "rclcpp::SensorDataQoS()" if sensor else f"rclcpp::QoS({_DEPTH})"
    chosen = configuration.qos.get(topic.topic.removeprefix("/"))
    if chosen is None:
        return text
    durability = {None: None, "volatile": "durability_volatile", "transient_local": "transient_local"}
    settings = (chosen.reliability, durability[chosen.durability])
    depth = f".keep_last({chosen.depth})" if chosen.depth else ""
    return text + depth + "".join(f".{each}()" for each in settings if each)
