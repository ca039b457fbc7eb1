"""The node's reports on itself: values, data of events and states as expressions of its `Json` type."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.m2t.c.comments import string_literal
from robosc.m2t.ros.expressions import CppPrinter, convert
from robosc.model import expression as ex
from robosc.model import rosgraph, sct
from robosc.model.semantics.messages import MessageRead, access_to, logged_data, reads_elements

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.m2t.ros.names import CppNames
    from robosc.model.semantics.messages import Path, Shown


@dataclass(frozen=True)
class Member:
    """A part of an event's data: its path as a literal, its value.

    If it `reads_elements`, it reads them by `element`.
    """

    path: str
    value: str
    reads_elements: bool


@dataclass(frozen=True)
class EventData:
    """Data of an event for the event log: one expression, or one for each member if it reads elements of arrays.

    Missing elements are omitted.
    """

    json: str
    members: list[Member]


@dataclass(frozen=True)
class Component:
    """A component in `~/state`: its name as a literal, its state, and names and values of its variables."""

    name: str
    state: str
    variables: list[tuple[str, str]]


def received_parts(values: Sequence[ex.Expression], names: CppNames) -> EventData | None:
    """Return the parts of a message that the node reads, in the message's structure. Basic data is the value itself."""
    printer = CppPrinter(names, reader="element")
    parts = logged_data(values)
    if not parts:
        return None
    texts = {path: _value(path, part, printer, names) for path, part in parts.items()}
    if list(texts) == [("data",)]:
        texts = {(): texts["data",]}
    reading = {path for path, part in parts.items() if _reads_elements(path, part)}
    if not reading:
        return EventData(_nested(texts), [])
    return EventData("", [Member(_dotted(path), texts[path], path in reading) for path in _grouped(texts)])


def _value(path: Path, part: MessageRead | Shown, printer: CppPrinter, names: CppNames) -> str:
    """Return the reported value at the end of a path."""
    if isinstance(part, MessageRead):
        kind = ex.EnumerationType(enumeration=part.conversion.enumeration) if part.conversion else part.type
        text = printer(part.reference)
        return _json(text, kind, names) if part.is_value else f"(static_cast<void>({text}), Json::object())"
    return _list(printer.wire(access_to(path)), part, names)


def _list(array: str, parts: Shown, names: CppNames, depth: int = 1) -> str:
    """Return the reported elements of an array."""
    element = f"element{depth}"

    def text(path: Path, part: MessageRead | Shown) -> str:
        place = ".".join((element, *path))
        if not isinstance(part, MessageRead):
            return _list(place, part, names, depth + 1)
        if part.conversion is not None:
            kind = ex.EnumerationType(enumeration=part.conversion.enumeration)
            return _json(f"{names.conversion(part.conversion)}({place})", kind, names)
        return convert(place, part.type) if part.type is not None else "Json::object()"

    value = _nested({path: text(path, part) for path, part in parts.items()})
    return f"json_list({array}, []([[maybe_unused]] const auto& {element}) {{ return {value}; }})"


def _reads_elements(path: Path, part: MessageRead | Shown) -> bool:
    return reads_elements(part.reference) if isinstance(part, MessageRead) else any(map(str.isdigit, path))


def component(plant: sct.Plant, variables: Sequence[rosgraph.NodeVariable], names: CppNames) -> Component:
    """Return a component with its variables in the supervisor and in the node."""
    if len(plant.locations) == 1:
        state = string_literal(plant.locations[0].name)
    else:
        state = f"{names.c.lookup(plant)}({names.state(plant)})"
    return Component(
        string_literal(plant.origin or plant.name),
        state,
        [
            *(
                (string_literal(variable.name), _json(_state(variable, names), variable.type, names))
                for variable in plant.variables
            ),
            *(
                (string_literal(variable.name), _json(f"data_.{names.variable(variable)}", variable.type, names))
                for variable in variables
            ),
        ],
    )


def _state(variable: sct.DiscreteVariable, names: CppNames) -> str:
    return f"Integer({names.state(variable)})" if isinstance(variable.type, ex.IntegerType) else names.state(variable)


def _json(value: str, kind: ex.Type | None, names: CppNames) -> str:
    if isinstance(kind, ex.EnumerationType):
        return f"{names.literal_name(kind.enumeration)}({value})"
    return value


def _dotted(path: Path) -> str:
    return string_literal(".".join(path))


def _grouped(paths: Iterable[Path]) -> list[Path]:
    """Return the paths grouped by object. An object is at the position of its first member."""
    heads: dict[Path, list[Path]] = {}
    for path in paths:
        heads.setdefault(path[:1], []).append(path)
    return [
        head + rest
        for head, group in heads.items()
        for rest in ([()] if group == [head] else _grouped(path[1:] for path in group))
    ]


def _nested(texts: Mapping[Path, str]) -> str:
    if () in texts:
        return texts[()]
    inner = {
        head: {path[1:]: text for path, text in texts.items() if path[0] == head}
        for head in dict.fromkeys(path[0] for path in texts)
    }
    return "Json::object()" + "".join(
        f".add({string_literal(head)}, {_nested(below)})" for head, below in inner.items()
    )
