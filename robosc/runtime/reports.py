"""The event log, and the data of events in it."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING

from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph
from robosc.metamodel.reflection import tree
from robosc.output import open_log
from robosc.runtime.json_text import Json, json_text
from robosc.runtime.node_data import PastEndError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from robosc.evaluation import Value
    from robosc.runtime.node_data import NodeData
    from robosc.runtime.port import Message

_Path = tuple[str, ...]


def default_log(node: str, package: str) -> str:
    """Where a log goes that nobody named: the folder of ROS's own logs.

    `node` is the node's full name, such as `/left/base`; where it was renamed, its package is told, too.
    """
    folder = os.environ.get("ROS_LOG_DIR")
    if not folder:
        home = os.environ.get("ROS_HOME")
        folder = str(Path(home) / "log" if home else Path.home() / ".ros" / "log")
    with suppress(OSError):  # the log itself complains
        Path(folder).mkdir(parents=True, exist_ok=True)
    parts = node.strip("/").split("/")
    if parts[-1] != package:
        parts.append(package)
    return str(Path(folder) / f"{'.'.join(parts)}-events.jsonl")


class EventLog:
    """A file that gets a line of JSON for each event; without a name, none. Raises OSError."""

    def __init__(self, path: str) -> None:
        self._file: IO[str] | None = (
            os.fdopen(open_log(path), "a", encoding="utf-8", errors="replace", buffering=1) if path else None
        )

    @property
    def active(self) -> bool:
        """Whether anything is written."""
        return self._file is not None

    def write(self, time: float, direction: str, event: str, data: Mapping[str, Json] | None = None) -> None:
        """A line; `data` is what came in or went out with the event, as `{"value": ...}`."""
        if self._file is not None:
            entry: dict[str, Json] = {"time": time, "direction": direction, "event": event}
            if data is not None:
                entry["data"] = data
            self._file.write(json_text(entry) + "\n")

    def close(self) -> None:
        """Nothing more will be written."""
        if self._file is not None:
            self._file.close()
            self._file = None


class ReceivedData:
    """What the node reads of the data of one event, in the shape of the message; basic data is the value itself."""

    def __init__(self, values: Iterable[ex.Expression]) -> None:
        found: dict[_Path, ex.Expression] = {}
        for value in values:
            for part in _outermost_reads(value):
                access = part.argument if isinstance(part, rosgraph.ConversionCall) else part
                found.setdefault(_path(access), part)
        #: What is read, by the names and indices on the way to it.
        self.parts: Mapping[tuple[str, ...], ex.Expression] = found
        self._found = {(): found["data",]} if list(found) == [("data",)] else found

    def read(self, data: NodeData, message: Message) -> Mapping[str, Json] | None:
        """The data for the log; None where the node reads nothing, or past the end of an array."""
        if not self._found:
            return None
        try:
            values = {path: shown(data.value(part, message)) for path, part in self._found.items()}
        except PastEndError:
            return None
        return {"value": values[()] if () in values else nested(values)}


def _outermost_reads(value: ex.Expression) -> Iterator[rosgraph.ConversionCall | rosgraph.WireAccess]:
    argument = None
    for _, part in tree(value):
        if isinstance(part, rosgraph.ConversionCall):
            argument = part.argument
            yield part
        elif isinstance(part, rosgraph.WireAccess) and part is not argument:
            yield part


def _path(access: rosgraph.WireAccess) -> _Path:
    return tuple(
        step.name if isinstance(step, rosgraph.FieldStep) else str(step.index)  # type: ignore[attr-defined]
        for step in access.steps
    )


def nested(values: Mapping[_Path, Json]) -> dict[str, Json]:
    """Objects in objects, from paths of names to values."""
    made: dict[str, Json] = {}
    for path, value in values.items():
        owner = made
        for name in path[:-1]:
            owner = owner.setdefault(name, {})  # type: ignore[assignment]
        owner[path[-1]] = value
    return made


def shown(value: Value) -> Json:
    """A value as reports show it: a literal by its name."""
    if isinstance(value, ex.EnumerationLiteral):
        return value.name
    assert isinstance(value, (bool, int, float, str))
    return value
