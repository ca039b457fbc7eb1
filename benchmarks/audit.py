"""Time of `robosc audit` on a recording of an hour with 100 messages a second, all of them of the model's topics.

    python benchmarks/audit.py [--hours N] [--format mcap|sqlite|bag] [--forbidden]

It writes the recording of a line follower behind a layer, and runs the command in a process of its own. The scans have
360 rays. With --forbidden, the line is never in view, so that all 144,000 commands of an hour are findings.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_typestore

MODEL = Path(__file__).parents[1] / "examples" / "supervised_line_follower" / "supervised_line_follower.rscd"
#: Topics, their types, and the messages of each in 10 slots of 10 ms.
TOPICS = {
    "/scan": ("sensor_msgs/msg/LaserScan", 1),
    "/correction": ("std_msgs/msg/Float32", 3),
    "/emergency_stop": ("std_msgs/msg/Bool", 2),
    "/simple_movement": ("geometry_msgs/msg/Twist", 4),
}
SECOND = 10**9
START = 1_700_000_000 * SECOND


def main() -> None:
    """Write the recording, audit it, and print the times."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, default=1.0)
    parser.add_argument("--format", choices=["mcap", "sqlite", "bag"], default="mcap")
    parser.add_argument("--forbidden", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / {"mcap": "hour.mcap", "sqlite": "hour", "bag": "hour.bag"}[arguments.format]
        count = write(path, arguments.format, round(arguments.hours * 3600), forbidden=arguments.forbidden)
        began = time.monotonic()
        done = subprocess.run(
            [sys.executable, "-m", "robosc", "audit", MODEL, path, "--json"], check=False, stdout=subprocess.PIPE
        )
        wall = time.monotonic() - began
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = used.ru_utime + used.ru_stime
    print(f"{count:,} messages in {path.suffix or 'a folder'}: {wall:.1f} s, processor {processor:.1f} s,")
    print(f"{used.ru_maxrss >> 10} MB, {len(done.stdout):,} bytes of JSON, exit status {done.returncode}")


def write(path: Path, form: str, seconds: int, *, forbidden: bool) -> int:
    """Write a recording of some seconds, and return the number of its messages."""
    types = get_typestore(Stores.ROS1_NOETIC if form == "bag" else Stores.ROS2_JAZZY)
    serialize = types.serialize_ros1 if form == "bag" else types.serialize_cdr
    data = {topic: bytes(serialize(sample(types, topic), kind)) for topic, (kind, _) in TOPICS.items()}
    slots = [topic for topic, (_, share) in TOPICS.items() for _ in range(share)]
    topics = [topic for topic in slots if not (forbidden and topic == "/correction")]
    empty = bytes(serialize(types.types["std_msgs/msg/Empty"](*([] if form == "bag" else [0])), "std_msgs/msg/Empty"))
    entries = [("/continue", START + SECOND // 2, empty)]
    count = seconds * 100
    entries += [
        (topics[number % len(topics)], START + number * SECOND // 100, data[topics[number % len(topics)]])
        for number in range(count)
    ]
    entries.sort(key=lambda entry: entry[1])
    kinds = {topic: kind for topic, (kind, _) in TOPICS.items()} | {"/continue": "std_msgs/msg/Empty"}
    if form == "mcap":
        write_mcap(path, types, kinds, entries)
        return len(entries)
    writer: Any = (
        Ros1Writer(path) if form == "bag" else Ros2Writer(path, version=9, storage_plugin=StoragePlugin.SQLITE3)
    )
    with writer:
        connections = {topic: writer.add_connection(topic, kind, typestore=types) for topic, kind in kinds.items()}
        for topic, moment, content in entries:
            writer.write(connections[topic], moment, content)
    return len(entries)


def write_mcap(path: Path, types: Any, kinds: dict[str, str], entries: list[tuple[str, int, bytes]]) -> None:
    """Write an MCAP file as `ros2 bag` does: compressed in chunks, with definitions."""
    with path.open("wb") as file:
        writer = McapWriter(file, compression=CompressionType.ZSTD)
        writer.start()
        channels = {}
        for topic, kind in kinds.items():
            schema = writer.register_schema(kind, "ros2msg", types.generate_msgdef(kind, ros_version=2)[0].encode())
            channels[topic] = writer.register_channel(topic, "cdr", schema)
        for topic, moment, content in entries:
            writer.add_message(channels[topic], moment, content, moment)
        writer.finish()


def sample(types: Any, topic: str) -> Any:
    """Return a message of a topic: the way is clear, and nothing is pressed."""
    kinds = types.types
    if topic == "/scan":
        time_type, header_type = kinds["builtin_interfaces/msg/Time"], kinds["std_msgs/msg/Header"]
        stamp = time_type(sec=0, nanosec=0)
        header = (
            header_type(seq=0, stamp=stamp, frame_id="")
            if "seq" in header_type.__annotations__
            else header_type(stamp=stamp, frame_id="")
        )
        rays = np.full(360, 2.0, dtype=np.float32)
        return kinds["sensor_msgs/msg/LaserScan"](header, 0.0, 6.28, 0.0175, 0.0, 0.1, 0.1, 10.0, rays, rays)
    if topic == "/simple_movement":
        vector = kinds["geometry_msgs/msg/Vector3"]
        return kinds["geometry_msgs/msg/Twist"](linear=vector(0.1, 0.0, 0.0), angular=vector(0.0, 0.0, 0.0))
    if topic == "/correction":
        return kinds["std_msgs/msg/Float32"](data=0.5)
    return kinds["std_msgs/msg/Bool"](data=False)


if __name__ == "__main__":
    main()
