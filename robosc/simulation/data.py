"""The data of events in scripts and traces, as the inputs of the supervisor that it means."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from robosc.engine.state import Domain
from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct
from robosc.metamodel.reflection import tree
from robosc.runtime.core.node_data import NodeData
from robosc.semantics.evaluation import as_double
from robosc.semantics.received import receptions
from robosc.semantics.roles import Roles, event_name
from robosc.simulation.unread import Unread, missing

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.engine import Engine
    from robosc.engine.state import Value

#: What JSON text says nothing about.
_ABSENT: Final = object()
#: The index of an element has less.
_DIGITS = 10
#: What each basic type is called, what JSON has for it, and what ROS leaves where nothing is said.
_BASIC: Mapping[type[ex.Type], tuple[str, Any, Value | float]] = {
    ex.BooleanType: ("a boolean", bool, False),
    ex.IntegerType: ("an integer", int, 0),
    ex.DoubleType: ("a number", int | float, 0.0),
    ex.StringType: ("a string", str, ""),
}
#: The steps to basic data, and its type.
_Read: TypeAlias = "tuple[Sequence[rosgraph.WireStep], ex.Type | None]"


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
        received = [] if graph is None else receptions(graph)
        self._assignments = {each.input: each for reception in received for each in reception.inputs}
        self._receptions = {event_name(each.event): each for each in received}
        clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = []
        clients += [] if graph is None else [*graph.serviceClients, *graph.actionClients]
        self._errors = {event_name(each.response.event): event_name(each.error) for each in clients}

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

    def unread(self, event: str, data: Mapping[str, Any]) -> Unread | None:
        """Why the node could not read this data in the present state, as far as it is given; None: it could."""
        reception = self._receptions.get(event)
        if self._node is None or reception is None or "value" not in data:
            return None
        fault = missing(self._node.read_now(reception.event), data["value"])
        return None if fault is None else Unread(str(fault), self._errors.get(event))

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
            return str(self._node.convert(conversion, _argument(found, _reads(conversion), _label(each))).name)
        except DataError as error:
            literals = ", ".join(literal.name for literal in conversion.enumeration.literals)
            raise DataError(f"expected one of {literals}, or the data to tell it from: {error}") from None


class _Array:
    """An array of which only those elements are there that are read."""

    def __init__(self, length: int, elements: Mapping[int, Any]) -> None:
        self._length = length
        self._elements = elements

    def __len__(self) -> int:
        return self._length

    def __getitem__(self, index: int) -> Any:
        return self._elements[index]


def _argument(data: Any, reads: Sequence[_Read], place: str) -> Any:
    """JSON in the shape of data from ROS, as far as it is read; what is left out is as ROS leaves it."""
    inner: dict[Any, list[_Read]] = {}
    array = False
    for steps, kind in reads:
        if not steps:
            return _basic(data, kind, place)
        first, *rest = steps
        array = isinstance(first, rosgraph.IndexStep)
        key = first.index if isinstance(first, rosgraph.IndexStep) else _field(first)
        inner.setdefault(key, []).append((rest, kind))
    if array:
        elements = _elements(data, place)
        length = max(elements, default=-1) + 1
        read = {index: own for index, own in inner.items() if index < length}
        return _Array(
            length,
            {index: _argument(elements.get(index, _ABSENT), own, f"{place}[{index}]") for index, own in read.items()},
        )
    fields = {} if data is _ABSENT or not reads else data
    if not isinstance(fields, dict):
        raise DataError(f"{place} is {json.dumps(data)}, expected an object with {next(iter(inner))}")
    return SimpleNamespace(
        **{name: _argument(fields.get(name, _ABSENT), own, f"{place}.{name}") for name, own in inner.items()}
    )


def _elements(data: Any, place: str) -> dict[int, Any]:
    if data is _ABSENT:
        return {}
    if isinstance(data, list):
        return dict(enumerate(data))
    if isinstance(data, dict) and all(each.isdecimal() and len(each) < _DIGITS for each in data):
        return {int(index): each for index, each in data.items()}
    raise DataError(f"{place} is {json.dumps(data)}, expected a list, or an object from index to element")


def _basic(data: Any, kind: ex.Type | None, place: str) -> Any:
    name, plain, default = next((each for known, each in _BASIC.items() if isinstance(kind, known)), ("", object, 0))
    if data is _ABSENT:
        return default
    if not isinstance(data, plain) or (isinstance(data, bool) and name in {"an integer", "a number"}):
        raise DataError(f"{place} is {json.dumps(data)}, expected {name}")
    return as_double(data) if isinstance(kind, ex.DoubleType) else data


def _reads(conversion: rosgraph.Conversion) -> list[_Read]:
    accesses = (each for rule in conversion.rules for each in tree(rule.condition))
    return [(list(each.steps), each.type) for _, each in accesses if isinstance(each, rosgraph.WireAccess)]


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
