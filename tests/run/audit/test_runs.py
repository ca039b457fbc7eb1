"""Runs of the supervisor itself, recorded: an audit has no findings, and exactly those that were planted."""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import pytest

from tests.run.audit.recordings import START, Entry, store, write_bag, write_mcap
from tests.run.audit.test_audit import audited, graph_of
from tests.run.runtime.fake import FakePort, World

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

EXAMPLES = Path("examples")
#: Messages of the robots: topic, type, and random fields.
_Message = tuple[str, str, "Callable[[Random], Mapping[str, Any]]"]
LINE: list[_Message] = [
    ("/correction", "std_msgs/msg/Float32", lambda random: {"data": random.choice([-4.0, 0.5, 2.25])}),
    ("/no_line", "std_msgs/msg/Empty", lambda _: {}),
    ("/scan", "sensor_msgs/msg/LaserScan", lambda random: {"ranges": _ranges(random)}),
    ("/emergency_stop", "std_msgs/msg/Bool", lambda random: {"data": random.random() < 0.15}),
    ("/continue", "std_msgs/msg/Empty", lambda _: {}),
]
MAZE: list[_Message] = [*LINE[2:], ("/rotate_done", "std_msgs/msg/Empty", lambda _: {})]
GUARD: list[_Message] = [
    ("/scan", "std_msgs/msg/Empty", lambda _: {}),
    ("/pressed", "std_msgs/msg/Empty", lambda _: {}),
]
ROBOTS = {
    "examples/line_follower/line_follower.rscd": LINE,
    "examples/maze_solver/maze_solver.rscd": MAZE,
    "tests/run/runtime/guard.rscd": GUARD,
}
#: Types of the commands' topics.
COMMANDS = {
    "/cmd_vel": "geometry_msgs/msg/Twist",
    "/simple_movement": "geometry_msgs/msg/Twist",
    "/rotate_left": "std_msgs/msg/Int16",
    "/rotate_right": "std_msgs/msg/Int16",
    "/move": "std_msgs/msg/Empty",
    "/halt": "std_msgs/msg/Empty",
}


def _ranges(random: Random) -> list[float]:
    return [random.choices([0.3, 0.7, 2.0], [1, 1, 6])[0]] * random.choice([360, 360, 360, 200])


class _Sent(list[tuple[str, dict[str, Any]]]):
    """Messages that a port sends, which become entries of a recording."""

    def __init__(self, port: FakePort, entries: list[Entry]) -> None:
        super().__init__()
        self._port = port
        self._entries = entries

    def append(self, sent: tuple[str, dict[str, Any]]) -> None:
        topic, fields = sent
        self._entries.append(Entry(self._port.time - START, topic, COMMANDS[topic], fields))


def recorded_run(model: Path, messages: list[_Message], seed: int, tmp_path: Path, steps: int) -> list[Entry]:
    """Run the controller of a model with random messages, and return the messages of both."""
    random, world = Random(seed), World(model, tmp_path / "events.jsonl")
    world.port.time = float(START)
    entries: list[Entry] = []
    world.port.sent = _Sent(world.port, entries)
    world.start()
    for _ in range(steps):
        topic, kind, fields = random.choice(messages)
        chosen = fields(random)
        entries.append(Entry(world.port.time - START, topic, kind, chosen))
        world.hear(topic.removeprefix("/"), **chosen)
        world.wait(random.choice([0.003, 0.02, 0.05, 0.3, 0.9]))
    return entries


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("model", ROBOTS)
def test_a_run_of_the_controller_has_no_findings(model: str, seed: int, tmp_path: Path) -> None:
    entries = recorded_run(Path(model), ROBOTS[model], seed, tmp_path, 150)
    write, types = (write_mcap, store(2)) if seed else (write_bag, store(1))
    audit = audited(graph_of(Path(model)), write(tmp_path / "run", entries, types))
    assert audit.commands == sum(entry.topic in COMMANDS for entry in entries) > 5
    assert [(finding.name, finding.because, finding.times) for finding in audit.findings] == []
