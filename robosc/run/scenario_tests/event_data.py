"""Data in the lines of scenarios: the form of incoming data, and the comparison with sent data."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from robosc.analysis.explain import NamingError
from robosc.base.ros_types import Section, wire
from robosc.run.node_tests.messages import Record, new_value
from robosc.run.node_tests.trace_player import same

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.base.ros_types import RosDistribution
    from robosc.run.node_tests.samples import LoggedValue


#: Types of fields that the node sets itself.
_OF_THE_MOMENT = ("builtin_interfaces/Time", "std_msgs/Header")


def is_raw(reads: Sequence[LoggedValue], data: Any) -> bool:
    """Return whether data has the fields of the ROS message, not what the event log has in their place.

    The event log has literals for enums, and lists for arrays that the model reads as a whole. Raises NamingError for
    data with both, and for a lone value in the place of a literal.
    """
    values = [(message_read, _value_at(data, message_read.path)) for message_read in reads]
    raw = [
        value
        for message_read, value in values
        if value is not None
        and (
            not isinstance(value, str)
            if message_read.conversion is not None
            else isinstance(value, dict) and bool(value) and all(name.isdigit() for name in value)
        )
    ]
    has_literals = any(message_read.conversion is not None and isinstance(value, str) for message_read, value in values)
    if raw and (has_literals or not isinstance(data, dict)):
        raise NamingError(
            f"{json.dumps(raw[0])} is ROS data instead of a literal", "write `with message {…}` with all fields"
        )
    return bool(raw)


def _value_at(data: Any, path: Sequence[str]) -> Any:
    """Return the value at a path of fields and indices; None if there is none. A lone value has every path."""
    for step in path:
        if isinstance(data, list):
            data = data[int(step)] if step.isdigit() and int(step) < len(data) else None
        elif isinstance(data, dict):
            data = data.get(step)
    return data


def by_index(value: Any, reads: Sequence[Sequence[str]]) -> Any:
    """Return data in which objects from index to element replace lists whose elements are read one by one."""
    if isinstance(value, list) and any(path and path[0].isdigit() for path in reads):
        value = {str(index): element for index, element in enumerate(value)}
    if not isinstance(value, dict):
        return value
    below = {name: [path[1:] for path in reads if path and path[0] == name] for name in value}
    return {name: by_index(inner, below[name]) for name, inner in value.items()}


def agrees(expected: Any, actual: Any) -> bool:
    """Return whether data has the expected values; fields that are not named may have any value.

    A single value is the same as an object with it as the only field, such as `0.5` and `{"data": 0.5}`.
    """
    if isinstance(actual, dict) and not isinstance(expected, dict):
        return len(actual) == 1 and _has(expected, next(iter(actual.values())))
    return _has(expected, actual)


def _has(expected: Any, actual: Any) -> bool:
    if isinstance(expected, dict) and isinstance(actual, dict):
        return all(name in actual and _has(value, actual[name]) for name, value in expected.items())
    if isinstance(expected, list) and isinstance(actual, list):
        return len(expected) == len(actual) and all(map(_has, expected, actual))
    return same(expected, actual)


def plain(value: Any) -> Any:
    """Return data of ROS as JSON."""
    if isinstance(value, Record):
        return {name: plain(inner) for name, inner in vars(value).items() if name != "wire_types"}
    return [plain(inner) for inner in value] if isinstance(value, list) else value


def sent_data(entry: Mapping[str, Any], message: Any) -> Any:
    """Return the data of a line of the log; an object also has the objects that are forwarded unchanged."""
    logged = entry.get("data", {}).get("value")
    return plain(message) if isinstance(logged, dict) else logged


def with_defaults(
    distribution: RosDistribution, kind: wire.WireType, section: Section, value: Any, forwarded: Sequence[Sequence[str]]
) -> Any:
    """Return sent data of a type with the defaults of ROS in all fields that the node does not set.

    Objects at the paths `forwarded` have no defaults: the data shows only their known fields.
    """
    if any(not path for path in forwarded):
        return value
    if isinstance(kind, wire.Sequence) and isinstance(value, list):
        return [with_defaults(distribution, kind.element, Section.MESSAGE, element, ()) for element in value]
    if not isinstance(kind, wire.NestedType) or not isinstance(value, dict):
        return value
    try:
        fields = distribution.fields(kind.package, kind.name, section) or wire.Fields({})
    except wire.DefinitionError:
        fields = wire.Fields({})
    whole = dict(value)
    for name, field in fields.items():
        if name in value:
            inner = [path[1:] for path in forwarded if path[0] == name]
            whole[name] = with_defaults(distribution, field, Section.MESSAGE, value[name], inner)
        elif str(field) not in _OF_THE_MOMENT:
            whole[name] = plain(new_value(field, Section.MESSAGE, distribution))
    return whole


def with_expected_defaults(sent: Any, whole: Any, expected: Any) -> Any:
    """Return sent data with the defaults of the expected fields; `whole` has all defaults."""
    if not isinstance(whole, dict) or not isinstance(expected, dict):
        return whole if sent is None else sent
    fields = sent if isinstance(sent, dict) else {} if sent is None else whole
    names = [name for name in expected if name in whole]
    return {
        **fields,
        **{name: with_expected_defaults(fields.get(name), whole[name], expected[name]) for name in names},
    }


def first_unknown(expected: Any, actual: Any, handed_on: Sequence[Sequence[str]], path: tuple[str, ...] = ()) -> str:
    """Return the first expected field that is missing in forwarded data, as `pose.position`; empty if there is none."""
    if isinstance(expected, dict) and isinstance(actual, dict):
        for name, value in expected.items():
            inside = (*path, name)
            if name in actual:
                unknown = first_unknown(value, actual[name], handed_on, inside)
            else:
                unknown = ".".join(inside) if any(inside[: len(way)] == way for way in handed_on) else ""
            if unknown:
                return unknown
    return ""
