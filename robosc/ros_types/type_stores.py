"""The message types of the two ROS as `rosbags` ships them."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from rosbags.typesys import Stores, get_typestore

from robosc.ros_types.definition_texts import converted
from robosc.ros_types.wire import Basic, Fields, Part

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

#: The last ROS 1, and the ROS 2 with long-term support.
_STORES = {"ROS 1": Stores.ROS1_NOETIC, "ROS 2": Stores.ROS2_JAZZY}
#: ROS 1's own types for time, which `rosbags` describes with the field names of ROS 2.
_TIMES: dict[str, Fields] = {
    "builtin_interfaces/msg/Time": {"sec": Basic("uint32"), "nsec": Basic("uint32")},
    "builtin_interfaces/msg/Duration": {"sec": Basic("int32"), "nsec": Basic("int32")},
}


@cache
def _store(ros: str) -> Typestore:
    return get_typestore(_STORES[ros])


def fields(ros: str, package: str, name: str, part: Part) -> Fields | None:
    """The fields of a message type of one of the two ROS; None where it is unknown. Services and actions are."""
    if part is not Part.MESSAGE:
        return None
    key = f"{package}/msg/{name}"
    if ros == "ROS 1" and key in _TIMES:
        return _TIMES[key]
    found = _store(ros).fielddefs.get(key)
    return None if found is None else converted(found[1])


def names(ros: str, package: str, kind: str) -> list[str]:
    """The names of all types of a kind of a package."""
    if kind != "message":
        return []
    return sorted(each.rpartition("/")[2] for each in _store(ros).fielddefs if each.startswith(f"{package}/"))


def packages(ros: str) -> set[str]:
    """The names of all packages with types."""
    return {key.partition("/")[0] for key in _store(ros).fielddefs}
