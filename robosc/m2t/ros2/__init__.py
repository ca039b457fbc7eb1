"""The controller as a ROS 2 package: a node, as a component and as an executable, with its build and launch files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.cpp.node import Node, Publisher, Subscription
from robosc.m2t.cpp.packages import Target, message_packages, package
from robosc.m2t.cpp.preconditions import preconditions
from robosc.m2t.rclcpp import header

if TYPE_CHECKING:
    from robosc.configuration import Configuration
    from robosc.m2t.models import Models, TraceTest

__all__ = ["generate", "preconditions"]

_FILES = {"config/{name}.yaml": "parameters.yaml.j2"}
_TEST_FILES = {
    "Dockerfile": "Dockerfile.j2",
    "test/play_trace.py": "play_trace.py.j2",
    "test/test_trace.py": "test_trace.py.j2",
}

_DEPTH = 10


def generate(models: Models, configuration: Configuration, tests: TraceTest | None = None) -> dict[str, str]:
    """The files of the package, by their path in it. `preconditions` must have found nothing."""
    graph = models.rosgraph
    assert graph is not None
    node = Node(graph, configuration.on_shutdown, configuration.on_withheld)
    own = ("callback_guard.hpp", "hangup.hpp", "shutdown_hook.hpp", "wiring.hpp")
    more = _FILES | (_TEST_FILES if tests else {})
    target = Target("robosc.m2t.ros2", ".launch.py", own, more, ("robosc.m2t.rclcpp",))
    messages = message_packages(node, configuration)
    libraries = {"rclcpp", "rclcpp_components"}
    if node.actions:
        libraries |= {"action_msgs", "rclcpp_action"}
        messages |= {"action_msgs"}
    if configuration.lifecycle:
        libraries |= {"rclcpp_lifecycle"}
    values = {
        "headers": _headers(node, configuration),
        "messages": sorted(messages),
        "dependencies": sorted(libraries | messages),
        "subscription_qos": lambda topic: _quality(topic, configuration, sensor=_is_sensor(topic)),
        "publisher_qos": lambda topic: _quality(topic, configuration, sensor=False),
        "service_qos": lambda client: _chosen("rclcpp::ServicesQoS()", client.name, configuration),
        "action_qos": lambda client: _chosen(f"rclcpp::QoS({_DEPTH})", client.name, configuration),
        "tests": tests,
    }
    files = package(target, graph, node, configuration, values)
    return files | ({f"test/{path}": text for path, text in tests.files.items()} if tests else {})


def _headers(node: Node, configuration: Configuration) -> list[str]:
    reports = {"std_msgs/msg/string.hpp"} if configuration.publish_state_information else set()
    own = {"rclcpp/rclcpp.hpp", "rclcpp_components/register_node_macro.hpp"}
    if configuration.lifecycle:
        own |= {"rclcpp_lifecycle/lifecycle_node.hpp", "rclcpp_lifecycle/lifecycle_publisher.hpp"}
    return sorted({header(each) for each in node.interfaces} | reports | own)


def _is_sensor(topic: Subscription) -> bool:
    return topic.interface.package == "sensor_msgs"


def _quality(topic: Subscription | Publisher, configuration: Configuration, *, sensor: bool) -> str:
    return _chosen("rclcpp::SensorDataQoS()" if sensor else f"rclcpp::QoS({_DEPTH})", topic.topic, configuration)


def _chosen(default: str, name: str, configuration: Configuration) -> str:
    """The quality of service of a communication, as C++: the default of its kind, and what the configuration says."""
    chosen = configuration.qos.get(name.removeprefix("/"))
    if chosen is None:
        return default
    durability = {None: None, "volatile": "durability_volatile", "transient_local": "transient_local"}
    settings = (chosen.reliability, durability[chosen.durability])
    depth = f".keep_last({chosen.depth})" if chosen.depth else ""
    return default + depth + "".join(f".{each}()" for each in settings if each)
