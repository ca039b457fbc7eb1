"""What the controllers and the layers of ROS 1 share: clients that never block a node, headers of types."""

from __future__ import annotations

from robosc.metamodel import rosgraph


def header(interface: rosgraph.Interface) -> str:
    """The header of a type: `std_srvs/SetBool.h`, and of an action `nav2_msgs/NavigateToPoseAction.h`."""
    action = "Action" if interface.kind == rosgraph.InterfaceKind.action else ""
    return f"{interface.package}/{interface.type}{action}.h"
