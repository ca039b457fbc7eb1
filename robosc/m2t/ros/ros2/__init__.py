"""ROS 2 packages: ament, launch files in Python, components, quality of service."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from robosc.language.configuration import quality
from robosc.language.configuration.quality import Profile, Quality
from robosc.m2t.ros.packages import controller_package, launch_path
from robosc.m2t.ros.values import BuildValues
from robosc.model.semantics.communication import QUEUE_DEPTH
from robosc.model.semantics.naming import below_layer

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping, Sequence

    from robosc.language.configuration import Configuration, ExistingController
    from robosc.m2t.ros.layer import LayerNode
    from robosc.m2t.ros.node import Client, GeneratedNode, Publisher, Subscription
    from robosc.m2t.ros.packages import UsedPackages
    from robosc.model import rosgraph

_FOLDERS = {"message": "msg", "service": "srv", "action": "action"}
#: Services and topics of an action. A layer remaps these, not the action's own name.
_ACTION = [f"_action/{part}" for part in ("send_goal", "cancel_goal", "get_result", "feedback", "status")]
_TESTED = ["launch_testing", "launch_testing_ament_cmake", "rclpy", "rosgraph_msgs"]
_PROFILES = {
    Profile.QUEUE: f"rclcpp::QoS({QUEUE_DEPTH})",
    Profile.SENSOR_DATA: "rclcpp::SensorDataQoS()",
    Profile.SERVICES: "rclcpp::ServicesQoS()",
}
_BUILD_TOOL = "ament_cmake"
_DURABILITY = {None: "", "volatile": ".durability_volatile()", "transient_local": ".transient_local()"}


@dataclass(frozen=True)
class Ros2Values(BuildValues):
    """Values of a ROS 2 package: packages of its message types, its libraries in CMake, and qualities of service.

    `kept_qos` is the quality of a topic whose publishers store messages; a controller has none if the configuration
    sets the durability.
    """

    messages: Sequence[str]
    libraries: Sequence[str]
    client_qos: Callable[[Client], str]
    kept_qos: Callable[[Subscription | Publisher], str]


@dataclass(frozen=True)
class ControllerValues(Ros2Values):
    """Values of a controller."""

    subscription_qos: Callable[[Subscription], str]
    publisher_qos: Callable[[Publisher], str]


@dataclass(frozen=True)
class LayerValues(Ros2Values):
    """Values of a layer: `names` are those that its launch file remaps for `controller`.

    `launch_path` is the launch file of the controller, `controller_side` the name of a topic towards the controller.
    """

    names: Sequence[str]
    controller: ExistingController
    launch_path: str
    controller_side: Callable[[str], str]
    received_qos: Callable[[Subscription | Publisher], str]
    sent_qos: Callable[[Subscription | Publisher], str]


class Ros2:
    """ROS 2, as a `robosc.m2t.ros.packages.Middleware`."""

    version: ClassVar[int] = 2
    launch_file: ClassVar[str] = ".launch.py"
    test_files: ClassVar[Mapping[str, str]] = {
        "Dockerfile": "Dockerfile.j2",
        "test/play_trace.py": "play_trace.py.j2",
        "test/test_trace.py": "test_trace.py.j2",
    }

    def header(self, interface: rosgraph.Interface) -> str:
        """Return the header of a type in rosidl's spelling (`LaserScan`: `sensor_msgs/msg/laser_scan.hpp`)."""
        words = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", interface.type)
        name = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", words).lower()
        return f"{interface.package}/{_FOLDERS[interface.kind.name]}/{name}.hpp"

    def controller(
        self, node: GeneratedNode, configuration: Configuration, used: UsedPackages, *, tests: bool
    ) -> ControllerValues:
        """Return the template values of a controller; see `Middleware`."""
        types = set(used.types)
        libraries, started = ["rclcpp"], ["launch", "launch_ros"]
        if node.actions or any(server.is_action for server in node.servers):
            libraries.append("rclcpp_action")
            types.add("action_msgs")
        if node.hands_on:
            libraries.append("rosidl_typesupport_introspection_cpp")
        if configuration.lifecycle:
            libraries.append("rclcpp_lifecycle")
            started.append("lifecycle_msgs")
        return ControllerValues(
            headers=self._headers(node, used.reports),
            build_tool=_BUILD_TOOL,
            dependencies=_dependencies(libraries, types),
            package_depends=_package_depends(libraries, types, started, _TESTED if tests else []),
            messages=sorted(types),
            libraries=[f"{library}::{library}" for library in libraries],
            client_qos=lambda client: _client(client, configuration),
            # Without a setting, the durability is that of the publisher.
            kept_qos=lambda topic: (
                "" if _reception(topic, configuration).settings.durability else _latched(topic, configuration)
            ),
            subscription_qos=lambda topic: _qos(_reception(topic, configuration)),
            publisher_qos=lambda topic: _qos(
                quality.transmission(topic.topic, configuration, on_change=topic.on_change)
            ),
        )

    def layer(self, layer: LayerNode, configuration: Configuration, used: UsedPackages) -> LayerValues:
        """Return the template values of a layer; see `Middleware`."""
        types = {*used.types, *(["action_msgs"] if layer.node.actions else [])}
        hands_on = (layer.instead or layer.node.limited) and layer.node.hands_on
        libraries = ["rclcpp", *(["rosidl_typesupport_introspection_cpp"] if hands_on else [])]
        started = {"launch", "launch_ros", *controller_package(configuration)}
        return LayerValues(
            headers=self._headers(layer.node, used.reports),
            build_tool=_BUILD_TOOL,
            dependencies=_dependencies(libraries, types),
            package_depends=_package_depends(libraries, types, started),
            messages=sorted(types),
            libraries=[f"{library}::{library}" for library in libraries],
            client_qos=lambda client: _client(client, configuration),
            # Relayed messages have the durability of the publisher.
            kept_qos=lambda topic: _latched(topic, configuration),
            names=layer.remapped(_ACTION),
            controller=configuration.supervisor.controller,
            launch_path=launch_path(configuration),
            controller_side=lambda name: f"~/{below_layer(name)}",
            received_qos=lambda topic: _qos(_reception(topic, configuration).volatile),
            sent_qos=lambda topic: _qos(quality.forwarding(topic.topic, configuration)),
        )

    def _headers(self, node: GeneratedNode, reports: Sequence[rosgraph.Interface]) -> list[str]:
        always = {"rclcpp/rclcpp.hpp", "rclcpp_components/register_node_macro.hpp"}
        return sorted({self.header(interface) for interface in [*node.interfaces, *reports]} | always)


def _dependencies(libraries: Sequence[str], types: set[str]) -> list[str]:
    """Return the packages that a node needs: its libraries and the packages of its types."""
    return sorted({*libraries, "rclcpp_components", *types})


def _package_depends(
    libraries: Sequence[str], types: set[str], started: Collection[str], tested: Sequence[str] = ()
) -> list[tuple[str, Sequence[str]]]:
    return [("", _dependencies(libraries, types)), ("exec_", sorted(started)), ("test_", tested)]


def _reception(topic: Subscription | Publisher, configuration: Configuration) -> Quality:
    return quality.reception(topic.interface, topic.topic, configuration)


def _latched(topic: Subscription | Publisher, configuration: Configuration) -> str:
    return _qos(_reception(topic, configuration).latched)


def _client(client: Client, configuration: Configuration) -> str:
    quality_of = quality.feedback if client.cancel else quality.service_calls
    return _qos(quality_of(client.name, configuration))


def _qos(quality: Quality) -> str:
    """Return a quality of service in C++."""
    chosen = quality.settings
    depth = f".keep_last({chosen.depth})" if chosen.depth else ""
    reliability = f".{chosen.reliability}()" if chosen.reliability else ""
    return _PROFILES[quality.profile] + depth + reliability + _DURABILITY[chosen.durability]
