"""The two showcases do their work in the control loop, and never do anything that their pages forbid."""

import json
import re
from itertools import accumulate, pairwise

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main

from .conftest import MODELS

pytestmark = pytest.mark.slow

DONE = ' {"value": {"success": true}}'
REFUSED = ' {"value": {"success": false}}'
FREE = ' {"value": {"ranges": [2.0, 1.5]}}'


def heard(name: str, value: object = None) -> str:
    return f"message_{name}.u_response" + ("" if value is None else " " + json.dumps({"value": value}))


PRESSED, RELEASED, GO_ON = heard("pressed", True), heard("pressed", False), heard("continue")
#: Seconds without a message before a topic counts as silent.
PATIENCE = 0.4


def play(name: str, *lines: str, button: bool = True) -> list[list[str]]:
    """Return the commands of the controller after each line of a script and the tick after it, without repetitions.

    The robot is in service from the start. During a line that waits, `button` repeats the state of the button.
    """
    level, steps = RELEASED, [[RELEASED], [GO_ON]]
    for line in lines:
        level = line if line in (PRESSED, RELEASED) else level
        seconds = float(line.removeprefix("wait ")) if line.startswith("wait ") and button else 0.0
        pauses = [PATIENCE] * int(seconds / PATIENCE) + [seconds % PATIENCE]
        steps.append([step for pause in pauses for step in (level, f"wait {pause:.3f}")] if seconds else [line])
    script = "\n".join(line for step in steps for line in [*step, "tick"])
    done = CliRunner().invoke(main, ["simulate", str(MODELS[name]), "--loop", "--script", "-"], script)
    assert done.exit_code == 0, done.stderr
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert all(answer["by"] is None for answer in answers)
    ends = [0, *accumulate(len(step) + 1 for step in steps)]
    assert len(answers) == ends[-1]
    happened = [
        " ".join(event for answer in answers[start:end] for event in answer["happened"])
        for start, end in pairwise(ends)
    ][2:]
    sent = [re.findall(r"(?:message|service|action)_(\w+)\.c_(trigger|cancel)", text) for text in happened]
    return [[*dict.fromkeys(name if way == "trigger" else f"cancel {name}" for name, way in names)] for names in sent]


def scans() -> list[str]:
    return [f"message_{name}_scan.u_response{FREE}" for name in ("Ahead", "Behind")]


def shelved() -> list[str]:
    """Return the lines that prepare the robot in the aisle for its way to a shelf, except for the lidar scans."""
    return [
        *(heard(f"{name}_touched", False) for name in ("Front", "Rear", "Left", "Right")),
        heard("charge", {"percentage": 0.8}),
        heard("order"),
        f"action_undock.u_response{DONE}",
        f"service_enter.u_response{DONE}",
    ]


def work(sent: list[list[str]]) -> list[list[str]]:
    return [[name for name in names if name != "speed_limit"] for names in sent]


def test_the_warehouse_robot_serves_an_order() -> None:
    lines = [*shelved(), *scans(), "action_navigate.u_response"]
    served = [f"service_leave.u_response{DONE}", f"service_raise.u_response{DONE}", heard("served")]
    back = [f"service_lower.u_response{DONE}", f"service_enter.u_response{DONE}", "action_navigate.u_response"]
    home = [f"service_leave.u_response{DONE}", f"action_dock.u_response{DONE}"]
    sent = work(play("warehouse_robot", *lines, *served, *back, *home))
    assert sent[:10] == [[], [], [], [], [], ["undock"], ["enter"], [], [], ["navigate"]]
    assert sent[10:14] == [["leave"], ["raise"], [], ["lower"]]
    assert sent[14:16] == [["enter"], ["navigate"]]
    assert sorted(sent[16]) == ["dock", "leave"]
    assert sent[17:] == [[], []]


@pytest.mark.slow
def test_the_warehouse_robot_stops_for_what_it_touches_or_no_longer_sees() -> None:
    under_way = [*shelved(), *scans()]
    for trouble in (heard("Left_touched", True), PRESSED, "wait 0.6"):
        assert work(play("warehouse_robot", *under_way, trouble))[-1] == ["cancel navigate"]


@pytest.mark.slow
def test_the_warehouse_robot_turns_back_where_its_power_is_low() -> None:
    low = heard("charge", {"percentage": 0.1})
    lines = [*shelved(), *scans(), low, "action_navigate.u_canceled", "action_navigate.u_response"]
    sent = work(play("warehouse_robot", *lines))
    assert sent[-3:] == [["cancel navigate"], ["navigate"], ["leave", "dock"]]


def test_the_warehouse_robot_leaves_the_aisle_when_its_goal_has_ended() -> None:
    """A goal that succeeds before its cancel arrives has arrived: the robot then leaves the aisle."""
    lines = [*shelved(), *scans(), heard("Left_touched", True), "tick", "action_navigate.u_response"]
    assert work(play("warehouse_robot", *lines))[-3:] == [["cancel navigate"], [], ["leave"]]


def test_the_warehouse_robot_asks_again_where_nobody_answers() -> None:
    lines = [
        *shelved(),
        *scans(),
        "action_navigate.u_response",
        "service_leave.u_error",
        f"service_leave.u_response{DONE}",
    ]
    assert work(play("warehouse_robot", *lines))[-3:] == [["leave"], ["leave"], ["raise"]]


def test_the_warehouse_robot_stops_at_its_dock_and_begins_again() -> None:
    leaving, moves_on = shelved()[:6], [RELEASED, GO_ON]
    sent = work(play("warehouse_robot", *leaving, PRESSED, "action_undock.u_canceled", *moves_on))
    assert sent[-5:] == [["undock"], ["cancel undock"], [], [], ["undock"]]
    under_way = [*shelved(), *scans(), "action_navigate.u_response", f"service_leave.u_response{DONE}"]
    home = [f"service_raise.u_response{REFUSED}", f"service_lower.u_response{DONE}", f"service_enter.u_response{DONE}"]
    back = [*under_way, *home, *scans(), "action_navigate.u_response", f"service_leave.u_response{DONE}"]
    sent = work(play("warehouse_robot", *back, PRESSED, "action_dock.u_canceled", *moves_on))
    assert sent[-4:] == [["cancel dock"], [], [], ["dock"]]


def test_the_warehouse_robot_asks_for_its_dock_three_times() -> None:
    under_way = [*shelved(), *scans(), "action_navigate.u_response", f"service_leave.u_response{DONE}"]
    home = [f"service_raise.u_response{REFUSED}", f"service_lower.u_response{DONE}", f"service_enter.u_response{DONE}"]
    refused = f"action_dock.u_response{REFUSED}"
    docking = [
        refused,
        "wait 4.9",
        "wait 0.1",
        refused,
        "wait 29.9",
        "wait 0.1",
        refused,
        "wait 60",
        heard("try_again"),
    ]
    lines = [*under_way, *home, *scans(), "action_navigate.u_response", *docking]
    sent = ["dock" in names for names in play("warehouse_robot", *lines)]
    assert sent[-len(docking) :] == [False, False, True, False, False, True, False, False, True]


def route(length: int) -> str:
    return heard("route", {"poses": [{"pose": {"position": {"x": float(x)}}} for x in range(length)]})


def at(x: float, y: float = 0.0) -> str:
    return heard("odometry", {"pose": {"pose": {"position": {"x": x, "y": y}}}})


AUTOMATIC = [heard("automatic", True), heard("heartbeat"), at(0.0)]


def wheels(sent: list[list[str]]) -> list[list[str]]:
    return [[name for name in names if not name.endswith(("_open", "_shut"))] for names in sent]


def test_the_sprayer_drives_a_route_to_its_end() -> None:
    arrived = "action_drive.u_response"
    sent = wheels(play("sprayer", *AUTOMATIC, route(3), arrived, arrived, arrived, route(0)))
    assert ["drive" in names for names in sent] == [False, False, False, True, True, True, False, False]
    assert "halt" in sent[0]
    assert "halt" in sent[-1]


@pytest.mark.slow
def test_the_sprayer_gives_up_its_way_where_it_may_not_go_on() -> None:
    for trouble in (PRESSED, at(100.5), at(0.0, -40.5), heard("automatic", False), "wait 1"):
        sent = wheels(play("sprayer", *AUTOMATIC, route(3), trouble, "tick", "action_drive.u_canceled"))
        assert sent[-3:] == [["cancel drive"], [], ["halt"]]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("before", "release", "sent_then"),
    [
        pytest.param([*AUTOMATIC, route(3)], heard("automatic", False), ["cancel drive"], id="mode"),
        pytest.param([heard("heartbeat"), PRESSED, RELEASED], GO_ON, ["halt"], id="stop"),
    ],
)
def test_a_stick_that_was_held_before_it_counted_has_to_be_let_go(
    before: list[str], release: str, sent_then: list[str]
) -> None:
    end = ["action_drive.u_canceled"] if sent_then == ["cancel drive"] else []
    lines = [*before, heard("wish"), release, heard("wish"), *end, "wait 0.4", heard("heartbeat"), heard("wish")]
    sent = wheels(play("sprayer", *lines))
    assert sent[len(before) + 1] == sent_then
    assert not any("obey" in names for names in sent[:-1])
    assert sent[-1] == ["obey"]


@pytest.mark.slow
def test_a_section_sprays_where_it_is_due_in_the_field() -> None:
    ready = [*AUTOMATIC, heard("level", 0.8), heard("Left_sprayed", False), route(1)]
    sent = play("sprayer", *ready)
    assert [name for name in sent[-1] if name.endswith("_open")] == ["Left_open"]
    for end in (heard("Left_sprayed", True), heard("level", 0.01), at(101.0), PRESSED):
        last = play("sprayer", *ready, end)[-1]
        assert "Left_open" not in last
        assert "Left_shut" in last


CLEAR = {"ranges": [2.0] * 360}
LINE = heard("correction", 0.0)
PERSON = heard("who", {"bounding_boxes": [{"class_id": "person"}]})
BALL = heard("ball_correction", 0.0)
#: Messages that set each robot with its own wheel control in motion.
MOVING = {
    "line_follower": [LINE, heard("scan", CLEAR)],
    "maze_solver": [heard("scan_front", CLEAR)],
    "object_finder": [heard("scan_front", CLEAR)],
    "person_follower": [PERSON, heard("scan", CLEAR)],
    "push_ball": [BALL, heard("scan", CLEAR)],
    "supervised_line_follower": [LINE, heard("scan", CLEAR)],
}
SENSORS = [(name, sensor) for name, sensors in MOVING.items() for sensor in sensors]


@pytest.mark.parametrize(
    ("name", "sensor"), SENSORS, ids=[f"{name} {sensor.split('.')[0]}" for name, sensor in SENSORS]
)
def test_a_robot_with_a_sensor_that_falls_silent_stops(name: str, sensor: str) -> None:
    """The robot stops even if all other sensors continue, and moves on when the sensor is back."""
    others = [line for line in MOVING[name] if line != sensor]
    sent = play(name, *others, sensor, "wait 0.4", *others, sensor, "wait 0.4", *others, "wait 0.2", sensor)
    moves, stops = [["step"], []] if name == "supervised_line_follower" else [["move"], ["halt"]]
    assert sent[len(others) : -2] == [moves] * (4 + 2 * len(others))
    assert sent[-2:] == [stops, moves]


#: Lines that set the other robots in motion.
UNDER_WAY = {
    "obstacle_navigation": [heard("initial_pose"), heard("clicked_point")],
    "simple_navigation": [heard("initial_pose"), heard("clicked_point")],
    "sprayer": [*AUTOMATIC, route(1)],
    "warehouse_robot": [*shelved(), *scans()],
}


@pytest.mark.parametrize("name", [*MOVING, *UNDER_WAY])
def test_a_robot_with_a_button_that_falls_silent_stops_until_it_is_set_going(name: str) -> None:
    sensors = MOVING.get(name, [])
    lines = [*UNDER_WAY.get(name, sensors), "wait 0.4", *sensors, *([*scans()] if name == "warehouse_robot" else [])]
    sent = play(name, *lines, "wait 0.2", *sensors, RELEASED, *sensors, GO_ON, *sensors, button=False)
    stopped = sent[len(lines)]
    moves = {"supervised_line_follower": "step"}.get(name, "move")
    if name in MOVING:
        assert sent[len(lines) - 1] == [moves]
        assert all(moves not in names for names in sent[len(lines) : -1 - len(sensors)])
        assert sent[-1] == [moves]
    else:
        assert [names for names in stopped if names.startswith("cancel")] == [
            "cancel drive" if name == "sprayer" else "cancel navigate"
        ]
