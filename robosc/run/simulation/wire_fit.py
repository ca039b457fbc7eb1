"""Check whether JSON fits its ROS type and the reads of the model."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.base.ros_types import DefinitionError, RosDistribution, RosTypes, Section
from robosc.base.ros_types.unknown_fields import unknown_field
from robosc.base.ros_types.wire import INTEGER_RANGES, PRIMITIVES, Basic, NestedType, Sequence, WireType
from robosc.model import expression as ex
from robosc.model import rosgraph
from robosc.model.semantics.messages import EACH, MessageRead, kept_reads, receptions, sections
from robosc.model.semantics.messages import reads as all_reads
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from robosc.base.ros_types.wire import Value
    from robosc.model.semantics.messages import Path

#: The index of an element has fewer digits.
DIGITS = 10
#: Maximum number of characters shown of a value in a message.
_SHOWN = 60
#: Half a unit above the greatest float32: the least number that is rounded to infinity.
_FLOAT32 = (2 - 2**-24) * 2.0**127
#: Displayed name of each basic type of ROS and of RoboSC.
_CALLED = {"boolean": "a boolean", "integer": "an integer", "double": "a number", "string": "a string"}
_LIST = "a list, or an object from index to element"
#: Widest type of each kind, for data whose definition is unknown.
_WIDEST: Mapping[type[ex.Type], str] = {ex.BooleanType: "bool", ex.DoubleType: "float64", ex.StringType: "string"}
#: Candidate types of an integer of unknown type.
_INTEGERS = ("int64", "uint64")


class Fault(NamedTuple):
    """Fault of JSON data, and a hint to fix it."""

    message: str
    hint: str | None = None


def in_short(value: Any) -> str:
    """Return the JSON text of a value, shortened if it is long."""
    text = json.dumps(value, ensure_ascii=False, default=repr)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"


class _Kind(NamedTuple):
    """Type as one distribution defines it."""

    type: WireType
    section: Section
    distribution: RosDistribution

    @property
    def fields(self) -> Mapping[str, WireType] | None:
        """The fields of an object; None if they are unknown."""
        if not isinstance(self.type, NestedType):
            return None
        try:
            return self.distribution.fields(self.type.package, self.type.name, self.section)
        except DefinitionError:
            return None

    @property
    def is_known(self) -> bool:
        """Whether the definition of the type is known."""
        return not isinstance(self.type, NestedType) or self.fields is not None

    def inside(self, step: str, *, is_element: bool) -> _Kind | None:
        """Return the type of a field or an element; None if it is unknown."""
        if is_element:
            return self._replace(type=self.type.at(int(step))) if isinstance(self.type, Sequence) else None
        field_type = (self.fields or {}).get(step)
        return None if field_type is None else self._replace(type=field_type, section=Section.MESSAGE)


@dataclass(frozen=True)
class _Part:
    """Part of the data: JSON, its types, the model's reads of it, and the path to it.

    `is_lone`: the data is the value of its only field. `conversions`: the enumerations whose literals it may name.
    """

    value: Any
    kinds: tuple[_Kind, ...]
    reads: tuple[tuple[Path, MessageRead], ...]
    path: Path = ()
    is_lone: bool = False
    literals: bool = True
    conversions: tuple[rosgraph.Conversion, ...] = ()

    @property
    def place(self) -> str:
        """The place of the part in the data."""
        return place(self.path[1:] if self.is_lone else self.path)

    @property
    def is_literal(self) -> bool:
        """Whether it is the name of a literal of an enumeration that is made of the part."""
        return isinstance(self.value, str) and any(
            self.value == literal.name for conversion in self.conversions for literal in conversion.enumeration.literals
        )

    @property
    def is_array(self) -> bool:
        """Whether the part stands for an array."""
        kinds = [kind for kind in self.kinds if kind.is_known]
        if kinds:
            return isinstance(kinds[0].type, Sequence)
        return any(_is_index(path[0]) for path, _ in self.reads if path)

    @property
    def parts(self) -> Iterator[_Part]:
        """The fields or elements."""
        is_array = self.is_array
        items = enumerate(self.value) if isinstance(self.value, list) else self.value.items()
        for key, value in items:
            step = str(key)
            kinds = (kind.inside(step, is_element=is_array) for kind in self.kinds)
            reads = (
                (path[1:], message_read)
                for path, message_read in self.reads
                if path and (path[0] == step or (is_array and _is_index(path[0])))
            )
            yield replace(
                _open_part(tuple(reads), self.literals),
                value=value,
                kinds=tuple(kind for kind in kinds if kind is not None),
                path=(*self.path, step),
                is_lone=self.is_lone,
            )


def _is_index(step: str) -> bool:
    return step == EACH or step.isdigit()


def place(path: Path) -> str:
    """Return the place of data at the end of a path, as `value.rows[1]`."""
    return "value" + "".join(f"[{step}]" if step.isdigit() else f".{step}" for step in path)


def _open_part(reads: tuple[tuple[Path, MessageRead], ...], literals: bool) -> _Part:
    """Return a part with its reads, also those by the rules of enumerations."""
    opened: list[tuple[Path, MessageRead]] = []
    conversions: list[rosgraph.Conversion] = []
    pending = list(reads)
    while pending:
        path, message_read = pending.pop()
        opened.append((path, message_read))
        if not path and message_read.conversion is not None and message_read.conversion not in conversions:
            conversions.append(message_read.conversion)
            pending += all_reads([rule.condition for rule in message_read.conversion.rules])
    return _Part(None, (), tuple(opened), literals=literals, conversions=tuple(conversions) if literals else ())


class WireFit:
    """Comparison of JSON data with the ROS types and the reads of events."""

    def __init__(self, graph: rosgraph.RosGraph, types: RosTypes | None) -> None:
        """`types`: the definitions of ROS types; None: those of the environment."""
        self._types = types
        self._sections = sections(graph)
        self._reads: dict[str, tuple[tuple[Path, MessageRead], ...]] = {}
        values: dict[str, list[ex.Expression]] = {}
        for reception in receptions(graph):
            name = event_name(reception.event)
            values[name] = [assignment.value for assignment in reception.inputs]
        for reaction in graph.reactions:
            values.setdefault(event_name(reaction.event), []).extend(
                assignment.value for assignment in reaction.assignments
            )
        stored = [(event_name(owner.event), path, message_read) for owner, path, message_read in kept_reads(graph)]
        for name, several in values.items():
            later = [(path, message_read) for owner, path, message_read in stored if owner == name]
            self._reads[name] = (*all_reads(several), *later)
        clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = [*graph.serviceClients, *graph.actionClients]
        for client in clients:  # an error may be an answer that can't be read
            error, response = event_name(client.error.event), event_name(client.response.event)
            self._reads[error] = (*self._reads.get(error, ()), *self._reads.get(response, ()))

    @property
    def types(self) -> RosTypes:
        """The definitions of ROS types."""
        self._types = self._types or RosTypes()
        return self._types

    def wire_type(self, event: str, path: tuple[str, ...]) -> WireType | None:
        """Return the type of a field in ROS 2 or else ROS 1; None if it is unknown."""
        reached_types = (known.type_at(*self._sections[event], path) for known in self.types.distributions)
        return next((reached[0] for reached in reached_types if reached is not None), None)

    def fault(self, event: str, value: Any, *, is_message: bool = False) -> Fault | None:
        """Return a fault of the first part of an event's data that its ROS type or the model rejects, else None.

        `is_message`: the data has the fields of the ROS message, without names of literals.
        """
        if event not in self._sections:
            return None
        unknown = unknown_field(self.types.distributions, *self._sections[event], value)
        if unknown is not None:
            return Fault(unknown[0], f"did you mean `{unknown[1]}`?" if unknown[1] else None)
        pending = [self._whole(event, value, literals=not is_message)]
        while pending:
            part = pending.pop()
            if part.is_literal:
                continue
            expected = _expected(part)
            if expected is not None:
                others = [
                    literal.name for conversion in part.conversions for literal in conversion.enumeration.literals
                ]
                expected = ", ".join([*others, f"or {expected}"]) if others else expected
                return Fault(f"{part.place} is {in_short(part.value)}, expected {expected}")
            if isinstance(part.value, list | dict) and not _has_fitting_numbers(part):
                pending += part.parts
        return None

    def set_part(self, event: str, value: Any, literal: Callable[[rosgraph.Conversion, Path], str]) -> str | None:
        """Return the first part of an event's data that differs from a new message of its type, else None.

        `literal`: the name of the literal that a conversion makes of the data at a path in a new message.
        """
        pending = [self._whole(event, value)] if event in self._sections else []
        while pending:
            part = pending.pop()
            if part.is_literal:
                if not any(part.value == literal(conversion, part.path) for conversion in part.conversions):
                    return f"{part.place} is {in_short(part.value)}"
            elif isinstance(part.value, list | dict):
                parts = list(part.parts)
                arrays = (kind.type for kind in part.kinds)
                length = max((wire.initial_length for wire in arrays if isinstance(wire, Sequence)), default=0)
                if part.is_array and any(int(inside.path[-1]) >= length for inside in parts):
                    return f"{part.place} has elements"
                pending += parts
            elif not any(_same(part.value, initial) for initial in _initial(part)):
                return f"{part.place} is {in_short(part.value)}"
        return None

    def _whole(self, event: str, value: Any, *, literals: bool = True) -> _Part:
        """Return all data of an event; a lone value stands for the only field that is read, or that exists."""
        package, name, section = self._sections[event]
        kinds = tuple(_Kind(NestedType(package, name), section, known) for known in self.types.distributions)
        reads = self._reads.get(event, ())
        part = replace(_open_part(reads, literals), value=value, kinds=kinds)
        if isinstance(value, dict) or part.is_literal:
            return part
        heads = {path[0] if path else "" for path, _ in part.reads}
        if not part.reads:
            heads = {self.types.field_of_basic(package, name, section)}
        fields = {name for kind in kinds for name in kind.fields or ()}
        if len(heads) != 1 or (any(kind.is_known for kind in kinds) and not heads <= fields):
            return part
        return next(replace(part, value={next(iter(heads)): value}, is_lone=True).parts)


def _has_fitting_numbers(part: _Part) -> bool:
    """Return whether the part is a list of basic values that fit: a scan has many, and a log has many scans."""
    elements = [kind.type.element for kind in part.kinds if isinstance(kind.type, Sequence)]
    wires = [element for element in elements if isinstance(element, Basic)]
    if not isinstance(part.value, list) or not wires or len(wires) < len(part.kinds):
        return False
    return all(any(_misfit(wire, value) is None for wire in wires) for value in part.value)


def _expected(part: _Part) -> str | None:
    """Return the expected data in place of a part; None if the part fits."""
    kinds = [kind for kind in part.kinds if kind.is_known]
    if kinds:
        expected = [_misfit(kind.type, part.value) for kind in kinds]
        return None if None in expected else expected[0]
    for path, message_read in part.reads:
        if path:
            misfit = _misfit(Sequence(NestedType("", "")) if _is_index(path[0]) else NestedType("", ""), part.value)
        elif isinstance(message_read.type, ex.IntegerType):
            several = [_misfit(Basic(name), part.value) for name in _INTEGERS]
            misfit = None if None in several else several[0]
        elif isinstance(message_read.type, ex.BooleanType | ex.DoubleType | ex.StringType):
            misfit = _misfit(Basic(_WIDEST[type(message_read.type)]), part.value)
        elif isinstance(message_read.type, rosgraph.ArrayType):
            misfit = _misfit(Sequence(NestedType("", "")), part.value)
        else:
            misfit = None
        if misfit is not None:
            return misfit
    return None


def _misfit(wire: WireType, value: Any) -> str | None:
    """Return the expected data in place of a value; None if the value fits the type."""
    match wire:
        case NestedType():
            return None if isinstance(value, dict) else "an object"
        case Sequence():
            return _misfit_of_array(wire, value)
    kind = PRIMITIVES[wire.name].name if wire.name in PRIMITIVES else "string"
    plain: Any = {"boolean": bool, "integer": int, "double": int | float, "string": str}[kind]
    if kind == "double" and value is None:
        return None  # an event log has null for a number that is not finite
    if not isinstance(value, plain) or (isinstance(value, bool) and kind != "boolean"):
        return _CALLED[kind]
    if kind == "integer":
        low, high = INTEGER_RANGES[wire.name]
        return None if low <= value <= high else f"an integer from {low} to {high} ({wire.name})"
    if kind == "string" and any("\ud800" <= character <= "\udfff" for character in value):
        return "a text that UTF-8 can encode"
    if wire.name == "float32" and abs(value) >= _FLOAT32:
        return "a number that a float32 holds"
    return None


def _misfit_of_array(wire: Sequence, value: Any) -> str | None:
    if isinstance(value, list):
        length = len(value)
    elif isinstance(value, dict) and all(index.isdecimal() and len(index) < DIGITS for index in value):
        length = max(map(int, value), default=-1) + 1
    else:
        return _LIST
    return None if wire.length is None or length <= wire.length else f"at most {wire.length} elements"


def _initial(part: _Part) -> Iterator[Value]:
    """Yield the values of a part in a new message, as each distribution has it; zeros if they are unknown."""
    kinds = [kind.type for kind in part.kinds if isinstance(kind.type, Basic)]
    yield from (kind.initial for kind in kinds) if kinds else (False, 0, 0.0, "")


def _same(value: Any, other: Value) -> bool:
    """Return whether a value of JSON equals that of a field, up to the precision of a float32."""
    numbers = (int, float)
    if isinstance(value, numbers) and isinstance(other, numbers):
        return math.isclose(value, other, rel_tol=1e-6)
    return bool(value == other)
