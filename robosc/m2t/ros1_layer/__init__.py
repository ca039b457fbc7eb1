"""The supervisory layer as a ROS 1 package: a node with its build and launch files."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from robosc.m2t.layer import preconditions as shared
from robosc.m2t.layer.names import remapped
from robosc.m2t.layer.packages import Target, controller_package, package, type_packages
from robosc.m2t.roscpp import header
from robosc.semantics.naming import below_layer

if TYPE_CHECKING:
    from robosc.configuration import Configuration
    from robosc.diagnostics import Diagnostic
    from robosc.m2t.layer.node import LayerNode
    from robosc.m2t.models import Models

_TARGET = Target(
    "robosc.m2t.ros1_layer",
    ".launch",
    {
        "countdown.hpp": "services",
        "deadline.hpp": "actions",
        "event_queue.hpp": "services",
        "service_client.hpp": "services",
    },
    ("robosc.m2t.roscpp",),
)
#: The topics of an action.
_PARTS = ("goal", "cancel", "result", "feedback", "status")


def preconditions(models: Models, configuration: Configuration) -> list[Diagnostic]:
    """What keeps these models from becoming a layer with these settings, and settings without effect (warnings)."""
    found = shared.preconditions(models, configuration)
    launch = configuration.supervisor.controller.launch
    if launch and launch.file.endswith((".py", ".yaml")):
        key = ("supervisor", "controller", "launch", "file")
        message = f'"{launch.file}" is no launch file of ROS 1'
        found.append(configuration.error(key, message, 'name one in XML, or the node itself with "run"'))
    return found


def generate(models: Models, configuration: Configuration) -> dict[str, str]:
    """The files of the package, by their path in it. `preconditions` must have found nothing."""

    def values(layer: LayerNode) -> dict[str, Any]:
        types = type_packages(layer, configuration) | ({"actionlib_msgs"} if layer.actions else set())
        launched = configuration.supervisor.controller.launch
        return {
            "headers": _headers(layer, configuration),
            "dependencies": sorted({"rosconsole", "roscpp", *types}),
            "started": sorted(controller_package(configuration) - {"rosconsole", "roscpp", *types}),
            "names": [(each, below_layer(each)) for each in remapped(layer, _PARTS)],
            "launch_path": ""
            if launched is None
            else launched.file
            if "/" in launched.file
            else f"launch/{launched.file}",
            "controller_node": _node_name(configuration),
            "controller_side": lambda name: f"/{below_layer(name)}",
        }

    return package(_TARGET, models, configuration, values)


def _node_name(configuration: Configuration) -> str:
    """ROS 1 wants a name for the controller's node: the one in the configuration, else the executable's."""
    run = configuration.supervisor.controller.run
    return "" if run is None else run.name or re.sub(r"\W", "_", run.executable.partition(".")[0])


def _headers(layer: LayerNode, configuration: Configuration) -> list[str]:
    reports = {"std_msgs/String.h"} if layer.passages or configuration.publish_state_information else set()
    queue = {"ros/callback_queue.h"} if layer.services else set()
    return sorted({header(each) for each in layer.node.interfaces} | reports | queue | {"ros/ros.h"})
