"""The supervisory layer as a ROS 2 package: a component and an executable, with build and launch files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.m2t.layer.names import below_layer, remapped
from robosc.m2t.layer.packages import Target, controller_package, package, type_packages
from robosc.m2t.layer.preconditions import preconditions
from robosc.m2t.rclcpp import header

if TYPE_CHECKING:
    from robosc.config import Configuration
    from robosc.m2t.layer.node import Inward, LayerNode, Outward
    from robosc.models import Models

__all__ = ["generate", "preconditions"]

_TARGET = Target(
    "robosc.m2t.ros2_layer",
    ".launch.py",
    {"clock.hpp": "actions", "countdown.hpp": "services", "service_client.hpp": "services"},
    ("robosc.m2t.rclcpp",),
)
#: The services and topics of an action (they are re-mapped, the action's own name is not).
_PARTS = [f"_action/{each}" for each in ("send_goal", "cancel_goal", "get_result", "feedback", "status")]
_DEPTH = 10


def generate(models: Models, configuration: Configuration) -> dict[str, str]:
    """The files of the package, by their path in it. `preconditions` must have found nothing."""

    def values(layer: LayerNode) -> dict[str, Any]:
        types = type_packages(layer, configuration) | ({"action_msgs"} if layer.actions else set())
        controller = configuration.supervisor.controller
        launched = controller.launch.file if controller.launch else ""
        return {
            "headers": _headers(layer, configuration),
            "messages": sorted(types),
            "dependencies": sorted({"rclcpp", "rclcpp_components", *types}),
            "started": sorted({"launch", "launch_ros", *controller_package(configuration)}),
            "names": remapped(layer, _PARTS),
            "launch_path": launched if "/" in launched else f"launch/{launched}",
            "controller_side": lambda name: f"~/{below_layer(name)}",
            "received_qos": lambda each: _quality(each, configuration, sensor=each.interface.package == "sensor_msgs"),
            "sent_qos": lambda each: _quality(each, configuration),
        }

    return package(_TARGET, models, configuration, values)


def _headers(layer: LayerNode, configuration: Configuration) -> list[str]:
    reports = {"std_msgs/msg/string.hpp"} if layer.passages or configuration.publish_state_information else set()
    own = {"rclcpp/rclcpp.hpp", "rclcpp_components/register_node_macro.hpp"}
    return sorted({header(each) for each in layer.node.interfaces} | reports | own)


def _quality(topic: Inward | Outward, configuration: Configuration, *, sensor: bool = False) -> str:
    """The quality of service in which messages are received, or (reliable) handed on, as C++.

    Durability is taken over from who publishes; the configuration says the rest, if it does.
    """
    text = "rclcpp::SensorDataQoS()" if sensor else f"rclcpp::QoS({_DEPTH})"
    chosen = configuration.qos.get(topic.topic.removeprefix("/"))
    if chosen is None:
        return text
    depth = f".keep_last({chosen.depth})" if chosen.depth else ""
    return text + depth + (f".{chosen.reliability}()" if chosen.reliability else "")
