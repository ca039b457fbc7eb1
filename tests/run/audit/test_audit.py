"""Audits of recordings, compared with a judge that a person wrote for one robot by hand."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

import robosc
from robosc.base.files.resources import locate
from robosc.base.recordings import RecordingError
from robosc.base.ros_types import RosTypes
from robosc.language.configuration import Configuration
from robosc.run.audit import AuditOptions, RecordingJudge
from tests.run.audit.recordings import FORMATS, START, Entry, write_mcap, write_sqlite

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.model import rosgraph
    from robosc.run.audit import Audit

FOLLOWER = Path("examples/supervised_line_follower/supervised_line_follower.rscd")
EXPECTED_TOPICS = {"/correction", "/no_line", "/scan", "/emergency_stop", "/continue", "/simple_movement"}
CLEAR, BLOCKED = [1.0] * 360, [0.2] * 360
LINE = "requirement step needs LineDetector.following"
LIDAR = "requirement step needs Lidar.front = clear"
STOP = "requirement step needs EmergencyStop.in_service"


@cache
def graph_of(text_or_path: str | Path) -> rosgraph.RosGraph:
    is_text = isinstance(text_or_path, str)
    robot = robosc.load(text=text_or_path) if is_text else robosc.load(text_or_path)
    robosc.synthesize(robosc.to_sct(robot))
    return robosc.to_rosgraph(robot)


def audited(graph: rosgraph.RosGraph, path: Path, configuration: Configuration | None = None, **options: Any) -> Audit:
    chosen = configuration or Configuration()
    judge = RecordingJudge(graph, chosen, RosTypes(), str(path), AuditOptions(**options))
    return judge.run()


def step(time: float) -> Entry:
    return Entry(time, "/simple_movement", "geometry_msgs/msg/Twist", {"linear": {"x": 0.1}})


def correction(time: float) -> Entry:
    return Entry(time, "/correction", "std_msgs/msg/Float32", {"data": 0.5})


def no_line(time: float) -> Entry:
    return Entry(time, "/no_line", "std_msgs/msg/Empty")


def scan(time: float, ranges: Sequence[float] = CLEAR) -> Entry:
    return Entry(time, "/scan", "sensor_msgs/msg/LaserScan", {"ranges": ranges})


def button(time: float, *, pressed: bool) -> Entry:
    return Entry(time, "/emergency_stop", "std_msgs/msg/Bool", {"data": pressed})


def resume(time: float) -> Entry:
    return Entry(time, "/continue", "std_msgs/msg/Empty")


class Hand:
    """The line follower's layer, by hand: which requirements forbid a step at a time in seconds."""

    PATIENCE = 0.5

    def __init__(self) -> None:
        self.corrected = self.scanned = self.pressed_heard = -100.0
        self.following = self.clear = self.released = self.in_service = False

    def hear(self, entry: Entry) -> None:
        self._silences(entry.time)
        match entry.topic:
            case "/correction":
                self.following, self.corrected = True, entry.time
            case "/no_line":
                self.following = False
            case "/scan":
                ranges = entry.fields["ranges"]
                self.scanned = entry.time
                self.clear = len(ranges) > 350 and all(ranges[ray] >= 0.5 for ray in (0, 10, 350, 20, 340))
            case "/emergency_stop":
                self.pressed_heard, self.released = entry.time, not entry.fields["data"]
                self.in_service = self.in_service and self.released
            case "/continue":
                self.in_service = self.in_service or self.released

    def _silences(self, now: float) -> None:
        if now - self.corrected > self.PATIENCE:
            self.following = False
        if now - self.scanned > self.PATIENCE:
            self.clear = False
        if now - self.pressed_heard > self.PATIENCE:
            self.released = self.in_service = False

    def forbidding(self, now: float) -> list[str]:
        self._silences(now)
        known = ((self.following, LINE), (self.clear, LIDAR), (self.in_service, STOP))
        return [text for holds, text in known if not holds]


def by_hand(entries: Sequence[Entry]) -> list[tuple[float, list[str]]]:
    """Return the forbidden steps, with their times."""
    judge, found = Hand(), []
    for entry in entries:
        if entry.topic != "/simple_movement":
            judge.hear(entry)
        elif because := judge.forbidding(entry.time):
            found.append((entry.time, because))
    return sorted(found)


def found(audit: Audit) -> list[tuple[float, list[str]]]:
    """Return the forbidden commands of an audit in the same form."""
    assert {str(finding.kind) for finding in audit.findings} <= {"forbidden"}
    assert {finding.reason for finding in audit.findings} <= {"requirement"}
    return sorted(
        (round(time / 1e9 - START, 6), list(finding.because)) for finding in audit.findings for time in finding.times
    )


DRIVE = [
    step(0.0),
    button(0.1, pressed=False),
    resume(0.12),
    scan(0.14),
    correction(0.2),
    step(0.22),
    step(0.24),
    scan(0.3, BLOCKED),
    step(0.32),
    step(0.34),
    scan(0.4),
    step(0.42),
    no_line(0.44),
    step(0.46),
    correction(0.5),
    step(0.52),
    button(0.54, pressed=True),
    step(0.56),
    button(0.6, pressed=False),
    step(0.62),
    resume(0.64),
    step(0.66),
    button(0.9, pressed=False),
    correction(0.92),
    step(1.0),  # the lidar has been silent for 0.6 s
    scan(1.02, CLEAR[:100]),
    step(1.04),  # the scan lacks rays
]


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_gives_the_findings_of_the_judge_by_hand(name: str, tmp_path: Path) -> None:
    audit = audited(graph_of(FOLLOWER), FORMATS[name](tmp_path / "drive", DRIVE))
    assert found(audit) == by_hand(DRIVE)
    assert audit.commands == sum(entry.topic == "/simple_movement" for entry in DRIVE)
    assert audit.unseen == {}
    schema = json.loads(locate("schemas/audit.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator(schema).validate(audit.as_json())


def random_drive(random: Random, length: int = 120) -> list[Entry]:
    """Return messages at random; no two of one topic are 0.5 s apart, so that the millisecond does not matter."""
    kinds = [
        step,
        correction,
        no_line,
        lambda time: scan(time, random.choice([CLEAR, CLEAR, BLOCKED, CLEAR[:50], [float("nan")] * 360])),
        lambda time: button(time, pressed=random.random() < 0.3),
        resume,
    ]
    entries, slot = [], 0
    for _ in range(length):
        slot += random.choice([0, 1, 1, 1, 2, 10])
        entries.append(random.choices(kinds, [6, 3, 1, 3, 3, 2])[0](round(slot * 0.04, 3)))
    return entries


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10**9))
def test_random_recordings_are_judged_as_by_hand(seed: int, tmp_path_factory: pytest.TempPathFactory) -> None:
    entries = random_drive(Random(seed))
    path = write_mcap(tmp_path_factory.mktemp("drive") / "drive", entries)
    assert found(audited(graph_of(FOLLOWER), path)) == by_hand(entries)


def test_a_damaged_recording_is_judged_up_to_the_damage(tmp_path: Path) -> None:
    path = write_sqlite(tmp_path / "drive", DRIVE)
    database = next(path.glob("*.db3"))
    content = database.read_bytes()
    database.write_bytes(content[: len(content) // 2])
    with pytest.raises(RecordingError, match="drive"):
        audited(graph_of(FOLLOWER), path)
    random = Random(3)
    mcap = write_mcap(tmp_path / "drive", DRIVE)
    whole = mcap.read_bytes()
    for _ in range(25):
        damaged = bytearray(whole)
        for _ in range(random.randint(1, 20)):
            damaged[random.randrange(len(damaged))] = random.randrange(256)
        mcap.write_bytes(damaged)
        try:
            audited(graph_of(FOLLOWER), mcap)
        except RecordingError as error:
            assert str(mcap) in str(error)  # noqa: PT017
