"""ROS packages: controllers for ROS 1 and ROS 2, supervisory layers for ROS 2.

`include` holds C++ headers, the same for every package: `robosc` needs no middleware, `robosc_ros1` and `robosc_ros2`
connect it to one. `templates` print the parts that depend on the model; `ros1` and `ros2` hold the differences. This
package exports its targets.
"""

from __future__ import annotations

from robosc.m2t.ros.packages import RosTarget
from robosc.m2t.ros.ros1 import Ros1
from robosc.m2t.ros.ros2 import Ros2

__all__ = ["TARGETS"]

#: Generators by the names of their targets.
TARGETS = {
    "ros1": RosTarget("controller", Ros1()),
    "ros2": RosTarget("controller", Ros2()),
    "ros2-layer": RosTarget("layer", Ros2(), Ros2().layer),
}
