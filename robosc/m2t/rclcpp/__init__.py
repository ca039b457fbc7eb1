"""What the controllers and the layers of ROS 2 share: clients, parameters, headers of types."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.metamodel import rosgraph

_FOLDERS = {"message": "msg", "service": "srv", "action": "action"}


def header(interface: rosgraph.Interface) -> str:
    """The header of a type, in the spelling of rosidl (`LaserScan`: `sensor_msgs/msg/laser_scan.hpp`)."""
    words = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", interface.type)
    name = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", words).lower()
    return f"{interface.package}/{_FOLDERS[interface.kind.name]}/{name}.hpp"
