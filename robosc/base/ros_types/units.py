"""Units of ROS fields: from REP 103, and from comments in the definitions of ROS's own packages.

The unit of a field with a message type applies to all numbers in it, such as `linear` of a twist.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

_RADIANS, _METRES, _SECONDS = "rad", "m", "s"
_SPEED, _TURN = "m/s", "rad/s"

#: Units of fields, by the package and name of a type.
UNITS: Mapping[tuple[str, str], Mapping[str, str]] = {
    ("geometry_msgs", "Accel"): {"linear": "m/s²", "angular": "rad/s²"},
    ("geometry_msgs", "Inertia"): {"m": "kg"},
    ("geometry_msgs", "Point"): dict.fromkeys("xyz", _METRES),
    ("geometry_msgs", "Point32"): dict.fromkeys("xyz", _METRES),
    ("geometry_msgs", "Pose2D"): {"x": _METRES, "y": _METRES, "theta": _RADIANS},
    ("geometry_msgs", "Twist"): {"linear": _SPEED, "angular": _TURN},
    ("geometry_msgs", "Wrench"): {"force": "N", "torque": "N·m"},
    ("nav_msgs", "MapMetaData"): {"resolution": "m/cell"},
    ("sensor_msgs", "BatteryState"): {
        "voltage": "V",
        "temperature": "°C",
        "current": "A",
        "charge": "A·h",
        "capacity": "A·h",
        "design_capacity": "A·h",
        "cell_voltage": "V",
        "cell_temperature": "°C",
    },
    ("sensor_msgs", "FluidPressure"): {"fluid_pressure": "Pa", "variance": "Pa²"},
    ("sensor_msgs", "Illuminance"): {"illuminance": "lx"},
    ("sensor_msgs", "Imu"): {"angular_velocity": _TURN, "linear_acceleration": "m/s²"},
    ("sensor_msgs", "LaserScan"): {
        "angle_min": _RADIANS,
        "angle_max": _RADIANS,
        "angle_increment": _RADIANS,
        "time_increment": _SECONDS,
        "scan_time": _SECONDS,
        "range_min": _METRES,
        "range_max": _METRES,
        "ranges": _METRES,
    },
    ("sensor_msgs", "MagneticField"): {"magnetic_field": "T"},
    ("sensor_msgs", "NavSatFix"): {"latitude": "°", "longitude": "°", "altitude": _METRES},
    ("sensor_msgs", "Range"): {
        "field_of_view": _RADIANS,
        "min_range": _METRES,
        "max_range": _METRES,
        "range": _METRES,
        "variance": "m²",
    },
    ("sensor_msgs", "Temperature"): {"temperature": "°C", "variance": "°C²"},
}
