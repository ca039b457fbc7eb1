"""ROS types of `rosbags`, which parses definitions and ships the message types of both ROS versions.

Import this module only on demand: loading it takes a quarter of a second.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore
from rosbags.typesys.base import make_typesdict
from rosbags.typesys.msg import MSGParser

from robosc.base.ros_types.wire import (
    PRIMITIVES,
    Basic,
    DefinitionError,
    Fields,
    NestedType,
    Section,
    Sequence,
    Value,
    WireType,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

_SEPARATOR = re.compile(r"^---[ \t]*$", re.MULTILINE)
#: Field that the generators of ROS 2 add to types without fields; it is ignored.
_PLACEHOLDER = "structure_needs_at_least_one_member"
#: The last ROS 1, and the ROS 2 with long-term support.
_STORES = {"ROS 1": Stores.ROS1_NOETIC, "ROS 2": Stores.ROS2_JAZZY}
#: ROS 1's own types for time, which `rosbags` describes with the field names of ROS 2.
_TIMES: dict[str, Fields] = {
    "builtin_interfaces/msg/Time": Fields({"sec": Basic("uint32"), "nsec": Basic("uint32")}),
    "builtin_interfaces/msg/Duration": Fields({"sec": Basic("int32"), "nsec": Basic("int32")}),
}
#: The defaults in ROS 2's definitions of shipped types, which `rosbags` drops; ROS 1 has none.
_DEFAULTS: dict[str, dict[str, Value]] = {
    "geometry_msgs/msg/Quaternion": {"w": 1.0},
    "sensor_msgs/msg/NavSatStatus": {"status": -2},
}


def sections(text: str, package: str, count: int) -> list[Fields]:
    """Return the fields of each section of a `.msg` (one section), `.srv` (two) or `.action` (three).

    Types without a package are looked up in `package`. Raises DefinitionError.
    """
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    # A message may contain a comment that looks like a separator.
    texts = [text] if count == 1 else _SEPARATOR.split(text)
    if len(texts) != count:
        raise DefinitionError(f"it has {len(texts)} sections, expected {count} with `---` between them")
    return [_section(section, package) for section in texts]


def _section(text: str, package: str) -> Fields:
    name = f"{package}/msg/Section"
    try:
        (message,) = MSGParser(f"MSG: {name}\n{text}\n").specification()
        defaults = [field.value for field in message.fields]
        return _fields(*make_typesdict([message])[name], defaults)
    except TypesysError:
        for line in text.splitlines():
            try:
                get_types_from_msg(f"{line}\n", name)
            except TypesysError:
                raise DefinitionError(f"`{line.strip()}` is not a field") from None
        raise DefinitionError("it is not a list of fields") from None


def _fields(
    constants: Iterable[tuple[str, str, Any]], described: Iterable[tuple[str, Any]], defaults: Iterable[Any]
) -> Fields:
    fields = {
        name: _wire_type(description, default)
        for (name, description), default in zip(described, defaults, strict=True)
        if name != _PLACEHOLDER
    }
    values = {name: _value(kind, value) for name, kind, value in constants}
    return Fields(fields, {name: value for name, value in values.items() if value is not None})


def _wire_type(description: tuple[Nodetype, Any], default: Any = None) -> WireType:
    kind, details = description
    match kind:
        case Nodetype.BASE:
            return Basic(details[0], _value(details[0], default))
        case Nodetype.NAME:
            package, *_, name = details.split("/")
            # The parser treats `wstring` as a type of this package.
            return Basic(name) if name == "wstring" else NestedType(package, name)
        case Nodetype.ARRAY:
            length = details[1]
        case _:
            length = None
    element = _wire_type(details[0])
    if not isinstance(default, list) or not isinstance(element, Basic):
        return Sequence(element, length)
    values = [_value(element.name, value) for value in default]
    return Sequence(element, length, tuple(element.initial if value is None else value for value in values))


def _value(kind: str, default: Any) -> Value | None:
    """Return a default as a value of its type, or None if there is no default or ROS rejects it."""
    try:
        match PRIMITIVES[kind].name, default:
            case "string", str():
                return re.sub(r"\\(['\"])", r"\1", default.partition("#")[0].strip())
            case "boolean", bool() | 0 | 1:
                return bool(default)
            case "integer", int() if not isinstance(default, bool):
                return default
            case "double", int() | float():
                return float(default)
    except KeyError:
        pass
    return None


class ShippedTypes:
    """Message types that `rosbags` ships for one ROS version (`ROS 1`, `ROS 2`), without services and actions."""

    def __init__(self, ros: str) -> None:
        self._types: dict[str, Fields] = dict(_TIMES) if ros == "ROS 1" else {}
        self._defaults = _DEFAULTS if ros == "ROS 2" else {}
        self._described = get_typestore(_STORES[ros]).fielddefs

    def fields(self, package: str, name: str, section: Section) -> Fields | None:
        """Return the fields of a message type, or None if it is unknown."""
        key = f"{package}/msg/{name}"
        if section is not Section.MESSAGE or key not in self._described:
            return None
        if key not in self._types:
            (constants, described), defaults = self._described[key], self._defaults.get(key, {})
            self._types[key] = _fields(constants, described, [defaults.get(field) for field, _ in described])
        return self._types[key]

    def names(self, package: str, kind: str) -> list[str]:
        """Return the names of all types of a kind (`message`, `service`, `action`) in a package."""
        keys = self._described if kind == "message" else ()
        return [key.rpartition("/")[2] for key in keys if key.startswith(f"{package}/")]

    def packages(self) -> set[str]:
        """Return the names of all packages with types."""
        return {key.partition("/")[0] for key in self._described}
