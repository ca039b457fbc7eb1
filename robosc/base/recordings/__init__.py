"""Texts in recordings of ROS: bags of ROS 1 and ROS 2, and MCAP files."""

from __future__ import annotations

from contextlib import nullcontext, suppress
from dataclasses import replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple

from robosc.base.files.reading import MOST_BYTES, open_file
from robosc.base.recordings.bounds import BoundError, decompress, limit_decompression, require_plain

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Names of the text message in ROS 1 and ROS 2.
_TEXT = ("std_msgs/String", "std_msgs/msg/String")


class RecordingError(Exception):
    """A recording that cannot be read; the message gives the reason."""


class RecordedText(NamedTuple):
    """A message of `std_msgs/String`, and its topic."""

    topic: str
    text: str


def is_recording(path: str) -> bool:
    """Return whether a path names a recording: a folder that `ros2 bag` wrote, a `.bag` or an `.mcap` file."""
    return Path(path).is_dir() or Path(path).suffix in (".bag", ".mcap", ".db3")


def recorded_texts(path: str) -> Iterator[RecordedText]:
    """Yield the texts of a recording, in the order of their arrival. Raises RecordingError, and OSError.

    A truncated MCAP file, for example after a power failure, is read up to its end.
    """
    recording = Path(path)
    if recording.is_dir() and not (recording / "metadata.yaml").is_file():
        raise RecordingError(f"{path} is a folder without a metadata.yaml: it is not a recording")
    # rosbags opens folders by itself.
    with nullcontext() if recording.is_dir() else open_file(path) as file, limit_decompression(recording):
        try:
            require_plain(recording)
        except BoundError as error:
            raise RecordingError(f"{path} cannot be read: {error}") from None
        yield from _read(
            path, _mcap_texts(file) if file is not None and recording.suffix == ".mcap" else _bag_texts(recording)
        )


def _read(path: str, texts: Iterator[RecordedText]) -> Iterator[RecordedText]:
    try:
        yield from texts
    except Exception as error:  # Readers raise many kinds of exceptions for damaged bytes.
        raise RecordingError(f"{path} cannot be read: {str(error) or type(error).__name__}") from None


def _bag_texts(path: Path) -> Iterator[RecordedText]:
    from rosbags.highlevel import AnyReader  # noqa: PLC0415  # takes long to load
    from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415

    with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
        connections = [connection for connection in reader.connections if connection.msgtype in _TEXT]
        for connection, _, data in reader.messages(connections) if connections else ():
            message: Any = reader.deserialize(data, connection.msgtype)
            yield RecordedText(connection.topic, message.data)


def _mcap_texts(file: IO[bytes]) -> Iterator[RecordedText]:
    from mcap.exceptions import EndOfFile  # noqa: PLC0415  # as above
    from mcap.records import Channel, Message, Schema  # noqa: PLC0415
    from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415

    decoders = {
        "cdr": get_typestore(Stores.ROS2_JAZZY).deserialize_cdr,
        "ros1": get_typestore(Stores.ROS1_NOETIC).deserialize_ros1,
    }
    types: dict[int, str] = {}
    channels: dict[int, Channel] = {}
    with suppress(EndOfFile):
        for record in _mcap_records(file):
            match record:
                case Schema():
                    types[record.id] = record.name
                case Channel() if types.get(record.schema_id) in _TEXT and record.message_encoding in decoders:
                    channels[record.id] = record
                case Message() if record.channel_id in channels:
                    channel = channels[record.channel_id]
                    text: Any = decoders[channel.message_encoding](record.data, _TEXT[1])
                    yield RecordedText(channel.topic, text.data)


def _mcap_records(file: IO[bytes]) -> Iterator[Any]:
    from mcap.records import Chunk  # noqa: PLC0415  # as above
    from mcap.stream_reader import StreamReader, breakup_chunk  # noqa: PLC0415

    for record in StreamReader(file, emit_chunks=True, record_size_limit=MOST_BYTES).records:
        if isinstance(record, Chunk):
            yield from breakup_chunk(replace(record, compression="", data=decompress(record.data, record.compression)))
        else:
            yield record
