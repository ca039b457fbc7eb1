"""The controller as a ROS 1 package: a node with its build and launch files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2t.cpp.node import Node
from robosc.m2t.cpp.packages import Target, message_packages, package
from robosc.m2t.cpp.preconditions import preconditions

if TYPE_CHECKING:
    from robosc.config import Configuration
    from robosc.models import Models

__all__ = ["generate", "preconditions"]

_TARGET = Target("robosc.m2t.ros1", launch_file=".launch")


def generate(models: Models, configuration: Configuration) -> dict[str, str]:
    """The files of the package, by their path in it. `preconditions` must have found nothing."""
    graph = models.rosgraph
    assert graph is not None
    node = Node(graph)
    headers = {f"{each.package}/{each.type}.h" for each in node.interfaces} | {"ros/ros.h"}
    if configuration.publish_state_information:
        headers.add("std_msgs/String.h")
    values = {
        "headers": sorted(headers),
        "dependencies": sorted({"roscpp", *message_packages(node, configuration)}),
    }
    return package(_TARGET, graph, node, configuration, values)
