"""Event log and the data of its events as JSON: the generated nodes write the same bytes for the same data."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from pathlib import Path
from threading import Condition, Thread
from typing import IO, TYPE_CHECKING, Any

from robosc.base.files.writing import open_log
from robosc.model import expression as ex
from robosc.model.semantics.messages import MessageRead, reads_reason
from robosc.model.semantics.messages import logged_data as all_shown
from robosc.model.semantics.operators import UnreadableError
from robosc.run.runtime.core.json_text import json_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.model.semantics.evaluation import Value
    from robosc.model.semantics.messages import Shown
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.node_data import NodeData
    from robosc.run.runtime.core.port import Message

_Path = tuple[str, ...]


def default_log(node: str, package: str) -> str:
    """Return the default path of a log: in the log folder of ROS.

    `node` is the node's full name, such as `/left/base`. The file name of a renamed node has its package, too.
    """
    folder = os.environ.get("ROS_LOG_DIR")
    if not folder:
        home = os.environ.get("ROS_HOME")
        folder = str(Path(home) / "log" if home else Path.home() / ".ros" / "log")
    with suppress(OSError):  # opening the log reports the error
        Path(folder).mkdir(parents=True, exist_ok=True)
    parts = node.strip("/").split("/")
    if parts[-1] != package:
        parts.append(package)
    return str(Path(folder) / f"{'.'.join(parts)}-events.jsonl")


#: Seconds between two flushes of a log, and the number of buffered characters after which lines are lost.
_FLUSH, _MOST_BYTES = 0.02, 8 << 20


class EventLog:
    """Log with a line of JSON for each event, appended to a file; an empty path disables it.

    A separate thread writes, so that a slow disk delays no event. Raises OSError if the file can't be opened.
    """

    def __init__(self, path: str) -> None:
        self._changed = Condition()
        self._lines: list[str] = []
        self._size = 0
        self._lost = 0
        self._last_told = -1.0
        self._busy = self._ending = False
        self._thread: Thread | None = None
        if path:
            file = os.fdopen(open_log(path), "ab", buffering=0)
            self._thread = Thread(target=self._run, args=(file,), name="event log", daemon=True)
            self._thread.start()

    @property
    def active(self) -> bool:
        """Whether the log is written."""
        return self._thread is not None

    def write(self, time: float, direction: str, event: str, data: Mapping[str, Json] | None = None) -> None:
        """Append the line of an event, soon. `time` is in seconds.

        `direction` is `in`, `out`, `internal`, `outside`, `blocked` or `violated`. `data` came in or went out with the
        event, as `{"value": ...}`.
        """
        if self.active:
            entry: dict[str, Json] = {"time": time, "direction": direction, "event": event}
            if data is not None:
                entry["data"] = data
            self.append(json_text(entry) + "\n")

    def append(self, line: str) -> None:
        """Append a line, which ends with a line feed; if the buffer is full, the line is lost."""
        with self._changed:
            if self._size + len(line) > _MOST_BYTES:
                self._lost += 1
                return
            self._lines.append(line)
            self._size += len(line)
            if len(self._lines) == 1:
                self._changed.notify_all()

    def lost(self) -> int:
        """Return the number of lines lost since the last report, at most once a second; else 0."""
        with self._changed:
            if not self._lost or time.monotonic() < self._last_told + 1:
                return 0
            self._last_told = time.monotonic()
            lost, self._lost = self._lost, 0
            return lost

    def flush(self) -> None:
        """Wait until all lines that can be written are written."""
        with self._changed:
            self._changed.wait_for(lambda: not self._lines and not self._busy)

    def close(self) -> None:
        """Write all lines and close the log."""
        with self._changed:
            self._ending = True
            self._changed.notify_all()
        if self._thread is not None:
            self._thread.join()
            self._thread = None

    def _run(self, file: IO[bytes]) -> None:
        flushed = 0.0
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._ending or self._lines)
                self._changed.wait_for(lambda: self._ending, max(0.0, flushed + _FLUSH - time.monotonic()))
                lines, self._lines, self._size = self._lines, [], 0
                self._busy, ending = True, self._ending
            try:
                left = memoryview("".join(lines).encode(errors="replace"))
                while left:
                    left = left[file.write(left) :]
            except OSError:
                with self._changed:
                    self._lost += len(lines)
            flushed = time.monotonic()
            with self._changed:
                self._busy = False
                self._changed.notify_all()
            if ending:
                file.close()
                return


class ReceivedData:
    """Data of one event that the node reads, in the shape of the message, and the reason of an error.

    Basic data is the value itself. `has_reason`: the event is an error.
    """

    def __init__(self, values: Iterable[ex.Expression], *, has_reason: bool = False) -> None:
        values = list(values)
        #: The parts that are read, by the names and indices on the way to them.
        self.parts = all_shown(values)
        # An answer that can't be read is an error, too: the reason shows whose data this is.
        self._reads_reason = has_reason and (reads_reason(values) or bool(self.parts))
        parts = self.parts
        self._parts = {(): parts["data",]} if list(parts) == [("data",)] else parts

    def read(self, data: NodeData, message: Message) -> Mapping[str, Json] | None:
        """Return the data for the log without what can't be read; None if nothing remains."""
        values: dict[_Path, Json] = {}
        for path, part in self._parts.items():
            with suppress(UnreadableError):
                if isinstance(part, MessageRead):
                    value = data.value(part.reference, message)
                    values[path] = format_value(value) if part.is_value else {}
                else:
                    array = data.at(message, path or ("data",))
                    values[path] = [_inside(element, part, data) for element in array]
        if not values:
            return self.reason(data) or None
        return {"value": values[()] if () in values else nest(values), **self.reason(data)}

    def reason(self, data: NodeData) -> Mapping[str, Json]:
        """Return the reason of an error if the node reads it."""
        return {"reason": str(data.reason)} if self._reads_reason and data.reason else {}


def _inside(element: Any, parts: Shown, data: NodeData) -> Json:
    """Return the logged data of an element of an array."""
    values: dict[_Path, Json] = {}
    for path, part in parts.items():
        reached = data.at(element, path)
        if not isinstance(part, MessageRead):
            values[path] = [_inside(inner, part, data) for inner in reached]
        elif part.conversion is not None:
            values[path] = format_value(data.convert(part.conversion, reached))
        else:
            values[path] = format_value(data.leaf(reached, part.type)) if part.type is not None else {}
    return values[()] if () in values else nest(values)


def nest(values: Mapping[_Path, Json]) -> dict[str, Json]:
    """Return nested objects from paths of names to values."""
    root: dict[str, Json] = {}
    for path, value in values.items():
        owner = root
        for name in path[:-1]:
            owner = owner.setdefault(name, {})  # type: ignore[assignment]
        owner[path[-1]] = value
    return root


def format_value(value: Value) -> Json:
    """Return a value as reports show it: a literal by its name."""
    if isinstance(value, ex.EnumerationLiteral):
        return value.name
    assert isinstance(value, (bool, int, float, str))
    return value
