"""ROS data of simulated robots: objects with the fields that the model knows."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from robosc.base.ros_types.wire import Basic, DefinitionError, NestedType, Section, Sequence
from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.model.semantics.messages import EACH, MessageRead, holds_objects, parts_of, path_of
from robosc.model.semantics.messages import reads as all_reads
from robosc.run.runtime.core.node_data import BLANK

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from robosc.base.ros_types import RosDistribution, WireType


#: Maximum number of elements of an array in a created message.
LONGEST = 10_000
#: Number of elements to try of an array of which all may be read.
_ELEMENTS = 3
#: Names of fields and positions in arrays, from the outside inwards.
Path = tuple[str, ...]
#: Basic data; a forwarded object is `{}`.
Leaf = bool | int | float | str | dict[str, None]

#: Widest type of ROS, and the value of a field without a declared default.
_ZEROS: dict[type[ex.Type], tuple[str, Leaf]] = {
    ex.BooleanType: ("bool", False),
    ex.IntegerType: ("int64", 0),
    ex.DoubleType: ("float64", 0.0),
    ex.StringType: ("string", ""),
}


class Record(SimpleNamespace):
    """Object of ROS. Comparisons ignore `wire_types`, the types of its fields."""

    __hash__ = None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and vars(self) | {"wire_types": {}} == vars(other) | {"wire_types": {}}


@dataclass(frozen=True)
class Field:
    """Field that the model reads or sets: its type in the model, and its type in ROS if that is known.

    `initial`: its value in a new message of ROS, None if unknown. `length`: the length of an array of fixed length.
    """

    type: ex.Type
    wire: str | None
    initial: Leaf | None = None
    length: int | None = None

    @property
    def default(self) -> Any:
        """The value of the field in a new message."""
        if isinstance(self.type, rosgraph.ObjectType):
            return Record(wire_types={})
        if isinstance(self.type, rosgraph.ArrayType):
            return [self.initial] * (self.length or 0)
        return _ZEROS[type(self.type)][1] if self.initial is None else self.initial

    @property
    def wire_type(self) -> str:
        """The type in ROS, or the widest of its kind."""
        if holds_objects(self.type):
            return "object"
        if isinstance(self.type, rosgraph.ArrayType):
            assert self.type.element is not None
            return f"{self.wire or _ZEROS[type(self.type.element)][0]}[{'' if self.length is None else self.length}]"
        return self.wire or _ZEROS[type(self.type)][0]


@dataclass(frozen=True)
class Definition:
    """Section of a ROS type, as one of the two ROS versions defines it."""

    distribution: RosDistribution
    interface: rosgraph.Interface
    section: Section

    def field(self, path: Path, kind: ex.Type) -> Field:
        """Return the field at the end of a path, of a type in the model."""
        reached = self._reached(path)
        length = reached.length if isinstance(reached, Sequence) else None
        if isinstance(kind, rosgraph.ArrayType):
            reached = self._reached((*path, "0"))
        if not isinstance(reached, Basic):
            return Field(kind, None, length=length)
        is_double = isinstance(kind, ex.DoubleType) and isinstance(reached.initial, int)
        return Field(kind, reached.name, float(reached.initial) if is_double else reached.initial, length)

    def initial(self, fields: Mapping[Path, Field]) -> dict[Path, Leaf]:
        """Return the elements of arrays in a new message, if they have a fixed length or a default."""
        elements: dict[Path, Leaf] = {}
        for path, field in fields.items():
            for way in self._ways(path):
                value = self.field(way, field.type).default
                if any(step.isdigit() for step in way) and isinstance(value, bool | int | float | str):
                    elements[way] = value
        return elements

    def _ways(self, path: Path, before: Path = ()) -> Iterator[Path]:
        """Yield the path with its indices replaced by each combination of indices of a new message."""
        if not path:
            yield before
        elif not path[0].isdigit():
            yield from self._ways(path[1:], (*before, path[0]))
        elif isinstance(array := self._reached(before), Sequence):
            for index in range(min(array.initial_length, LONGEST)):
                yield from self._ways(path[1:], (*before, str(index)))

    def _reached(self, path: Path) -> WireType | None:
        reached = self.distribution.type_at(self.interface.package, self.interface.type, self.section, path)
        return None if reached is None else reached[0]


def data_read(reads: Iterable[tuple[Path, MessageRead]], prefix: Path = ()) -> Iterator[tuple[Path, ex.Type]]:
    """Yield all data of a message that is read, also by conversions; repeated if it is read again."""
    for general, message_read in reads:
        for path in _some(general, _ends(message_read.reference)):
            if message_read.conversion is not None:
                yield from data_read(
                    all_reads([rule.condition for rule in message_read.conversion.rules]), prefix + path
                )
            else:
                yield prefix + path, message_read.type or rosgraph.ObjectType()


def _some(path: Path, ends: Iterable[int]) -> Iterator[Path]:
    """Yield the path, or, if it leads to any element, the paths to the first elements and to `ends`."""
    elements = sorted({*range(_ELEMENTS), *ends})
    choices = [elements if step == EACH else [step] for step in path]
    yield from (tuple(map(str, chosen)) for chosen in product(*choices))


def _ends(reference: ex.Expression) -> Iterator[int]:
    """Yield the constant bounds of slices in a read."""
    access: ex.Expression | None = reference.argument if isinstance(reference, rosgraph.ConversionCall) else reference
    while isinstance(access, rosgraph.WireAccess):
        for step in access.steps:
            if isinstance(step, rosgraph.SliceStep):
                ends = (end.value for end in (step.first, step.last) if isinstance(end, ex.IntegerLiteral))
                yield from (end for end in ends if end < LONGEST)
        access = access.quantifier.array if access.quantifier else None


def message(fields: Mapping[Path, Field], values: Mapping[Path, Leaf]) -> Any:
    """Return data with these values and defaults elsewhere; an array ends at the last element with a value.

    Elements from `LONGEST` on are left out; their reads fail.
    """
    heads = list(dict.fromkeys(path[0] for path in fields if path))
    if () in fields and not heads:
        return _whole(values.get(()), fields[()])
    if not heads or not all(head.isdigit() for head in heads):
        return Record(
            **{head: message(_below(head, fields), _below(head, values)) for head in heads},
            wire_types={head: _wire_type(_below(head, fields)) for head in heads},
        )
    element: dict[Path, Field] = {}
    for head in heads:
        element |= _below(head, fields)
    length = 1 + max((int(path[0]) for path in values if int(path[0]) < LONGEST), default=-1)
    if () in element:
        return [_whole(values.get((str(index),)), element[()]) for index in range(length)]
    return [message(element, _below(str(index), values)) for index in range(length)]


def new_object(
    distribution: RosDistribution, interface: rosgraph.Interface, section: Section, path: Iterable[str]
) -> Any:
    """Return the object at a path in new data of a type; if the type is unknown, all its fields are zero."""
    reached = distribution.type_at(interface.package, interface.type, section, path)
    if reached is None or not isinstance(reached[0], NestedType):
        return BLANK
    return new_value(*reached, distribution)


def new_value(kind: WireType, section: Section, distribution: RosDistribution) -> Any:
    """Return new data of a type; if the definition of an object is unknown, all its fields are zero."""
    match kind:
        case Basic():
            return kind.initial
        case Sequence():
            elements = kind.default or (new_value(kind.element, section, distribution),) * kind.initial_length
            return list(elements)
    try:
        fields = distribution.fields(kind.package, kind.name, section)
    except DefinitionError:
        fields = None
    if fields is None:
        return BLANK
    values = {name: new_value(field, Section.MESSAGE, distribution) for name, field in fields.items()}
    if str(kind) == "geometry_msgs/Quaternion":
        values["w"] = 1.0  # nodes set it in ROS 1, too
    return Record(**values, wire_types={name: str(field) for name, field in fields.items()})


def leaf_values(fields: Any, path: Path = ()) -> dict[Path, Leaf]:
    """Return the values in nested fields by their paths; an array element without fields is a value."""
    if isinstance(fields, list):
        fields = {str(index): inner for index, inner in enumerate(fields)}
    if not isinstance(fields, dict) or (not fields and path and path[-1].isdigit()):
        return {path: fields}
    leaves: dict[Path, Leaf] = {}
    for name, inner in fields.items():
        leaves |= leaf_values(inner, (*path, name))
    return leaves


def _whole(value: Leaf | None, field: Field) -> Any:
    """Return a value as ROS has it: the default for objects and for missing values."""
    return field.default if value is None or isinstance(value, dict) else value


def fields_sent(assignment: rosgraph.FieldAssignment) -> Iterator[tuple[Path, ex.Type]]:
    """Yield the fields of data to be sent that an assignment sets, with all known fields of a forwarded object."""
    path, value = tuple(assignment.path), assignment.value
    yield path, assignment.type
    if isinstance(value, rosgraph.WireAccess) and value.variable and isinstance(assignment.type, rosgraph.ObjectType):
        for inner, kind in parts_of(value.variable.type, path_of(value)):
            end = inner.index(EACH) if EACH in inner else None
            yield path + inner[:end], kind if end is None else rosgraph.ArrayType()


def _wire_type(fields: Mapping[Path, Field]) -> str:
    """Return the type of an object with these fields, or of an array with these elements."""
    if () in fields:
        return fields[()].wire_type
    element = next((path[0] for path in fields if path[0].isdigit()), None)
    return "walk/Object" if element is None else f"{_wire_type(_below(element, fields))}[]"


def _below(head: str, paths: Mapping[Path, Any]) -> dict[Path, Any]:
    return {path[1:]: value for path, value in paths.items() if path and path[0] == head}
