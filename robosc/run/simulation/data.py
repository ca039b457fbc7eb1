"""Data of events in scripts and traces, as values of the inputs of the supervisor."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from functools import partial, reduce
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.base.ros_types import WireType
from robosc.base.ros_types import wire as wire_types
from robosc.base.ros_types.wire import Basic
from robosc.engine.state import Domain
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.reflection import tree
from robosc.model.semantics.communication import happens_anyway
from robosc.model.semantics.evaluation import as_double, single_precision
from robosc.model.semantics.failures import REASON, UNREADABLE, brings_data, is_reason, possible_reasons
from robosc.model.semantics.messages import is_structured, reads_stored, receptions, sent_messages, source_of
from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.roles import event_name, plant_of
from robosc.model.semantics.walks import operands
from robosc.run.runtime.core.event_log import nest
from robosc.run.runtime.core.node_data import NodeData, within_range
from robosc.run.simulation.tracked_data import TrackedData
from robosc.run.simulation.unreadable import Unreadable, past_end
from robosc.run.simulation.wire_fit import DIGITS, WireFit, in_short, place

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.base.ros_types import RosTypes
    from robosc.engine import Engine
    from robosc.engine.state import Value
    from robosc.run.simulation.tracked_data import Stored

#: Stands for a value that the JSON text does not have.
_ABSENT: Any = object()
#: Name of each basic type, its type in JSON, and its value in ROS without a default.
_BASIC: Mapping[type[ex.Type], tuple[str, Any, Value | float]] = {
    ex.BooleanType: ("a boolean", bool, False),
    ex.IntegerType: ("an integer", int, 0),
    ex.DoubleType: ("a number", int | float, 0.0),
    ex.StringType: ("a string", str, ""),
}


class DataError(Exception):
    """Data that does not fit its event. `hint`: how to fix it."""

    def __init__(self, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.hint = hint


def data_beside(graph: rosgraph.RosGraph, event: sct.Event) -> dict[tuple[str, ...], ex.Type]:
    """Return the types of an event's data that the node stores and no input holds, by the path of fields.

    The result is empty if an input of the event is a condition on the data: the data would determine it.
    """
    assignments = [
        assignment
        for reception in receptions(graph)
        if reception.event == event
        for assignment in reception.inputs
        if not is_reason(assignment.input)
    ]
    if any(assignment.input.text is not None for assignment in assignments):
        return {}
    input_paths = [tuple(map(_field, _access(assignment).steps)) for assignment in assignments]
    stored_values = [
        assigned.value
        for reaction in graph.reactions
        if reaction.event == event
        for assigned in reaction.assignments
        if not is_structured(assigned.variable.type)
    ]
    types_by_path: dict[tuple[str, ...], ex.Type] = {}
    for _, part in (inner for value in stored_values for inner in tree(value)):
        match part:
            case rosgraph.WireAccess(variable=None, quantifier=None, type=ex.Type() as kind) if type(kind) in _BASIC:
                if all(isinstance(step, rosgraph.FieldStep) for step in part.steps):
                    types_by_path[tuple(map(_field, part.steps))] = kind
    return {path: kind for path, kind in types_by_path.items() if path not in input_paths}


def reason_of(event: sct.Event, data: Mapping[str, Any]) -> str | None:
    """Return the reason of an event with some data; None unless it is the error of a service or action.

    An answer of a service makes the reason `unreadable`. Raises DataError.
    """
    possible = possible_reasons(event)
    where = data.get("where")
    if "reason" not in data and possible and isinstance(where, dict) and REASON in where:
        data = {"reason": where[REASON]}
    if "reason" not in data:
        is_answered = "value" in data and plant_of(event).kind == sct.PlantKind.service
        return UNREADABLE if possible and is_answered else next(iter(possible), None)
    reason = data["reason"]
    if not possible:
        raise DataError("only the error of a service or an action has a reason")
    if reason not in possible:
        raise DataError(f"the reason is {in_short(reason)}, expected one of {', '.join(sorted(possible))}")
    return str(reason)


class EventData:
    """Parser of event data: `{"value": ...}`, in the shape of the event log.

    An error also has a `reason`; the default is `aborted` for actions and `failed` for services. Basic data is the
    value itself, an object has fields, and an array is a list or an object from index to element. The name of a literal
    may replace data that is converted to an enumeration. A missing field has its default in ROS 2, and a missing
    enumeration the literal of its default rule. A condition that the node computes of data may be given by its text, as
    in `{"where": {"value.range < 0.5": true}}`. Without a ROS graph data goes to inputs by their names.
    """

    def __init__(self, engine: Engine, graph: rosgraph.RosGraph | None, types: RosTypes | None = None) -> None:
        """`types`: the definitions of ROS types; None: those of the environment."""
        self._events = {event_name(event): event for plant in engine.model.plants for event in plant.events}
        self._defaults = None if graph is None else WireFit(graph, types)
        self._node = None if graph is None else _JsonData(graph, engine)
        known = [] if graph is None else receptions(graph)
        commands = [] if graph is None else [sending for _, _, sending in sent_messages(graph) if sending.inputs]
        self._commands = {event_name(sending.event): sending for sending in commands}
        handlers: list[rosgraph.Reception | rosgraph.Sending] = [*known, *commands]
        self._assignments = {assignment.input: assignment for handler in handlers for assignment in handler.inputs}
        self._receptions = {event_name(reception.event): reception for reception in known}
        clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = []
        clients += [] if graph is None else [*graph.serviceClients, *graph.actionClients]
        self._errors = {event_name(client.response.event): event_name(client.error.event) for client in clients}
        self._responses = {error: response for response, error in self._errors.items()}
        #: Whether the present event has no data, so that its data is that of a new message.
        self._is_new = False
        #: Variables that the node stores, if inputs depend on them.
        self.tracked = None if graph is None or self._node is None else TrackedData(engine, graph, self._node)
        if graph is not None and self.tracked is not None and self.tracked.is_needed:
            self.tracked.values = self._new_objects(graph)

    def _new_objects(self, graph: rosgraph.RosGraph) -> dict[rosgraph.NodeVariable, Any]:
        """Return the objects that the node stores at first: new data of their ROS types."""
        return {
            variable: self._received(event_name(variable.reception.event), _ABSENT, tuple(variable.path))
            for variable in graph.variables
            if variable.reception is not None and isinstance(variable.type, rosgraph.ObjectType)
        }

    @property
    def stored(self) -> Stored:
        """Variables that the node stores, if inputs depend on them."""
        return {} if self.tracked is None else self.tracked.values

    @stored.setter
    def stored(self, values: Stored) -> None:
        if self.tracked is not None:
            self.tracked.values = values

    def before(self, event: str, data: Mapping[str, Any], inputs: Mapping[str, Value]) -> None:
        """Change the variables that the node stores, as an event does that is about to happen. Raises DataError."""
        if self.tracked is not None:
            value = data["value"] if "value" in data else self._provided(event)
            self.tracked.before(
                event,
                inputs,
                lambda part: self._received(event, value if value is _ABSENT else whole(value, part)),
            )

    def inputs(self, event: str, data: Mapping[str, Any]) -> dict[str, Value]:
        """Return values of the event's inputs by their names. Raises DataError, and KeyError for an unknown event."""
        declared = self._events[event]
        unknown = sorted(set(data) - {"value", "where", "reason"})
        if unknown:
            raise DataError(f'"{unknown[0]}" is not data of an event: write {{"value": ...}}')
        reason, computed = reason_of(declared, data), _computed(declared, data.get("where", {}))
        self._is_new = not brings_data(declared, reason)
        if self._node is not None:
            self._node.reason = reason
        if data and not declared.inputs:
            return {}  # stored by the node, or unused
        value = data["value"] if "value" in data else self._provided(event)
        values = {}
        for event_input in declared.inputs:
            domain = Domain(event_input.type)
            try:
                if is_reason(event_input) and ("reason" in data or event_input.text not in computed):
                    external_value: Value = reason or ""
                else:
                    external_value = (
                        computed[event_input.text]
                        if event_input.text in computed
                        else self._value(event, event_input, value)
                    )
                values[event_input.name] = domain.external(domain.internal(external_value))
            except ValueError as error:
                raise DataError(f"{self._label(event_input, value)}: {error}") from None
        return values

    def _provided(self, event: str) -> Any:
        """Return the data that a `provide` statement gives a command in the present state."""
        if event not in self._commands:
            return _ABSENT
        assert self._node is not None
        alternatives = self._commands[event].alternatives
        chosen = next((data for data in alternatives if self._node.is_in(data.location)), None)
        fields: dict[tuple[str, ...], Any] = {}
        if chosen is not None:
            self._assign(event, chosen.fields, fields)
        for limit in self._commands[event].limits:
            if limit.condition is None or self._node.value(limit.condition, self._received(event, nest(fields))):
                self._assign(event, limit.fields, fields)
        return nest(fields) if fields else _ABSENT

    def _assign(
        self, event: str, assignments: Sequence[rosgraph.FieldAssignment], fields: dict[tuple[str, ...], Any]
    ) -> None:
        """Change fields of a command by path. The values read the fields before, as the node would send them."""
        assert self._node is not None
        before = self._received(event, nest(fields))
        changed: dict[tuple[str, ...], Any] = {}
        for field in assignments:
            if field.condition is None or self._node.value(field.condition, before):
                path, value = tuple(field.path), within_range(self._node.value(field.value, before), field.type)
                wire = None if self._defaults is None else self._defaults.wire_type(event, path)
                is_single = isinstance(wire, Basic) and wire.name == "float32"
                changed[path] = single_precision(value) if is_single and isinstance(value, float) else _plain(value)
        if () in changed:  # a stored object is the whole data
            whole_data = changed.pop(())
            fields.clear()
            fields.update({(name,): value for name, value in whole_data.items()})
        fields.update(changed)

    def _label(self, event_input: sct.Input, data: Any = None) -> str:
        """Return the text of an input, or its place in the data of its event."""
        if event_input.text is not None:
            return str(event_input.text)
        return place(
            self._path(event_input) if event_input in self._assignments else tuple(_names(data, _words(event_input)))
        )

    def unreadable(self, event: str, data: Mapping[str, Any]) -> Unreadable | None:
        """Return why the node can't read this data in the present state; None if it can, as far as the data is given.

        For an error with the reason `unreadable` the result is reversed: why its data is no such error.
        """
        if event in self._responses and "value" in data and reason_of(self._events[event], data) == UNREADABLE:
            response = self._responses[event]
            is_read = self._is_readable(self._receptions[response], data["value"])
            return Unreadable("the node can read this data", None, response) if is_read else None
        reception = self._receptions.get(event)
        if self._node is None or reception is None or "value" not in data or happens_anyway(reception.event):
            return None
        for reaction in self._node.reactions(reception.event):
            guard, needs = reaction.guard, [*reaction.needs, *(assigned.value for assigned in reaction.assignments)]
            fault = None if guard is None else self._fault(event, data, guard)
            if fault is None and (guard is None or self._holds(event, data, guard)):
                fault = next(filter(None, (self._fault(event, data, needed) for needed in needs)), None)
            if fault is not None:
                return Unreadable(str(fault), self._errors.get(event))
        return None

    def _fault(self, event: str, data: Mapping[str, Any], expression: ex.Expression) -> UnreadableError | None:
        """Return why the node can't read a value, as far as data is given; None if it can."""
        value, tracked = data["value"], self.tracked
        if tracked is None or not tracked.is_needed or "where" in data or not reads_stored(expression):
            return past_end([expression], value)
        assert self._node is not None
        try:
            self._node.value(expression, self._received(event, whole(value, expression)))
        except UnreadableError as fault:
            return fault
        return None

    def _holds(self, event: str, data: Mapping[str, Any], guard: ex.Expression) -> bool:
        """Return whether a guard holds. A guard that stored data decides may not, where inputs are given."""
        assert self._node is not None
        try:
            return bool(self._node.value(guard, self._received(event, whole(data["value"], guard))))
        except UnreadableError:
            return False

    def _is_readable(self, reception: rosgraph.Reception, data: Any) -> bool:
        """Return whether the node can read data in the present state; False if that depends on stored data.

        A missing array is empty: the log of an answer that can't be read leaves out missing parts.
        """
        assert self._node is not None
        event = event_name(reception.event)
        try:
            for reaction in self._node.reactions(reception.event):
                values = [*reaction.needs, *(assigned.value for assigned in reaction.assignments)]
                if any(map(_reads_kept, [value for value in (reaction.guard, *values) if value is not None])):
                    return False
                guard = reaction.guard
                if guard is None or self._node.value(guard, self._received(event, whole(data, guard))):
                    for value in values:
                        self._node.value(value, self._received(event, whole(data, value)))
        except (UnreadableError, DataError):
            return False
        return True

    def error_of(self, event: str) -> str | None:
        """Return the error that happens in place of a response that cannot be taken; None for other events."""
        return self._errors.get(event)

    @staticmethod
    def of_unreadable(data: Mapping[str, Any]) -> dict[str, Any]:
        """Return data of the error that happens in place of an answer whose data can't be read."""
        return {"value": data["value"], "reason": UNREADABLE} if "value" in data else {"reason": UNREADABLE}

    def check(self, event: str, data: Mapping[str, Any], *, is_message: bool = False) -> None:
        """Raise DataError if the data does not fit the event; an unknown event fits.

        `is_message`: its value has the fields of the ROS message, without names of literals.
        """
        if event not in self._events:
            return
        if self._defaults is not None and "value" in data:
            fault = self._defaults.fault(event, data["value"], is_message=is_message)
            if fault is not None:
                raise DataError(*fault)
        inputs = self.inputs(event, data)
        if self._defaults is not None:
            self._check_reason(event, data, inputs)
        if event in self._errors:
            self.inputs(self._errors[event], self.of_unreadable(data))

    def _check_reason(self, event: str, data: Mapping[str, Any], inputs: Mapping[str, Value]) -> None:
        """Raise DataError if an error without data has data other than the defaults in an event log."""
        declared = self._events[event]
        reason = reason_of(declared, data)
        if brings_data(declared, reason):
            return
        assert self._defaults is not None
        new = self.inputs(event, {"reason": reason})
        changed = (
            event_input
            for event_input in declared.inputs
            if event_input.name in inputs and inputs[event_input.name] != new[event_input.name]
        )
        parts = [f"`{self._label(event_input)}` is {in_short(inputs[event_input.name])}" for event_input in changed]
        if "value" in data:
            set_part = self._defaults.set_part(event, data["value"], partial(self._new_literal, event))
            parts = [set_part, *parts] if set_part else parts
        if parts:
            raise DataError(f"an error with the reason `{reason}` has no data, but {parts[0]}", "leave it out")

    def _new_literal(self, event: str, conversion: rosgraph.Conversion, path: tuple[str, ...]) -> str:
        """Return the literal that a conversion makes of the data at a path in a new message."""
        assert self._node is not None
        return str(self._node.literal(conversion, self._received(event, _ABSENT, path)))

    def fit_reason(self, event: str, values: Mapping[str, Value]) -> dict[str, Value]:
        """Return values of an event's inputs, with those replaced that do not fit its reason."""
        declared = self._events[event]
        reason = next((event_input.name for event_input in declared.inputs if is_reason(event_input)), None)
        if reason is None:
            return dict(values)
        if not brings_data(declared, str(values[reason])):
            return self.inputs(event, {"reason": values[reason]})
        if self.unreadable(event, self.shape(event, values)) is None:
            return dict(values)
        return {**values, reason: possible_reasons(declared)[0]}

    def shape(
        self, event: str, values: Mapping[str, Value], others: Mapping[tuple[str, ...], Any] | None = None
    ) -> dict[str, Any]:
        """Return data that gives the event's inputs these values, by name; `others` are further values by path."""
        inputs = self._events[event].inputs
        reasons = [values[event_input.name] for event_input in inputs if is_reason(event_input)]
        where = {
            event_input.text: values[event_input.name]
            for event_input in inputs
            if event_input.text is not None and not is_reason(event_input)
        }
        paths = {
            **(others or {}),
            **{self._path(event_input): values[event_input.name] for event_input in inputs if event_input.text is None},
        }
        shown: dict[str, Any] = {"where": where} if where else {}
        if reasons:
            shown["reason"] = reasons[0]
        if not paths:
            return shown
        if len(paths) == 1 and next(iter(paths)) in ((), ("data",)):  # as in an event log
            return {"value": next(iter(paths.values())), **shown}
        return {"value": nest(paths), **shown}

    def _path(self, event_input: sct.Input) -> tuple[str, ...]:
        """Return the path of an input in the data of its event."""
        assignment = self._assignments.get(event_input)
        return tuple(_words(event_input)) if assignment is None else tuple(map(_field, _access(assignment).steps))

    def _received(self, event: str, data: Any, path: tuple[str, ...] = ()) -> _EventValues:
        return _EventValues(data, path, self._defaults, event)

    def _value(self, event: str, event_input: sct.Input, data: Any) -> Value:
        assignment = self._assignments.get(event_input)
        if event_input.text is not None:
            if assignment is None or self._node is None:
                return _default(event_input.type)
            received = self._received(event, data if data is _ABSENT else whole(data, assignment.value))
            return self._node.input(assignment, received)  # type: ignore[no-any-return]
        reached = _fields(data, _words(event_input)) if assignment is None else _reached(data, _access(assignment))
        source = None if assignment is None else assignment.value
        if self._node is None or not isinstance(source, rosgraph.ConversionCall):
            if reached is not _ABSENT:
                return reached  # type: ignore[no-any-return]
            default = 0 if assignment is None else self._received(event, reached, self._path(event_input)).default
            return _default(event_input.type, default)
        conversion = source.conversion
        if reached is _ABSENT:
            path = self._path(event_input)
            return self._new_literal(event, conversion, path) if self._is_new else str(conversion.default.name)
        if isinstance(reached, str) and reached in {literal.name for literal in conversion.enumeration.literals}:
            return reached
        try:
            return str(self._node.literal(conversion, self._received(event, reached, self._path(event_input))))
        except DataError as error:
            literals = ", ".join(literal.name for literal in conversion.enumeration.literals)
            raise DataError(f"expected one of {literals}, or data that determines it: {error}") from None


def _plain(value: Any) -> Any:
    """Return JSON for a value: an object, or an array of objects, has the fields that were given."""
    if isinstance(value, _EventValues):
        return {} if value.value is _ABSENT else value.value
    return list(map(_plain, value)) if isinstance(value, list | tuple) else value


class _EventValues(NamedTuple):
    """JSON in place of data from ROS, and its path in the data of its event."""

    value: Any
    path: tuple[str, ...]
    defaults: WireFit | None
    event: str

    def below(self, value: Any, step: str) -> _EventValues:
        """Return a field or an element."""
        return self._replace(value=value, path=(*self.path, step))

    @property
    def place(self) -> str:
        """The place in the script's data."""
        return place(self.path)

    @property
    def default(self) -> wire_types.Value | None:
        """The default value; None if it is unknown."""
        wire = self._wire
        return wire.initial if isinstance(wire, Basic) else None

    @property
    def length(self) -> int:
        """The number of elements of a missing array."""
        wire = self._wire
        return wire.initial_length if isinstance(wire, wire_types.Sequence) else 0

    @property
    def _wire(self) -> WireType | None:
        return None if self.defaults is None else self.defaults.wire_type(self.event, self.path)


class _JsonData(NodeData):
    """Node data that reads JSON in place of data from ROS."""

    def literal(self, conversion: rosgraph.Conversion, data: _EventValues) -> str:
        """Return the literal that a conversion makes of data. Raises DataError, also for data of unused rules."""
        for _, part in [inner for rule in conversion.rules for inner in tree(rule.condition)]:
            if isinstance(part, rosgraph.WireAccess) and part.quantifier is None and not operands(part):
                with suppress(UnreadableError):
                    self.leaf(self._reach(part)(data), part.type)
        return str(self.convert(conversion, data).name)

    def convert(self, conversion: rosgraph.Conversion, argument: Any) -> ex.EnumerationLiteral:
        """Return the literal that the data names, or that the conversion makes of it."""
        name = argument.value if isinstance(argument, _EventValues) else None
        named = (literal for literal in conversion.enumeration.literals if literal.name == name)
        return next(named, None) or super().convert(conversion, argument)

    def _fields(self, names: Sequence[str]) -> Callable[[_EventValues], _EventValues]:
        return lambda data: reduce(self._field, names, data)

    def _field(self, owner: _EventValues, name: str) -> _EventValues:
        value = owner.value
        if value is not _ABSENT and not isinstance(value, dict):
            raise DataError(f"{owner.place} is {in_short(value)}, expected an object with {name}")
        return owner.below(_ABSENT if value is _ABSENT else value.get(name, _ABSENT), name)

    def _element(self, array: Any, index: int) -> Any:
        return super()._element(_list(array), index)

    def _slice(self, array: Any, first: int, last: int) -> Any:
        return super()._slice(_list(array), first, last)

    def leaf(self, value: Any, kind: ex.Type | None) -> Any:
        if isinstance(kind, rosgraph.ArrayType):
            return super().leaf(_list(value), kind)
        if kind is None or not isinstance(value, _EventValues):
            return value  # an object, or an element of an array that was read as a whole
        return super().leaf(_basic(value, kind), kind)


class _Array(Sequence[Any]):
    """Elements of an array in JSON, with their places; the array may be long and have few."""

    def __init__(self, array: _EventValues) -> None:
        self._array = array
        self._elements = _elements(array)
        self._length = max(max(self._elements, default=-1) + 1, array.length)

    def __len__(self) -> int:
        return self._length

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self[place] for place in range(*index.indices(len(self)))]
        if index >= len(self):
            raise IndexError
        return self._array.below(self._elements.get(index, _ABSENT), str(index))


def _list(array: _EventValues | list[_EventValues]) -> Sequence[_EventValues]:
    """Return the elements of an array in JSON; a slice is returned unchanged."""
    return _Array(array) if isinstance(array, _EventValues) else array


def _elements(array: _EventValues) -> dict[int, Any]:
    data = array.value
    if data is _ABSENT:
        return {}
    if isinstance(data, list):
        return dict(enumerate(data))
    if isinstance(data, dict) and all(index.isdecimal() and len(index) < DIGITS for index in data):
        return {int(index): element for index, element in data.items()}
    raise DataError(f"{array.place} is {in_short(data)}, expected a list, or an object from index to element")


def _basic(leaf: _EventValues, kind: ex.Type | None) -> Any:
    name, plain, zero = next((basic for known, basic in _BASIC.items() if isinstance(kind, known)), ("", object, 0))
    data = leaf.value
    if data is _ABSENT:
        default = leaf.default
        return zero if default is None else default
    if data is None and isinstance(kind, ex.DoubleType):
        return math.nan  # an event log writes null for a number that is not finite
    if not isinstance(data, plain) or (isinstance(data, bool) and name in {"an integer", "a number"}):
        raise DataError(f"{leaf.place} is {in_short(data)}, expected {name}")
    return as_double(data) if isinstance(kind, ex.DoubleType) else data


def _computed(event: sct.Event, where: Any) -> Mapping[str | None, Value]:
    """Return the conditions on data that a script gives, by their texts in the model. Raises DataError."""
    texts = [event_input.text for event_input in event.inputs if event_input.text is not None]
    if not isinstance(where, dict) or not set(where) <= set(texts):
        expected = f"the texts {', '.join(f'`{text}`' for text in texts)}" if texts else "no `where`"
        raise DataError(f'"where" is {in_short(where)}, expected an object with {expected}')
    return where


def _reads_kept(expression: ex.Expression) -> bool:
    """Return whether an expression reads stored data or parameters, which a script does not follow."""
    return any(
        isinstance(part, rosgraph.NodeVariableReference)
        or (isinstance(part, rosgraph.WireAccess) and source_of(part) is not None)
        for _, part in tree(expression)
    )


def whole(data: Any, reference: ex.Expression) -> Any:
    """Return the data with its fields: a lone value stands for the only field on the path to it."""
    accesses = (
        part for _, part in tree(reference) if isinstance(part, rosgraph.WireAccess) and part.quantifier is None
    )
    access = next(accesses, None)
    if access is None or isinstance(data, dict) or len(access.steps) != 1:
        return data
    return {_field(access.steps[0]): data}


def _access(assignment: rosgraph.InputAssignment) -> rosgraph.WireAccess:
    value = assignment.value
    access = value.argument if isinstance(value, rosgraph.ConversionCall) else value
    assert isinstance(access, rosgraph.WireAccess)
    return access


def _reached(data: Any, access: rosgraph.WireAccess) -> Any:
    """Return the value that an access reads of the data; a lone value stands for the only field on the path to it."""
    steps = list(access.steps)
    if data is not _ABSENT and not isinstance(data, dict | list) and len(steps) == 1:
        return data
    reached = data
    for step in steps:
        if reached is _ABSENT:
            return _ABSENT
        if not isinstance(reached, dict):
            raise DataError(f"{in_short(reached)} has no field {_field(step)}")
        reached = reached.get(_field(step), _ABSENT)
    return reached


def _field(step: rosgraph.WireStep) -> str:
    assert isinstance(step, rosgraph.FieldStep)  # elements of arrays are no inputs
    return str(step.name)


def _fields(data: Any, words: list[str]) -> Any:
    """Return the value of an input whose name joins the names of fields."""
    for name in _names(data, words):
        data = data.get(name, _ABSENT) if isinstance(data, dict) else _ABSENT
    return data


def _names(data: Any, words: list[str]) -> list[str]:
    """Return the fields whose names, joined by `_`, are these words; names of fields may have `_` in them, too."""
    if not words:
        return []
    joined = ["_".join(words[:length]) for length in range(1, len(words) + 1)]
    name = next((name for name in joined if isinstance(data, dict) and name in data), words[0])
    rest = words[name.count("_") + 1 :]
    return [name, *_names(data.get(name) if isinstance(data, dict) else None, rest)]


def _words(event_input: sct.Input) -> list[str]:
    return str(event_input.name).split("_")[2:]


def _default(kind: ex.Type, value: Any = 0) -> Value:
    domain = Domain(kind)
    return domain.external(domain.clamp(0 if value is None else int(value)))
