"""Search for names in JSON data that are not fields of its ROS type."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from robosc.base.ros_types.wire import DefinitionError, NestedType, Section, Sequence

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.base.ros_types import RosDistribution, WireType


def unknown_field(
    distributions: Iterable[RosDistribution], package: str, name: str, section: Section, data: Any
) -> tuple[str, str | None] | None:
    """Return the fault of the first key in JSON data that is a field in no distribution, and a similar field.

    Returns None if all keys are fields, or if the type is unknown. `data` may lack fields; arrays are lists, or objects
    from index to element.
    """
    known = list(distributions)
    pending: list[tuple[WireType, Section, Any]] = [(NestedType(package, name), section, data)]
    while pending:
        wire, part, value = pending.pop()
        if isinstance(wire, Sequence):
            elements = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
            pending += ((wire.at(0), part, element) for element in elements)
        elif isinstance(wire, NestedType) and isinstance(value, dict):
            fields = _fields(known, wire, part)
            if fields is None:
                continue
            for key, inside in value.items():
                if key not in fields:
                    close = get_close_matches(key, fields, n=1)
                    return f"{wire} has no field `{key}`", close[0] if close else None
                pending.append((fields[key], Section.MESSAGE, inside))
    return None


def _fields(known: list[RosDistribution], wire: NestedType, section: Section) -> dict[str, WireType] | None:
    """Return the fields of a type in all distributions together, or None if no distribution has it."""
    merged: dict[str, WireType] | None = None
    for distribution in known:
        try:
            fields = distribution.fields(wire.package, wire.name, section)
        except DefinitionError:
            return None
        if fields is not None:
            merged = {**fields, **(merged or {})}
    return merged
