"""What the node tells about itself: values, data of events and states as expressions of its `Json` type."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.comments import string_literal
from robosc.m2t.cpp.expressions import CppPrinter, parts, reads_elements
from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.m2t.cpp.names import CppNames

_Path = tuple[str, ...]


@dataclass(frozen=True)
class EventData:
    """Data of an event, for the event log; left out where it reads past the end of an array."""

    json: str
    reads_elements: bool


@dataclass(frozen=True)
class Component:
    """A component in `~/state`: its name as a literal, its state, and names and values of its variables."""

    name: str
    state: str
    variables: list[tuple[str, str]]


def received(values: Sequence[ex.Expression], names: CppNames) -> EventData | None:
    """What the node reads of a message, in the shape of the message; basic data is the value itself."""
    printer = CppPrinter(names)
    found: dict[_Path, tuple[ex.Expression, ex.Type | None]] = {}
    for value in values:
        each = iter(parts(value))
        for part in each:
            if isinstance(part, rosgraph.ConversionCall):
                kind = ex.EnumerationType(enumeration=part.conversion.enumeration)
                found.setdefault(_path(next(each)), (part, kind))  # its argument follows
            elif isinstance(part, rosgraph.WireAccess):
                found.setdefault(_path(part), (part, part.type))
    if not found:
        return None
    if list(found) == [("data",)]:
        found = {(): found["data",]}
    texts = {path: _json(printer(part), kind, names) for path, (part, kind) in found.items()}
    return EventData(_nested(texts), any(reads_elements(part) for part, _ in found.values()))


def component(plant: sct.Plant, variables: Sequence[rosgraph.NodeVariable], names: CppNames) -> Component:
    """A component with the variables that the supervisor and the node keep for it."""
    if len(plant.locations) == 1:
        state = string_literal(plant.locations[0].name)
    else:
        state = f"{names.c.lookup(plant)}({names.state(plant)})"
    return Component(
        string_literal(plant.origin or plant.name),
        state,
        [
            *((string_literal(each.name), _json(_state(each, names), each.type, names)) for each in plant.variables),
            *(
                (string_literal(each.name), _json(f"data_.{names.variable(each)}", each.type, names))
                for each in variables
            ),
        ],
    )


def _state(variable: sct.DiscreteVariable, names: CppNames) -> str:
    return f"Integer({names.state(variable)})" if isinstance(variable.type, ex.IntegerType) else names.state(variable)


def _json(value: str, kind: ex.Type | None, names: CppNames) -> str:
    if isinstance(kind, ex.EnumerationType):
        return f"{names.literal_name(kind.enumeration)}({value})"
    return value


def _path(access: ex.Expression) -> _Path:
    assert isinstance(access, rosgraph.WireAccess)
    return tuple(
        step.name if isinstance(step, rosgraph.FieldStep) else str(step.index)  # type: ignore[attr-defined]
        for step in access.steps
    )


def _nested(texts: Mapping[_Path, str]) -> str:
    if () in texts:
        return texts[()]
    inner = {
        head: {path[1:]: text for path, text in texts.items() if path[0] == head}
        for head in dict.fromkeys(path[0] for path in texts)
    }
    return "Json::object()" + "".join(
        f".add({string_literal(head)}, {_nested(below)})" for head, below in inner.items()
    )
