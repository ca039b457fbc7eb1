"""The data of events in scripts and traces, as the inputs of the supervisor that it means."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final

from robosc.engine.state import Domain
from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct
from robosc.roles import Roles, event_name
from robosc.runtime.node_data import NodeData

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.engine import Engine
    from robosc.engine.state import Value

#: What JSON text says nothing about.
_ABSENT: Final = object()


class DataError(Exception):
    """Data that an event can't come with."""


class EventData:
    """Reads the data of events: `{"value": ...}`, in the shape of the event log.

    Basic data is the value itself, an object has fields, an array is a list or an object from index to element; in the
    place of data that an enumeration is made of there may be the name of a literal. What is left out is as ROS leaves
    it: 0, false, the literal of `otherwise`. Without a ROS graph data goes to inputs by their names.
    """

    def __init__(self, engine: Engine, graph: rosgraph.RosGraph | None) -> None:
        self._events = {event_name(each): each for each in Roles(engine.model).events}
        self._node = None if graph is None else NodeData(graph, engine)
        self._assignments = {} if graph is None else dict(_assignments(graph))

    def inputs(self, event: str, data: Mapping[str, Any]) -> dict[str, Value]:
        """Values of the event's inputs by their names. Raises DataError, KeyError for an unknown event."""
        declared = self._events[event]
        unknown = sorted(set(data) - {"value"})
        if unknown:
            raise DataError(f'"{unknown[0]}" is no data of an event: write {{"value": ...}}')
        if data and not declared.inputs:
            return {}  # the node keeps it, or nobody does
        value = data.get("value", _ABSENT)
        found = {}
        for each in declared.inputs:
            domain = Domain.of(each.type)
            try:
                found[each.name] = domain.shown(domain.internal(self._value(each, value)))
            except ValueError as error:
                raise DataError(f"{_label(each)}: {error}") from None
        return found

    def shaped(self, event: str, values: Mapping[str, Value]) -> dict[str, Any]:
        """Data with which the event's inputs have these values, by their names."""
        paths = {self._path(each): values[each.name] for each in self._events[event].inputs}
        if not paths:
            return {}
        if len(paths) == 1 and len(next(iter(paths))) < 2:
            return {"value": next(iter(paths.values()))}
        whole: dict[str, Any] = {}
        for path, value in paths.items():
            inner = whole
            for name in path[:-1]:
                inner = inner.setdefault(name, {})
            inner[path[-1]] = value
        return {"value": whole}

    def _path(self, each: sct.Input) -> tuple[str, ...]:
        """Where the data of an input stands in that of its event."""
        assignment = self._assignments.get(each)
        if assignment is None:
            return tuple(_words(each))
        access = _access(assignment)
        return tuple(map(_field, access.steps))

    def _value(self, each: sct.Input, data: Any) -> Value:
        assignment = self._assignments.get(each)
        if self._node is None or assignment is None:
            found = _fields(data, _words(each))
            return _default(each.type) if found is _ABSENT else found
        source = assignment.value
        found = _reached(data, _access(assignment))
        if not isinstance(source, rosgraph.ConversionCall):
            return _default(each.type) if found is _ABSENT else found
        conversion = source.conversion
        if found is _ABSENT:
            return str(conversion.default.name)
        if isinstance(found, str) and found in {literal.name for literal in conversion.enumeration.literals}:
            return found
        try:
            return str(self._node.convert(conversion, _Fields.of(found)).name)
        except (AttributeError, TypeError, ValueError) as error:
            literals = ", ".join(literal.name for literal in conversion.enumeration.literals)
            raise DataError(f"{_label(each)}: none of {literals}, and no data to tell it from: {error}") from None


class _Fields:
    """An object of JSON with its fields as attributes, as messages of ROS have them."""

    def __init__(self, fields: Mapping[str, Any]) -> None:
        self._fields = fields

    @classmethod
    def of(cls, data: Any) -> Any:
        """The same data with attributes; arrays and basic data as they are."""
        if isinstance(data, dict):
            if data and all(each.isdecimal() for each in data):
                elements = {int(index): cls.of(each) for index, each in data.items()}
                return [elements.get(index, 0) for index in range(max(elements) + 1)]
            return cls({name: cls.of(each) for name, each in data.items()})
        return [cls.of(each) for each in data] if isinstance(data, list) else data

    def __getattr__(self, name: str) -> Any:
        if name in self._fields:
            return self._fields[name]
        raise AttributeError(f"there is no field {name}")


def _assignments(graph: rosgraph.RosGraph) -> Iterator[tuple[sct.Input, rosgraph.InputAssignment]]:
    receptions = [each for topic in graph.subscriptions for each in topic.receptions]
    receptions += [each.response for each in graph.serviceClients]
    receptions += [reception for each in graph.actionClients for reception in (each.feedback, each.response)]
    for reception in receptions:
        for assignment in reception.inputs:
            yield assignment.input, assignment


def _access(assignment: rosgraph.InputAssignment) -> rosgraph.WireAccess:
    value = assignment.value
    access = value.argument if isinstance(value, rosgraph.ConversionCall) else value
    assert isinstance(access, rosgraph.WireAccess)
    return access


def _reached(data: Any, access: rosgraph.WireAccess) -> Any:
    """What an access reads of the data; a lone value stands for the only field on the way to it."""
    steps = list(access.steps)
    if data is not _ABSENT and not isinstance(data, dict | list) and len(steps) == 1:
        return data
    reached = data
    for step in steps:
        if reached is _ABSENT:
            return _ABSENT
        if not isinstance(reached, dict):
            raise DataError(f"{json.dumps(reached)} has no field {_field(step)}")
        reached = reached.get(_field(step), _ABSENT)
    return reached


def _field(step: rosgraph.WireStep) -> str:
    assert isinstance(step, rosgraph.FieldStep)  # elements of arrays are no inputs
    return str(step.name)


def _fields(data: Any, words: list[str]) -> Any:
    """The value of an input whose name joins the names of fields; names of fields may have `_` in them, too."""
    if not words:
        return data
    if isinstance(data, dict):
        for length in range(1, len(words) + 1):
            name = "_".join(words[:length])
            if name in data:
                return _fields(data[name], words[length:])
    return _ABSENT


def _words(each: sct.Input) -> list[str]:
    return str(each.name).split("_")[2:]


def _label(each: sct.Input) -> str:
    return ".".join(["value", *_words(each)])


def _default(kind: ex.Type) -> Value:
    domain = Domain.of(kind)
    return domain.shown(domain.clamp(0))
