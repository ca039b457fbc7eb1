"""Writers of small recordings, in every format that an audit reads."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.interfaces import Nodetype
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from rosbags.typesys.store import Typestore

SECOND = 1_000_000_000
#: Start of the recordings, in seconds since the epoch.
START = 1_700_000_000


class Entry(NamedTuple):
    """A message: seconds since the start, the topic, its type, and the fields that are not default."""

    time: float
    topic: str
    type: str
    fields: Mapping[str, Any] = {}  # never changed

    @property
    def nanoseconds(self) -> int:
        return START * SECOND + round(self.time * SECOND)


def store(version: int, types: Mapping[str, str] | None = None) -> Typestore:
    """Return the types of ROS 1 or 2, with further types by their definitions."""
    known = get_typestore(Stores.ROS1_NOETIC if version == 1 else Stores.ROS2_JAZZY)
    for name, text in (types or {}).items():
        known.register({name: get_types_from_msg(text, name)[name]})
    return known


def message(types: Typestore, kind: str, fields: Mapping[str, Any]) -> Any:
    """Return a message with some fields; nested ones are mappings, arrays lists."""
    _, described = types.fielddefs[kind]
    return types.types[kind](**{name: _value(types, part, fields.get(name)) for name, part in described})


def _value(types: Typestore, described: Any, value: Any) -> Any:
    form, details = described
    match form:
        case Nodetype.BASE:
            empty: Any = {"string": "", "bool": False, "float32": 0.0, "float64": 0.0}.get(details[0], 0)
            return empty if value is None else type(empty)(value)
        case Nodetype.NAME:
            return message(types, details, value or {})
    inner, name = details[0], details[0][1][0]
    values = [0] * details[1] if value is None and form == Nodetype.ARRAY else value or []
    if inner[0] == Nodetype.BASE and name != "string":
        return np.array(values, dtype={"byte": "uint8", "char": "uint8", "bool": "bool"}.get(name, name))
    return [_value(types, inner, each) for each in values]


def write_bag(path: Path, entries: Sequence[Entry], types: Typestore | None = None) -> Path:
    """Write a bag of ROS 1."""
    known = types or store(1)
    with Ros1Writer(path := path.with_suffix(".bag")) as writer:
        made = {topic: writer.add_connection(topic, kind, typestore=known) for topic, kind in _topics(entries).items()}
        for entry in entries:
            data = known.serialize_ros1(message(known, entry.type, entry.fields), entry.type)
            writer.write(made[entry.topic], entry.nanoseconds, bytes(data))
    return path


def write_folder(
    path: Path, entries: Sequence[Entry], types: Typestore | None = None, *, plugin: StoragePlugin
) -> Path:
    """Write a folder as `ros2 bag` does."""
    known = types or store(2)
    with Ros2Writer(path, version=9, storage_plugin=plugin) as writer:
        made = {topic: writer.add_connection(topic, kind, typestore=known) for topic, kind in _topics(entries).items()}
        for entry in entries:
            data = known.serialize_cdr(message(known, entry.type, entry.fields), entry.type)
            writer.write(made[entry.topic], entry.nanoseconds, bytes(data))
    return path


def write_sqlite(path: Path, entries: Sequence[Entry], types: Typestore | None = None) -> Path:
    """Write a folder with a database, with definitions."""
    return write_folder(path, entries, types, plugin=StoragePlugin.SQLITE3)


def write_without_definitions(path: Path, entries: Sequence[Entry], types: Typestore | None = None) -> Path:
    """Write a folder with a database without definitions, as ROS 2 did before Iron."""
    folder = write_sqlite(path, entries, types)
    with closing(sqlite3.connect(next(folder.glob("*.db3")))) as database, database:
        database.execute("DELETE FROM message_definitions")
    return folder


def write_mcap(path: Path, entries: Sequence[Entry], types: Typestore | None = None) -> Path:
    """Write an MCAP file of ROS 2, compressed."""
    return _mcap(path, entries, types or store(2), 2)


def write_mcap_of_ros_1(path: Path, entries: Sequence[Entry], types: Typestore | None = None) -> Path:
    """Write an MCAP file with messages of ROS 1."""
    return _mcap(path, entries, types or store(1), 1)


def _mcap(path: Path, entries: Sequence[Entry], known: Typestore, version: int) -> Path:
    path = path.with_suffix(".mcap")
    with path.open("wb") as file:
        writer = McapWriter(file, chunk_size=4096, compression=CompressionType.ZSTD)
        writer.start()
        made = {}
        for topic, kind in _topics(entries).items():
            text = known.generate_msgdef(kind, ros_version=version)[0]
            name = kind if version == 2 else kind.replace("/msg/", "/")
            schema = writer.register_schema(name, f"ros{version}msg", text.encode())
            made[topic] = writer.register_channel(topic, "cdr" if version == 2 else "ros1", schema)
        for entry in entries:
            serialize = known.serialize_cdr if version == 2 else known.serialize_ros1
            data = bytes(serialize(message(known, entry.type, entry.fields), entry.type))
            writer.add_message(made[entry.topic], entry.nanoseconds, data, entry.nanoseconds)
        writer.finish()
    return path


def _topics(entries: Sequence[Entry]) -> dict[str, str]:
    return {entry.topic: entry.type for entry in entries}


FORMATS: dict[str, Callable[[Path, Sequence[Entry]], Path]] = {
    "ROS 1 bag": write_bag,
    "ROS 2 bag, SQLite": write_sqlite,
    "ROS 2 bag, SQLite without definitions": write_without_definitions,
    "ROS 2 bag, MCAP": lambda path, entries: write_folder(path, entries, plugin=StoragePlugin.MCAP),
    "MCAP of ROS 2": write_mcap,
    "MCAP of ROS 1": write_mcap_of_ros_1,
}
