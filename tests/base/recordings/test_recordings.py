"""Recordings in every ROS format are read alike, and damaged ones are reported by name."""

from __future__ import annotations

import json
import os
import sqlite3
from contextlib import closing
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

import pytest
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_typestore

import robosc
from robosc.base.recordings import RecordedText, Recording, RecordingError, bounds, is_recording, recorded_texts
from robosc.base.recordings.decoding import DecodingError
from robosc.run.simulation import Simulation
from robosc.run.simulation.sources import PlayError, recorded_moments

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

ROS1, ROS2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.ROS2_JAZZY)
TEXTS = [
    RecordedText("/courier/definition", "{}"),
    *(RecordedText(f"/courier/{name}", f"{name} {number} ü") for number in range(40) for name in ("state", "other")),
]
SECOND = 1_000_000_000


def write_bag(path: Path, texts: Sequence[RecordedText]) -> Path:
    with Ros1Writer(path := path.with_suffix(".bag")) as writer:
        made = {topic: writer.add_connection(topic, "std_msgs/msg/String", typestore=ROS1) for topic in topics(texts)}
        number = writer.add_connection("/number", "std_msgs/msg/Int8", typestore=ROS1)
        writer.write(number, 0, b"\7")
        for time, (topic, text) in enumerate(texts):
            writer.write(made[topic], time * SECOND, bytes(ROS1.serialize_ros1(message(ROS1, text), STRING)))
    return path


def write_folder(plugin: StoragePlugin) -> Callable[[Path, Sequence[RecordedText]], Path]:
    def write(path: Path, texts: Sequence[RecordedText]) -> Path:
        with Ros2Writer(path, version=9, storage_plugin=plugin) as writer:
            made = {topic: writer.add_connection(topic, STRING, typestore=ROS2) for topic in topics(texts)}
            number = writer.add_connection("/number", "std_msgs/msg/Int8", typestore=ROS2)
            writer.write(number, 0, b"\0\1\0\0\7")
            for time, (topic, text) in enumerate(texts):
                writer.write(made[topic], time * SECOND, bytes(ROS2.serialize_cdr(message(ROS2, text), STRING)))
        return path

    return write


def write_mcap(encoding: str, compression: CompressionType) -> Callable[[Path, Sequence[RecordedText]], Path]:
    def write(path: Path, texts: Sequence[RecordedText]) -> Path:
        path = path.with_suffix(".mcap")
        with path.open("wb") as file:
            writer = McapWriter(file, chunk_size=1024, compression=compression)
            writer.start()
            name = STRING if encoding == "cdr" else "std_msgs/String"
            schema = writer.register_schema(name, "ros2msg" if encoding == "cdr" else "ros1msg", b"string data")
            other = writer.register_schema("foxglove.Log", "jsonschema", b"{}")
            logged = writer.register_channel("/log", "json", other)
            writer.add_message(logged, 0, b"{}", 0)
            made = {topic: writer.register_channel(topic, encoding, schema) for topic in topics(texts)}
            for time, (topic, text) in enumerate(texts):
                store = ROS2 if encoding == "cdr" else ROS1
                serialize = store.serialize_cdr if encoding == "cdr" else store.serialize_ros1
                writer.add_message(made[topic], time * SECOND, bytes(serialize(message(store, text), STRING)), 0)
            writer.finish()
        return path

    return write


STRING = "std_msgs/msg/String"
FORMATS = {
    "ROS 1 bag": write_bag,
    "ROS 2 bag, SQLite": write_folder(StoragePlugin.SQLITE3),
    "ROS 2 bag, MCAP": write_folder(StoragePlugin.MCAP),
    "MCAP of ROS 2": write_mcap("cdr", CompressionType.ZSTD),
    "MCAP of ROS 2, LZ4": write_mcap("cdr", CompressionType.LZ4),
    "MCAP of ROS 1": write_mcap("ros1", CompressionType.NONE),
}


def topics(texts: Sequence[RecordedText]) -> list[str]:
    return list(dict.fromkeys(topic for topic, _ in texts))


def message(store: object, text: str) -> object:
    return store.types[STRING](data=text)  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_is_read(name: str, tmp_path: Path) -> None:
    path = FORMATS[name](tmp_path / "recording", TEXTS)
    assert is_recording(str(path))
    assert list(recorded_texts(str(path))) == TEXTS


@pytest.mark.parametrize("name", FORMATS)
def test_a_damaged_recording_is_named(name: str, tmp_path: Path) -> None:
    """Change random bytes or truncate the file: each damage is reported or has no effect."""
    path = FORMATS[name](tmp_path / "recording", TEXTS)
    files = [file for file in path.iterdir() if file.suffix != ".yaml"] if path.is_dir() else [path]
    whole, random = files[0].read_bytes(), Random(7)
    for number in range(60):
        damaged = bytearray(whole)
        if number % 3:
            for _ in range(random.randint(1, 20)):
                damaged[random.randrange(len(damaged))] = random.randrange(256)
        else:
            del damaged[random.randrange(len(damaged)) :]
        files[0].write_bytes(damaged)
        try:
            list(recorded_texts(str(path)))
        except RecordingError as error:
            assert str(path) in str(error)  # noqa: PT017


def test_what_was_recorded_before_the_power_was_cut_is_read(tmp_path: Path) -> None:
    path = write_mcap("cdr", CompressionType.NONE)(tmp_path / "recording", TEXTS)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    read = list(recorded_texts(str(path)))
    assert 0 < len(read) < len(TEXTS)
    assert read == TEXTS[: len(read)]


def test_what_is_no_recording_is_named(tmp_path: Path) -> None:
    for name in ("none.db3", "none.mcap", "none.bag"):
        (tmp_path / name).write_bytes(b"nothing of a recording")
    (tmp_path / "folder").mkdir()
    with pytest.raises(RecordingError, match=r"without a metadata\.yaml"):
        list(recorded_texts(str(tmp_path / "folder")))
    for name in ("none.db3", "none.mcap", "none.bag", "folder"):
        with pytest.raises(RecordingError, match=name):
            list(recorded_texts(str(tmp_path / name)))
    for name in ("absent.mcap", "absent.bag"):
        with pytest.raises(OSError, match=name):
            list(recorded_texts(str(tmp_path / name)))


def test_a_recorded_run_is_followed(tmp_path: Path) -> None:
    """The recording player follows the first node that reports the robot, or the node that the caller names."""
    robot = robosc.load(Path(__file__).parents[3] / "examples" / "line_follower" / "line_follower.rscd")
    model, graph = robosc.to_sct(robot), robosc.to_rosgraph(robot)
    robosc.synthesize(model)
    simulation, random = Simulation(model, graph), Random(2)
    told = []
    for number in range(30):
        happened = simulation.random_step(random)
        assert happened is not None
        state = {
            plant.origin: {
                "state": happened.state[plant.name],
                "variables": {
                    variable.name: happened.state[f"{plant.origin}.{variable.name}"] for variable in plant.variables
                },
            }
            for plant in model.plants
            if plant.kind.name == "behaviour"
        }
        report = {"robot": model.name, "time": 100 + number / 4, "components": state, "transitions": [happened.event]}
        told.append((number / 4, happened.event, dict(happened.state), json.dumps(report)))
    texts = [
        RecordedText("/other/state", '{"robot": "Other"}'),
        RecordedText("/a/definition", "{}"),
        *(RecordedText("/a/state", text) for _, _, _, text in told),
        *(RecordedText("/b/state", text) for _, _, _, text in told[:3]),
    ]
    path = str(write_mcap("cdr", CompressionType.ZSTD)(tmp_path / "run", texts))
    moments = [
        (time, moment.event, dict(moment.state))
        for time, moment in recorded_moments(Simulation(model, graph), path, None)
    ]
    assert [(time, event) for time, event, _ in moments] == [(time, event) for time, event, _, _ in told]
    for (_, _, found), (_, _, state, _) in zip(moments, told, strict=True):
        assert found.items() <= state.items()
    assert len(list(recorded_moments(Simulation(model, graph), path, "/b"))) == 3
    with pytest.raises(PlayError, match=r"no reports of this robot on `/other/state`: .*`Other`"):
        list(recorded_moments(Simulation(model, graph), path, "/other"))


# Hostile recordings


def write_compressed(path: Path, mode: CompressionMode, plugin: StoragePlugin, texts: Sequence[RecordedText]) -> Path:
    writer = Ros2Writer(path, version=9, storage_plugin=plugin)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        connection = writer.add_connection("/courier/state", STRING, typestore=ROS2)
        for time, (_, text) in enumerate(texts):
            writer.write(connection, time * SECOND, bytes(ROS2.serialize_cdr(message(ROS2, text), STRING)))
    return path


@pytest.mark.parametrize("mode", [CompressionMode.FILE, CompressionMode.MESSAGE])
@pytest.mark.parametrize("plugin", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
def test_compressed_folders_have_a_budget(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, mode: CompressionMode, plugin: StoragePlugin
) -> None:
    texts = [RecordedText("/courier/state", "x" * 400_000) for _ in range(5)]
    path = str(write_compressed(tmp_path / "compressed", mode, plugin, texts))
    assert list(recorded_texts(path)) == texts
    monkeypatch.setattr(bounds, "MOST_BYTES", 100_000)
    monkeypatch.setattr(bounds, "RATIO", 2)
    with pytest.raises(RecordingError, match="such a recording is not decompressed"):
        list(recorded_texts(path))


@pytest.mark.parametrize("compression", [CompressionType.LZ4, CompressionType.ZSTD])
def test_chunks_have_a_budget(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, compression: CompressionType) -> None:
    texts = [RecordedText("/courier/state", "x" * 400_000) for _ in range(5)]
    path = str(write_mcap("cdr", compression)(tmp_path / "run", texts))
    assert list(recorded_texts(path)) == texts
    monkeypatch.setattr(bounds, "MOST_BYTES", 100_000)
    monkeypatch.setattr(bounds, "RATIO", 2)
    with pytest.raises(RecordingError, match="such a recording is not decompressed"):
        list(recorded_texts(path))


@pytest.mark.parametrize("compression", [Ros1Writer.CompressionFormat.BZ2, Ros1Writer.CompressionFormat.LZ4])
def test_chunks_of_ros_1_have_a_budget(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, compression: object) -> None:
    path = tmp_path / "run.bag"
    writer = Ros1Writer(path)
    writer.set_compression(compression)
    with writer:
        connection = writer.add_connection("/courier/state", "std_msgs/msg/String", typestore=ROS1)
        writer.write(connection, 0, bytes(ROS1.serialize_ros1(message(ROS1, "x" * 2_000_000), STRING)))
    assert [len(text.text) for text in recorded_texts(str(path))] == [2_000_000]
    monkeypatch.setattr(bounds, "MOST_BYTES", 100_000)
    monkeypatch.setattr(bounds, "RATIO", 2)
    with pytest.raises(RecordingError, match="such a recording is not decompressed"):
        list(recorded_texts(str(path)))


@pytest.mark.parametrize("plugin", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
@pytest.mark.parametrize("is_link", [False, True])
def test_a_pipe_in_a_folder_is_not_read(tmp_path: Path, plugin: StoragePlugin, is_link: bool) -> None:
    path = write_folder(plugin)(tmp_path / "folder", TEXTS)
    (data,) = (file for file in path.iterdir() if file.name != "metadata.yaml")
    data.unlink()
    os.mkfifo(tmp_path / "pipe" if is_link else data)
    if is_link:
        data.symlink_to(tmp_path / "pipe")
    with pytest.raises(OSError, match="only regular files are read"):
        list(recorded_texts(str(path)))


@pytest.mark.parametrize(
    "text",
    [
        "CREATE VIEW messages AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT x FROM n",
        "CREATE TABLE more (id INTEGER, data BLOB AS (zeroblob(900000000)))",
        "CREATE TRIGGER more AFTER INSERT ON topics BEGIN SELECT 1; END",
    ],
)
@pytest.mark.parametrize("is_folder", [True, False])
def test_computed_tables_are_not_read(tmp_path: Path, text: str, is_folder: bool) -> None:
    path = write_folder(StoragePlugin.SQLITE3)(tmp_path / "folder", TEXTS)
    (file,) = path.glob("*.db3")
    with closing(sqlite3.connect(file)) as database:
        if "VIEW" in text:
            database.execute("DROP TABLE messages")
        database.execute(text)
        database.commit()
    with pytest.raises(RecordingError, match="is computed: a recording has stored tables only"):
        list(recorded_texts(str(path if is_folder else file)))


def test_metadata_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    path = write_folder(StoragePlugin.MCAP)(tmp_path / "folder", TEXTS)
    with (path / "metadata.yaml").open("a") as file:
        file.write("#" * (5 << 20))
    with pytest.raises(RecordingError, match="more than 4 MB"):
        list(recorded_texts(str(path)))


#: Definitions of a recording whose reading would not end, or would fill the memory.
HOSTILE = {
    "an array of nothing": "Nothing[] parts\n",
    "a long array of nothing": "Nothing[4000000000] parts\n",
    "a type in itself": "Evil[] parts\n",
    "a type in itself, at once": "Evil part\n",
    "no definition": "what is this\n",
    "an unknown type": "other_msgs/Unknown part\n",
}


@pytest.mark.parametrize("encoding", ["cdr", "ros1"])
@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_definitions_are_refused(name: str, encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "hostile.mcap"
    definition = f"{HOSTILE[name]}{'=' * 80}\nMSG: evil_msgs/Nothing\n"
    with path.open("wb") as file:
        writer = McapWriter(file)
        writer.start()
        schema = writer.register_schema(
            "evil_msgs/Evil", f"ros{1 if encoding == 'ros1' else 2}msg", definition.encode()
        )
        writer.add_message(writer.register_channel("/evil", encoding, schema), 0, b"\0\1\0\0" + b"\xff" * 8, 0)
        writer.finish()
    ((_, channel, data),) = list(Recording(str(path)).messages(lambda *_: True))
    with pytest.raises(DecodingError):
        channel.decode(data)
