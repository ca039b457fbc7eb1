"""The rule books object to controllers from models with a missing requirement."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from examples.simulator.engine import EXAMPLES, load
from examples.simulator.scenarios import SCENARIOS
from tests.scenarios.rules.books import BOOKS
from tests.scenarios.rules.driving import Stepper
from tests.scenarios.rules.judging import velocity
from tests.scenarios.runs import violations_of

if TYPE_CHECKING:
    from pathlib import Path

#: Scenario, a part of its model that the rule book needs, and the replacement of that part.
DEMANDS = [
    ("line_follower", " and EmergencyStop.in_service", ""),
    ("line_follower", " and Lidar.free", ""),
    ("simple_navigation", "requirement navigate needs EmergencyStop.in_service", ""),
    ("simple_navigation", "requirement Navigation.recalled disables navigate", ""),
    ("obstacle_navigation", "requirement navigate needs EmergencyStop.in_service", ""),
    ("obstacle_navigation", "Navigation.recoveries > 5", "Navigation.recoveries > 0"),
    ("object_finder", "requirement move needs Lidar.front = front_clear", ""),
    ("object_finder", " and !ObjectDetector.found", ""),
    ("maze_solver", "requirement EmergencyStop.stopped disables { move, rotate_left, rotate_right }", ""),
    ("maze_solver", "Lidar.front = wall_ahead and on_its_way", "on_its_way"),
    ("push_ball", "    EmergencyStop.in_service\n    and Lidar", "    Lidar"),
    ("push_ball", "BallDetector.offset) / 200", "BallDetector.offset) / 250"),
    ("person_follower", " and PersonDetector.detected", ""),
    ("supervised_line_follower", "requirement step needs Lidar.front = clear", ""),
    ("supervised_line_follower", "requirement step needs EmergencyStop.in_service", ""),
    ("warehouse_robot", "EmergencyStop.in_service and (all Bumper: Bumper.clear)", "(all Bumper: Bumper.clear)"),
    ("warehouse_robot", "(all Bumper: Bumper.clear) and ", ""),
    ("warehouse_robot", " and (all View: !View.obstructed)", ""),
    ("warehouse_robot", "      after 500 ms without scan goto obstructed\n", ""),
    ("warehouse_robot", "Aisle.inside and Dock.away", "Dock.away"),
    ("warehouse_robot", " (Mission.outbound and Battery.charged)", " Mission.outbound"),
    (
        "warehouse_robot",
        'requirement R4 "no shelf among people": never (Aisle.inside or Aisle.leaving) and Lift.up',
        "",
    ),
    ("warehouse_robot", "    Mission.outbound and (Battery.charged or Dock.undocking)\n", "    Mission.outbound\n"),
    ("warehouse_robot", "second_pause: integer = 30", "second_pause: integer = 5"),
    ("warehouse_robot", "under_way and Dock.away", "under_way"),
    ("warehouse_robot", "    undock,\n    dock,\n    raise,\n", "    undock,\n    dock,\n"),
    ("warehouse_robot", "{ speed_limit: fast } if all View: View.free", "{ speed_limit: fast }"),
    ("sprayer", "EmergencyStop.in_service and Radio.in_reach and Fence.inside", "Radio.in_reach and Fence.inside"),
    (
        "sprayer",
        "EmergencyStop.in_service and Radio.in_reach and Fence.inside",
        "EmergencyStop.in_service and Fence.inside",
    ),
    ("sprayer", " and Fence.inside\n", "\n"),
    ("sprayer", "      after 500 ms without odometry goto outside\n", ""),
    ("sprayer", "safe and Mode.by_itself", "safe"),
    ("sprayer", "after 300 ms without wish goto idle", "after 3 s without wish goto idle"),
    ("sprayer", "        transition if !may_steer goto pushed\n", ""),
    ("sprayer", "due and may_spray", "may_spray"),
    ("sprayer", "safe and Tank.filled", "safe"),
    ("sprayer", "after 5 s goto chosen", "after 500 ms goto chosen"),
]


#: A run of all tests omits the first part of each robot; `benchmarks/matrix.py` omits the others.
FIRST = {name: demand for name, demand, _ in reversed(DEMANDS)}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "demand", "instead"),
    [
        pytest.param(name, demand, instead, marks=[] if FIRST[name] == demand else [pytest.mark.matrix])
        for name, demand, instead in DEMANDS
    ],
)
def test_a_demand_less_is_noticed(name: str, demand: str, instead: str, tmp_path: Path) -> None:
    text = (EXAMPLES / name / f"{name}.rscd").read_text()
    assert text.count(demand) == 1
    model = tmp_path / f"{name}.rscd"
    model.write_text(text.replace(demand, instead))
    assert violations_of(name, load(model)) != []


def test_every_second_opinion_is_tried() -> None:
    assert {name for name, *_ in DEMANDS} == {*SCENARIOS}


def step(direction: str, data: Any = None) -> dict[str, Any]:
    known = {} if data is None else {"data": {"value": data}}
    return {"time": 1.0, "direction": direction, "event": "message_step.c_trigger", **known}


def heard(name: str, value: Any = None) -> dict[str, Any]:
    return {"time": 1.0, "direction": "in", "event": f"message_{name}.u_response", "data": {"value": value}}


GOING = [heard("pressed", False), heard("continue")]
READY = [*GOING, heard("correction"), heard("scan", "clear")]
FORWARDED = [*READY, step("out")]
STOPPED = [*FORWARDED, step("blocked"), step("outside")]


@pytest.mark.parametrize(
    "log",
    [
        STOPPED,
        [*STOPPED, step("blocked")],
        [*STOPPED, *FORWARDED, step("blocked"), step("outside", velocity(0.0, 0.0))],
    ],
)
def test_a_stop_takes_the_place_of_the_first_step_that_is_blocked(log: list[dict[str, Any]]) -> None:
    assert Stepper().violations(log) == []


@pytest.mark.parametrize(
    ("log", "fault"),
    [
        ([*FORWARDED, step("outside")], "step outside of the supervisor"),
        ([*FORWARDED, step("blocked"), heard("scan", "clear"), step("outside")], "no stop takes the place of step"),
        ([*FORWARDED, step("blocked"), step("blocked")], "no stop takes the place of step"),
        ([*STOPPED, step("outside")], "step outside of the supervisor"),
        ([*STOPPED, step("blocked"), step("outside")], "step outside of the supervisor"),
        ([step("blocked"), step("outside")], "step outside of the supervisor"),
        ([*FORWARDED, step("blocked"), step("outside", velocity(0.2, 0.0))], "that is no stop"),
    ],
)
def test_any_other_step_that_a_layer_sends_itself_is_noticed(log: list[dict[str, Any]], fault: str) -> None:
    assert any(violation.endswith(fault) for violation in Stepper().violations(log))


def missed(component: str, time: float) -> dict[str, Any]:
    return {"time": time, "direction": "internal", "event": f"component_{component}.u_after1"}


@pytest.mark.parametrize("component", ["LineDetector", "Lidar", "EmergencyStop"])
def test_nothing_goes_out_after_a_silence(component: str) -> None:
    for time, faults in ((1.4, 2), (1.5, 1)):
        found = Stepper().violations([*READY, missed(component, time), step("out") | {"time": time}])
        assert len(found) == faults
        assert ("is not silent" in found[0]) == (faults == 2)


@pytest.mark.parametrize("name", ["correction", "scan", "pressed"])
def test_a_silence_that_nobody_misses_is_noticed(name: str) -> None:
    later = [entry | {"time": 1.9} for entry in READY if entry["event"] != f"message_{name}.u_response"]
    [found] = Stepper().violations([*READY, *later, step("out") | {"time": 1.9}])
    assert f"{name} is silent" in found


@pytest.mark.parametrize(
    ("log", "going"),
    [
        (GOING, True),
        ([heard("continue"), heard("pressed", False)], False),
        ([heard("pressed", True), heard("continue")], False),
        ([*GOING, heard("pressed", True), heard("pressed", False)], False),
        ([*GOING, heard("pressed", True), *GOING], True),
        ([*GOING, missed("EmergencyStop", 1.5), heard("continue")], False),
    ],
)
def test_second_opinions_know_when_a_robot_goes_on(log: list[dict[str, Any]], going: bool) -> None:
    book = Stepper()
    assert book.violations(log) == []
    assert book.stopped is not going


@pytest.mark.parametrize("name", SCENARIOS)
def test_second_opinions_know_what_a_layer_replaces(name: str) -> None:
    configuration = json.loads((EXAMPLES / name / "controller-config.json").read_text())
    assert {*configuration.get("onBlocked", [])} == BOOKS[name].replaced
