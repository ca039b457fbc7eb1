"""Data that a node keeps beside its supervisor, values of expressions over it, and data for messages."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Iterable, Sequence
from copy import deepcopy
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.base.ros_types.wire import INTEGER_RANGES
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.semantics.evaluation import Program, Value, as_double, saturate, single_precision
from robosc.model.semantics.messages import EACH, first_value
from robosc.model.semantics.operators import UnreadableError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from robosc.engine import Engine
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.port import ControllerPort, Message

#: Range of the whole numbers of a node.
LEAST, MOST = INTEGER_RANGES["int64"]
_FLOATS = {"float32": "f", "float": "f", "float64": "d", "double": "d"}
#: Type of an array, with the type of its elements: `float64[]`, in ROS 2 `sequence<double, 9>`.
_ELEMENT = re.compile(r"(?:sequence<)?([\w/]+).*")
#: ROS 2 calls its `byte` an octet.
_RANGES = {**INTEGER_RANGES, "octet": INTEGER_RANGES["uint8"]}


class _Blank:
    """Unset object, whose fields are unset, too."""

    def __getattr__(self, name: str) -> _Blank:
        if name.startswith("__"):
            raise AttributeError(name)
        return self

    def __len__(self) -> int:
        return 0


BLANK: Any = _Blank()
#: Values read of an unset object.
_BLANK: dict[type[ex.Type], Any] = {
    ex.BooleanType: False,
    ex.IntegerType: 0,
    ex.DoubleType: 0.0,
    ex.StringType: "",
    rosgraph.ArrayType: [],
}


def element_type(kind: str) -> str:
    """Return the type of an array's elements, or the type itself if it is no array, as in `wire_types`."""
    return _ELEMENT.sub(r"\1", kind)


class PastEndError(UnreadableError):
    """Access to a missing element of an array."""

    def __init__(self, index: int, length: int) -> None:
        super().__init__(f"there is no element {index} in an array of {length}")


class ReceivedValues(NamedTuple):
    """Data of an event, computed in the state before it: its inputs by name, and the node's new values."""

    inputs: dict[str, Any]
    variables: dict[rosgraph.NodeVariable, Value]


def fit(number: int) -> int:
    """Return the nearest number of 64 bits."""
    return saturate(number, LEAST, MOST)


class NodeData:
    """Variables of one node, and values of expressions.

    An expression reads the variables, the supervisor's state and incoming data. An enumeration's value is its literal.
    """

    def __init__(self, graph: rosgraph.RosGraph, engine: Engine) -> None:
        self._engine = engine
        #: Failure reason of the service or action of the present error.
        self.reason: str | None = None
        self._programs: dict[ex.Expression, Program[Value]] = {}
        self.variables: dict[rosgraph.NodeVariable, Value] = {}
        for variable in (*graph.variables, *graph.parameters):
            self.variables[variable] = (
                self.value(variable.initial)
                if variable.initial is not None
                else []
                if isinstance(variable.type, rosgraph.ArrayType)
                else BLANK
            )
        self._reactions: dict[sct.Event, list[rosgraph.Reaction]] = {}
        for reaction in graph.reactions:
            self._reactions.setdefault(reaction.event, []).append(reaction)

    def value(self, expression: ex.Expression, data: Message = None) -> Value:
        """Return the value of an expression; `data` is the incoming data. Raises UnreadableError."""
        program = self._programs.get(expression)
        if program is None:
            program = Program[Value](expression, self._reader, fit)
            self._programs[expression] = program
        return program(data)

    def is_in(self, location: sct.Location) -> bool:
        """Return whether the plant of a location is in it."""
        plant: sct.Plant = location.eContainer()
        return plant.locations[self._engine.location(plant)] is location

    def receive(
        self, event: sct.Event, inputs: Sequence[rosgraph.InputAssignment] = (), data: Message = None
    ) -> ReceivedValues:
        """Return the inputs and new values of an event in the present state; change nothing.

        Raises UnreadableError if one of them can't be read: then the event must not happen.
        """
        variables = self._assigned(event, data)
        return ReceivedValues({assignment.input.name: self.input(assignment, data) for assignment in inputs}, variables)

    def input(self, assigned: rosgraph.InputAssignment, data: Message) -> Any:
        """Return the value of an input; its first value if it can't be read, as then no taken transition needs it."""
        try:
            value = self.value(assigned.value, data)
        except UnreadableError:
            value = first_value(assigned.input.type)
        return value.name if isinstance(value, ex.EnumerationLiteral) else value

    def _assigned(self, event: sct.Event, data: Message) -> dict[rosgraph.NodeVariable, Value]:
        assigned: dict[rosgraph.NodeVariable, Value] = {}
        for reaction in self.reactions(event):
            if reaction.guard is None or self.value(reaction.guard, data):
                for needed in reaction.needs:
                    self.value(needed, data)
                for assignment in reaction.assignments:
                    assigned[assignment.variable] = within_range(
                        self.value(assignment.value, data), assignment.variable.type
                    )
        return assigned

    def reactions(self, event: sct.Event) -> list[rosgraph.Reaction]:
        """Return the reactions of the node to the event in the present state, if their guards hold."""
        return [reaction for reaction in self._reactions.get(event, ()) if any(map(self.is_in, reaction.locations))]

    def values_read(self, event: sct.Event) -> list[ex.Expression]:
        """Return all values that the event may assign to variables."""
        return [assigned.value for reaction in self._reactions.get(event, ()) for assigned in reaction.assignments]

    def convert(self, conversion: rosgraph.Conversion, argument: Any) -> ex.EnumerationLiteral:
        """Return the literal of the first rule that holds; a rule that can't be read does not hold."""
        for rule in conversion.rules:
            try:
                if self.value(rule.condition, argument):
                    return rule.literal
            except UnreadableError:
                continue
        return conversion.default

    def _reader(self, reference: ex.Expression) -> Callable[..., Any]:
        """Return the function that reads a reference, of the element that it reads, its indices, and the data."""
        match reference:
            case rosgraph.NodeVariableReference():
                return partial(self._node_variable, reference.variable, bool(reference.single))
            case rosgraph.WireAccess():
                reach, kind = self._reach(reference), reference.type
                return lambda *context: self.leaf(reach(*context), kind)
            case rosgraph.ConversionCall():
                reach, conversion = self._reach(reference.argument), reference.conversion
                return lambda *context: self.convert(conversion, reach(*context))
            case rosgraph.ArrayLiteral():
                return lambda *context: context[:-1]
            case rosgraph.ErrorReason():
                literals = {str(literal.name): literal for literal in reference.enumeration.literals}
                return lambda *_: literals[str(self.reason)]
            case ex.EnumerationLiteralReference():
                literal = reference.literal
                return lambda *_: literal
            case sct.LocationReference():
                location = reference.location
                return lambda *_: self.is_in(location)
            case sct.VariableReference():
                variable = reference.variable
                return lambda *_: self._variable(variable)
        raise TypeError(f"a ROS graph holds no {type(reference).__name__}")

    def _node_variable(self, variable: rosgraph.NodeVariable, single: bool, *_: Any) -> Value:
        value = self.variables[variable]
        return single_precision(value) if single and isinstance(value, float) else value

    def _reach(self, access: rosgraph.WireAccess) -> Callable[..., Any]:
        """Return the function that reads the value of an access, of a message or an element, as `_reader` does.

        The function raises UnreadableError.
        """
        variable, is_inner = access.variable, access.quantifier is not None
        if is_inner and not access.steps:
            return lambda element, *_: element
        names = [step.name for step in access.steps if isinstance(step, rosgraph.FieldStep)]
        if names and len(names) == len(access.steps) and variable is None and not is_inner:
            field = self._fields(names)
            return lambda *context: field(context[-1])
        steps = list(map(self._step, access.steps))

        def reach(*context: Any) -> Any:
            reached = context[0] if is_inner else context[-1] if variable is None else self.variables[variable]
            rest = iter(context[1:] if is_inner else context)
            for step in steps:
                reached = step(reached, rest)
            return reached

        return reach

    def _step(self, step: rosgraph.WireStep) -> Callable[[Any, Iterator[int]], Any]:
        """Return the function that takes a step from an object or array; computed indices come from the iterator."""
        match step:
            case rosgraph.FieldStep():
                name = step.name
                return lambda reached, _: self._field(reached, name)
            case rosgraph.SliceStep():
                return lambda reached, rest: self._slice(reached, next(rest), next(rest))
            case rosgraph.IndexStep() if step.position is not None:
                return lambda reached, rest: self._element(reached, next(rest))
            case rosgraph.IndexStep():
                index = step.index
                assert index is not None
                return lambda reached, _: self._element(reached, index)
        raise TypeError(f"no step of an access is a {type(step).__name__}")

    def at(self, data: Any, path: Sequence[str]) -> Any:
        """Return the value at a path of names and positions. Raises UnreadableError."""
        for step in path:
            data = self._element(data, int(step)) if step.isdigit() else self._field(data, step)
        return data

    def _fields(self, names: Sequence[str]) -> Callable[[Any], Any]:
        """Return the function that reads a field, of a field, and so on, of data that came in."""
        return attrgetter(".".join(names))

    def _field(self, owner: Any, name: str) -> Any:
        return getattr(owner, name)

    def _element(self, array: Any, index: int) -> Any:
        if not 0 <= index < len(array):
            raise PastEndError(index, len(array))
        return array[index]

    def _slice(self, array: Any, first: int, last: int) -> Any:
        if last >= first and not (first >= 0 and last < len(array)):
            raise UnreadableError(f"there are no elements {first} to {last} in an array of {len(array)}")
        return array[first : last + 1] if last >= first else []

    def leaf(self, value: Any, kind: ex.Type | None) -> Value:
        """Convert a value of ROS to one of the model: numpy's scalars and ROS 2's `byte` become plain numbers."""
        if value is BLANK and kind is not None:
            blank: Value = _BLANK[type(kind)]
            return blank
        if isinstance(kind, rosgraph.ArrayType):
            return [self.leaf(element, kind.element) for element in value]
        convert = _CONVERSIONS.get(type(kind))
        return value if convert is None else convert(value)

    def _variable(self, variable: sct.DiscreteVariable) -> Value:
        value = self._engine.value(variable)
        if isinstance(variable.type, ex.EnumerationType):
            return next(literal for literal in variable.type.enumeration.literals if literal.name == value)
        return value


#: Conversions of values of ROS to those of the model.
_CONVERSIONS: dict[type, Callable[[Any], Value]] = {
    ex.IntegerType: lambda value: fit(value[0] if isinstance(value, bytes) else int(value)),
    ex.DoubleType: float,
    ex.BooleanType: bool,
}


def within_range(value: Value, kind: ex.Type) -> Value:
    """Return the value as a variable of the type holds it: an integer within its range."""
    if isinstance(kind, ex.IntegerType):
        assert isinstance(value, int)
        return saturate(fit(value), kind.minimum, kind.maximum)
    if isinstance(kind, rosgraph.ArrayType) and kind.element is not None:
        assert isinstance(value, Iterable)
        return [within_range(element, kind.element) for element in value]
    return value


class NotFiniteError(Exception):
    """Field whose value would not be finite."""

    def __init__(self, path: Sequence[str]) -> None:
        super().__init__(".".join(path))


#: Faults of data that cannot be sent.
UNSENDABLE = (NotFiniteError, UnreadableError)


def why_unsendable(fault: NotFiniteError | UnreadableError) -> str:
    """Return why data cannot be sent, without the name of the command."""
    return f"its {fault} would not be finite" if isinstance(fault, NotFiniteError) else str(fault)


def require_finite(data: Any, path: Sequence[str], start: int = 0) -> None:
    """Raise NotFiniteError if a double at a path of a message is not finite. A missing element counts as finite."""
    for index, step in enumerate(path[start:], start):
        if step == EACH:
            for element in data:
                require_finite(element, path, index + 1)
            return
        if step.isdigit():
            if int(step) >= len(data):
                return
            data = data[int(step)]
        else:
            data = getattr(data, step)
    if not math.isfinite(data):
        raise NotFiniteError([step for step in path if step != EACH])


def fill(port: ControllerPort, message: Message, path: Sequence[str], value: Value) -> Json:
    """Set a field at a path and return the value that it then holds. Raises NotFiniteError.

    A number outside the field's range becomes the nearest one in it. A double is rounded to the field's precision.
    """
    owner = message
    for name in path[:-1]:
        owner = getattr(owner, name)
    kind = port.wire_types(owner)[path[-1]]
    if isinstance(value, Sequence) and not isinstance(value, str):
        return _fill_array(owner, kind, value, path)
    stored: bool | int | float | str = _finite_value(kind, value, path)
    setattr(owner, path[-1], bytes([stored]) if kind == "octet" and isinstance(stored, int) else stored)
    return stored


def hand_on(port: ControllerPort, message: Message, path: Sequence[str], data: Any) -> None:
    """Set a field to an object, or to an array of objects, unchanged; an empty path means the whole message.

    Raises NotFiniteError if a number in it is not finite.
    """
    owner = message
    if data is BLANK:
        return
    if not _is_finite(port, data):
        raise NotFiniteError(path or ["data"])
    for name in path[:-1]:
        owner = getattr(owner, name)
    for name in path[-1:] or port.wire_types(data):
        setattr(owner, name, deepcopy(data if path else getattr(data, name)))


def _is_finite(port: ControllerPort, data: Any) -> bool:
    """Return whether all numbers in an object, or in an array of objects, are finite."""
    if data is BLANK:
        return True
    if isinstance(data, Sequence):
        return all(_is_finite(port, element) for element in data)
    for name, kind in port.wire_types(data).items():
        value, element = getattr(data, name), element_type(kind)
        if element in _FLOATS and not all(map(math.isfinite, [value] if kind == element else value)):
            return False
        if "/" in element and not _is_finite(port, value):
            return False
    return True


def _fill_array(owner: Message, kind: str, values: Sequence[Value], path: Sequence[str]) -> Json:
    """Set the elements of an array; an array of fixed length keeps its further elements."""
    element, length = _array(kind)
    elements = [_finite_value(element, value, path) for value in values[:length]]
    rest = [] if length is None else list(getattr(owner, path[-1]))[len(elements) :]
    octets = [bytes([number]) if element == "octet" and isinstance(number, int) else number for number in elements]
    setattr(owner, path[-1], [*octets, *rest])
    return elements


def _array(kind: str) -> tuple[str, int | None]:
    """Return the element type of an array type, and the length if it is fixed.

    ROS 2 also has types such as `sequence<double, 9>`.
    """
    bounds = re.fullmatch(r"(?:sequence<)?(\w+(?:<\d+>)?)(?:\[(\d*)\]|(?:, *\d+)?>)", kind)
    assert bounds is not None
    return bounds[1], int(bounds[2]) if bounds[2] else None


def _finite_value(kind: str, value: Value, path: Sequence[str]) -> bool | int | float | str:
    if isinstance(value, (bool, str)):
        return value
    assert isinstance(value, (int, float))
    if kind in _FLOATS:
        return _narrowed(as_double(value), _FLOATS[kind], path)
    low, high = _RANGES.get(kind, (0, 1))
    if isinstance(value, float):
        value = int(_finite(value, path))
    return saturate(value, low, high)


def _narrowed(value: float, code: str, path: Sequence[str]) -> float:
    try:
        (narrowed,) = struct.unpack(code, struct.pack(code, value))
    except OverflowError:
        raise NotFiniteError(path) from None
    return _finite(float(narrowed), path)


def _finite(value: float, path: Sequence[str]) -> float:
    if not math.isfinite(value):
        raise NotFiniteError(path)
    return value
