"""The line follower drives: a generated package, built by the platform's own tool, on real topics.

The events in the world are those of the simulator's scenario. The speed of the machine does not matter: simulated time
waits for the controller.
"""

from __future__ import annotations

import json
from itertools import pairwise
from statistics import median
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

from robosc.base.files.resources import locate
from tests.ros.line_follower_rules import commands_in, late_moves, violations
from tests.scenarios.rules.books import BOOKS
from tests.scenarios.runs import moved_while_stopped, poses

if TYPE_CHECKING:
    from tests.ros.conftest import Drive

#: Seconds for a message to arrive and for the ticks that answer it.
TRANSPORT = 0.8
GOING = "the robot is set going"
OBSTACLE, CLEAR = "an obstacle is put on the line", "the obstacle is taken away"
STOP, CONTINUE = "stop is pressed", "continue is pressed"
COVER, UNCOVER = "the line is covered", "the line is uncovered"
END = "the goal is reached"


def test_follows_the_line(drive: Drive) -> None:
    start, until = drive.when(GOING), drive.when(OBSTACLE)
    poses = drive.poses(end=until)
    assert len(poses) > 45
    assert max(pose["off_line"] for pose in drive.poses()) < 0.1
    assert max(pose["off_line"] for pose in drive.poses(start + 4.0)) < 0.06
    assert poses[-1]["travelled"] > 0.2 * (until - start) * 0.9
    assert all(linear == 0.0 for _, linear, _ in drive.commands(end=start))
    assert all(linear == 0.2 for _, linear, _ in drive.commands(start + TRANSPORT, until))


def test_halts_for_the_obstacle_and_goes_on_when_it_is_gone(drive: Drive) -> None:
    start, end = drive.when(OBSTACLE), drive.when(CLEAR)
    waiting = drive.commands(start + 4.0, end)
    assert waiting
    assert all(command[1:] == (0.0, 0.0) for command in waiting)
    gaps = [pose["gap"] for pose in drive.poses(start + 0.1, end)]
    assert 0.15 < min(gaps) < 0.4
    assert moves(drive, end + TRANSPORT, drive.when(STOP))


def test_halts_for_the_stop_button_until_continue(drive: Drive) -> None:
    stopped = drive.commands(drive.when(STOP) + TRANSPORT, drive.when(CONTINUE))
    assert stopped
    assert all(command[1:] == (0.0, 0.0) for command in stopped)
    assert moves(drive, drive.when(CONTINUE) + TRANSPORT, drive.when(COVER))


def test_halts_without_a_line(drive: Drive) -> None:
    blind = drive.commands(drive.when(COVER) + TRANSPORT, drive.when(UNCOVER))
    assert blind
    assert all(command[1:] == (0.0, 0.0) for command in blind)
    assert moves(drive, drive.when(UNCOVER) + TRANSPORT, drive.when(END) - 2.0)


def test_moves_only_in_states_that_allow_it(drive: Drive) -> None:
    assert violations(drive.log) == []
    assert late_moves(drive.record, TRANSPORT, front=0.5) == []


def test_does_nothing_that_is_forbidden_in_its_scenario(drive: Drive) -> None:
    log = [*drive.log]
    while log[-1]["direction"] == "outside":
        # When the node shuts down, it halts the robot independently of the requirements.
        log.pop()
    assert sum(entry["direction"] == "out" for entry in log) >= 3
    assert BOOKS["line_follower"]().violations(log) == []
    assert moved_while_stopped(drive.record, 1.0) < 0.02
    assert min(pose["gap"] for pose in poses(drive.record)) >= 0


def test_what_is_received_is_what_was_decided(drive: Drive) -> None:
    received = [(linear, angular) for _, linear, angular in drive.commands()]
    decided = commands_in(drive.log)
    # The world misses commands from before its connection and from after its end.
    starts = [at for at in range(len(decided)) if decided[at : at + len(received)] == received]
    assert starts, "the commands on /cmd_vel are not those in the event log"
    assert len(received) > 0.9 * len(decided)


def test_answers_in_every_tick(drive: Drive) -> None:
    sent = {entry["event"] for entry in drive.log if entry["direction"] == "out"}
    # The node sends a report at the end of each tick.
    ticks = [report["data"] for report in drive.reports if report["topic"] == "state"]
    assert all(sent & set(tick["transitions"]) for tick in ticks[1:])
    periods = [later["time"] - earlier["time"] for earlier, later in pairwise(ticks)]
    assert median(periods) == pytest.approx(0.1, abs=0.03)


def test_reports_state_and_definition(drive: Drive) -> None:
    definitions = [report["data"] for report in drive.reports if report["topic"] == "definition"]
    states = [report["data"] for report in drive.reports if report["topic"] == "state"]
    assert len(definitions) == 1
    assert [component["name"] for component in definitions[0]["components"]] == [
        "LineDetector",
        "Lidar",
        "EmergencyStop",
    ]
    seen = {(name, component["state"]) for state in states for name, component in state["components"].items()}
    declared = {
        (component["name"], state["name"])
        for component in definitions[0]["components"]
        for state in component["states"]
    }
    assert seen == declared
    # The listener may miss the first of two messages on continue.
    assert sum(event == "message_continue.u_response" for state in states for event in state["transitions"]) in (1, 2)
    assert all(state["transitions"] for state in states[1:])
    told = [event for state in states for event in state["transitions"]]
    happened = [entry["event"] for entry in drive.log]
    first = next((at for at in range(len(happened)) if happened[at : at + len(told)] == told), None)
    assert first is not None, "from the first report on each event is told, once, in its order"
    # ROS 2 may discover the listener late.
    assert len(told) > len(happened) / 2
    # The node sends a command and a report in each tick. A few more commands are reactions, which wait for no tick.
    ticks = sum(entry["direction"] == "out" for entry in drive.log[first : first + len(told)])
    assert ticks * 0.9 < len(states) <= ticks + 2


def test_what_it_tells_fits_the_schemas(drive: Drive) -> None:
    for name in ("state", "definition"):
        told = [report["data"] for report in drive.reports if report["topic"] == name]
        assert told
        validate(told, name)
    validate(drive.log, "event-log")


def test_ends_cleanly_and_without_complaint(drive: Drive) -> None:
    assert drive.node_status == 0
    assert "WARN" not in drive.node_output
    assert "ERROR" not in drive.node_output


def validate(instances: list[Any], schema: str) -> None:
    validator = Draft202012Validator(json.loads(locate(f"schemas/{schema}.schema.json").read_text()))
    for instance in instances:
        validator.validate(instance)


def moves(drive: Drive, start: float, end: float) -> bool:
    """Whether all commands in an interval are moves with the velocity of the model."""
    commands = drive.commands(start, end)
    return bool(commands) and all(linear == 0.2 for _, linear, _ in commands)
