"""Reads the text of a ROS definition and what `rosbags` made of one."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from rosbags.interfaces import Nodetype
from rosbags.typesys import TypesysError, get_types_from_msg

from robosc.ros_types.wire import Basic, DefinitionError, Nested, Sequence

if TYPE_CHECKING:
    from robosc.ros_types.wire import Fields, WireType

_SEPARATOR = re.compile(r"^---[ \t]*$", re.MULTILINE)
#: ROS 2's generators fill types that have no field with one; nobody means it.
_PLACEHOLDER = "structure_needs_at_least_one_member"


def sections(text: str, package: str, count: int) -> list[Fields]:
    """The fields of each section of a `.msg` (one section), `.srv` (two) or `.action` (three).

    `package` is where types without package are looked for. Raises DefinitionError.
    """
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    # A message may have a comment that looks like a separator.
    parts = [text] if count == 1 else _SEPARATOR.split(text)
    if len(parts) != count:
        raise DefinitionError(f"it has {len(parts)} sections, expected {count} with `---` between them")
    return [_section(part, package) for part in parts]


def _section(text: str, package: str) -> Fields:
    name = f"{package}/msg/Section"
    try:
        return converted(get_types_from_msg(f"{text}\n", name)[name][1])
    except TypesysError:
        for line in text.splitlines():
            try:
                get_types_from_msg(f"{line}\n", name)
            except TypesysError:
                raise DefinitionError(f"`{line.strip()}` is no field") from None
        raise DefinitionError("it is no list of fields") from None


def converted(fields: list[tuple[str, Any]]) -> Fields:
    """The fields as `rosbags` describes them."""
    return {name: _wire_type(description) for name, description in fields if name != _PLACEHOLDER}


def _wire_type(description: tuple[Nodetype, Any]) -> WireType:
    kind, details = description
    match kind:
        case Nodetype.BASE:
            return Basic(details[0])
        case Nodetype.NAME:
            package, *_, name = details.split("/")
            # The parser takes it for a type of the package at hand.
            return Basic(name) if name == "wstring" else Nested(package, name)
        case Nodetype.ARRAY:
            return Sequence(_wire_type(details[0]), details[1])
    return Sequence(_wire_type(details[0]))
