"""Messages in recordings of ROS: bags of ROS 1 and ROS 2, and MCAP files."""

from __future__ import annotations

from contextlib import nullcontext, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple

from robosc.base.files.reading import MOST_BYTES, open_file
from robosc.base.recordings.bounds import BoundError, decompress, limit_decompression, require_plain

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from robosc.base.recordings.decoding import Decoder
    from robosc.base.ros_types import RosTypes

#: Names of the text message in ROS 1 and ROS 2.
_TEXT = ("std_msgs/String", "std_msgs/msg/String")


class RecordingError(Exception):
    """A recording that cannot be read; the message gives the reason."""


class _Place(NamedTuple):
    """Place of a message in a bag of ROS 1."""

    time: int
    chunk_pos: int
    offset: int


class RecordedText(NamedTuple):
    """A message of `std_msgs/String`, and its topic."""

    topic: str
    text: str


def is_recording(path: str) -> bool:
    """Return whether a path names a recording: a folder that `ros2 bag` wrote, a `.bag` or an `.mcap` file."""
    return Path(path).is_dir() or Path(path).suffix in (".bag", ".mcap", ".db3")


@dataclass(frozen=True, eq=False)
class Channel:
    """Messages of one topic and type. `ros` is 1 or 2; `decode` returns the message of some bytes."""

    topic: str
    type: str
    ros: int
    decode: Decoder


class Recording:
    """A recording, read once from its start to its end.

    `topics` has the types of the topics; in an `.mcap` file, of those so far. `start` is the time of the first message
    in nanoseconds, None before it is known. `types` are the ROS types of messages that the recording does not define.
    """

    def __init__(self, path: str, types: RosTypes | None = None) -> None:
        self.path = path
        self.start: int | None = None
        self.topics: dict[str, list[str]] = {}
        self._types = types

    def messages(self, is_wanted: Callable[[str, str], bool]) -> Iterator[tuple[int, Channel, bytes]]:
        """Yield the messages in the order of their arrival, with the time of recording in nanoseconds.

        `is_wanted` gets the topic and the type of messages. A truncated MCAP file, for example after a power failure,
        is read up to its end. Raises RecordingError, and OSError.
        """
        recording = Path(self.path)
        if recording.is_dir() and not (recording / "metadata.yaml").is_file():
            raise RecordingError(f"{self.path} is a folder without a metadata.yaml: it is not a recording")
        # rosbags opens folders by itself.
        with (
            nullcontext() if recording.is_dir() else open_file(self.path) as file,
            limit_decompression(recording),
        ):
            try:
                require_plain(recording)
            except BoundError as error:
                raise RecordingError(f"{self.path} cannot be read: {error}") from None
            if file is not None and recording.suffix == ".mcap":
                yield from self._readable(self._mcap(file, is_wanted))
            else:
                yield from self._readable(self._bag(recording, is_wanted))

    def _readable(self, messages: Iterator[tuple[int, Channel, bytes]]) -> Iterator[tuple[int, Channel, bytes]]:
        try:
            yield from messages
        except Exception as error:  # Readers raise many kinds of exceptions for damaged bytes.
            raise RecordingError(f"{self.path} cannot be read: {str(error) or type(error).__name__}") from None

    def _bag(self, path: Path, is_wanted: Callable[[str, str], bool]) -> Iterator[tuple[int, Channel, bytes]]:
        from rosbags import rosbag1, rosbag2  # noqa: PLC0415  # takes long to load

        ros = 1 if path.suffix == ".bag" else 2
        reader: Any = rosbag1.Reader(path) if ros == 1 else rosbag2.Reader(path)
        with reader:
            if ros == 1:  # rosbags orders messages of one time by their connections
                reader.indexes = {
                    number: [_Place(*entry) for entry in index] for number, index in reader.indexes.items()
                }
            if reader.message_count:
                self.start = reader.start_time
            channels = {
                connection.id: self._channel(
                    connection.topic,
                    connection.msgtype,
                    connection.msgdef.data,
                    connection.msgdef.format.name.lower(),
                    "ros1" if ros == 1 else "cdr",
                )
                for connection in reader.connections
            }
            connections = [
                connection for connection in reader.connections if is_wanted(connection.topic, connection.msgtype)
            ]
            for connection, time, data in reader.messages(connections) if connections else ():
                yield time, channels[connection.id], data

    def _mcap(self, file: IO[bytes], is_wanted: Callable[[str, str], bool]) -> Iterator[tuple[int, Channel, bytes]]:
        from mcap.exceptions import EndOfFile  # noqa: PLC0415  # as above
        from mcap.records import Channel as McapChannel  # noqa: PLC0415
        from mcap.records import Message, Schema  # noqa: PLC0415

        schemas: dict[int, Schema] = {}
        channels: dict[int, Channel] = {}
        with suppress(EndOfFile):
            for record in _mcap_records(file):
                match record:
                    case Message():
                        if self.start is None:
                            self.start = record.log_time
                        if record.channel_id in channels:
                            yield record.log_time, channels[record.channel_id], record.data
                    case Schema():
                        schemas[record.id] = record
                    case McapChannel() if record.schema_id in schemas and record.message_encoding in ("cdr", "ros1"):
                        schema, form = schemas[record.schema_id], schemas[record.schema_id].encoding
                        channel = self._channel(
                            record.topic,
                            schema.name,
                            schema.data.decode(errors="replace"),
                            form.removeprefix("ros2").removeprefix("ros1"),
                            record.message_encoding,
                        )
                        if is_wanted(channel.topic, channel.type):
                            channels[record.id] = channel

    def _channel(self, topic: str, kind: str, definition: str, form: str, encoding: str) -> Channel:
        from robosc.base.recordings.decoding import Decoder  # noqa: PLC0415  # takes long to load
        from robosc.base.ros_types import RosTypes  # noqa: PLC0415  # as above

        if self._types is None:
            self._types = RosTypes()
        ros = 1 if encoding == "ros1" else 2
        self.topics.setdefault(topic, [])
        if kind not in self.topics[topic]:
            self.topics[topic].append(kind)
        return Channel(topic, kind, ros, Decoder(kind, definition, form, encoding, self._types.distribution(ros)))


def recorded_texts(path: str) -> Iterator[RecordedText]:
    """Yield the texts of a recording, in the order of their arrival. Raises RecordingError, and OSError.

    A truncated MCAP file, for example after a power failure, is read up to its end.
    """
    from robosc.base.recordings.decoding import DecodingError  # noqa: PLC0415  # takes long to load

    for _, channel, data in Recording(path).messages(lambda _, kind: kind in _TEXT):
        try:
            yield RecordedText(channel.topic, channel.decode(data).data)
        except DecodingError as error:
            raise RecordingError(f"{path} cannot be read: {error}") from None


def _mcap_records(file: IO[bytes]) -> Iterator[Any]:
    from mcap.records import Chunk  # noqa: PLC0415  # as above
    from mcap.stream_reader import StreamReader, breakup_chunk  # noqa: PLC0415

    for record in StreamReader(file, emit_chunks=True, record_size_limit=MOST_BYTES).records:
        if isinstance(record, Chunk):
            yield from breakup_chunk(replace(record, compression="", data=decompress(record.data, record.compression)))
        else:
            yield record
