"""The supervisory layer as a ROS 2 package: a component and an executable, with build and launch files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.configuration import QualityOfService
from robosc.m2t.layer.names import remapped
from robosc.m2t.layer.packages import Target, controller_package, package, type_packages
from robosc.m2t.layer.preconditions import preconditions
from robosc.m2t.rclcpp import header
from robosc.semantics.naming import below_layer

if TYPE_CHECKING:
    from robosc.configuration import Configuration
    from robosc.m2t.layer.node import Call, Inward, LayerNode, Outward
    from robosc.m2t.models import Models

__all__ = ["generate", "preconditions"]

_TARGET = Target(
    "robosc.m2t.ros2_layer",
    ".launch.py",
    {
        "callback_guard.hpp": "",
        "clock.hpp": "actions",
        "countdown.hpp": "services",
        "hangup.hpp": "",
        "service_client.hpp": "services",
    },
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
            "received_qos": lambda each: _received(each, configuration),
            "sent_qos": lambda each: f"rclcpp::QoS({_chosen(each.topic, configuration).depth or _DEPTH})",
            "service_qos": lambda each: _called("rclcpp::ServicesQoS()", each, configuration),
            "action_qos": lambda each: _called(f"rclcpp::QoS({_DEPTH})", each, configuration),
        }

    return package(_TARGET, models, configuration, values)


def _headers(layer: LayerNode, configuration: Configuration) -> list[str]:
    reports = {"std_msgs/msg/string.hpp"} if layer.passages or configuration.publish_state_information else set()
    own = {"rclcpp/rclcpp.hpp", "rclcpp_components/register_node_macro.hpp"}
    return sorted({header(each) for each in layer.node.interfaces} | reports | own)


def _chosen(name: str, configuration: Configuration) -> QualityOfService:
    """What the configuration says of a topic, service or action."""
    return configuration.qos.get(name.removeprefix("/")) or QualityOfService()


def _received(topic: Inward | Outward, configuration: Configuration) -> str:
    """The quality of service in which messages are received, as C++; their durability is that of who publishes."""
    chosen = _chosen(topic.topic, configuration)
    sensor = topic.interface.package == "sensor_msgs"
    return _changed("rclcpp::SensorDataQoS()" if sensor else f"rclcpp::QoS({_DEPTH})", chosen)


def _called(usual: str, call: Call, configuration: Configuration) -> str:
    """The quality of service towards the robot's service or action, as C++."""
    chosen = _chosen(call.name, configuration)
    durability = {None: "", "volatile": ".durability_volatile()", "transient_local": ".transient_local()"}
    return _changed(usual, chosen) + durability[chosen.durability]


def _changed(usual: str, chosen: QualityOfService) -> str:
    depth = f".keep_last({chosen.depth})" if chosen.depth else ""
    return usual + depth + (f".{chosen.reliability}()" if chosen.reliability else "")
