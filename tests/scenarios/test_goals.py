"""Each robot reaches its goal (thesis, section 6.2, for its scenarios) and sends nothing forbidden on the way."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import TYPE_CHECKING

import pytest

from examples.simulator.engine import EXAMPLES
from examples.simulator.field import Boom
from examples.simulator.scenarios import SCENARIOS
from examples.simulator.world import STEP
from tests.scenarios.rules.books import BOOKS
from tests.scenarios.runs import Entry, moved_while_stopped, played, poses, run_of, stops, times_of
from tests.searching import matrix_but, slow_but

if TYPE_CHECKING:
    from collections.abc import Sequence

#: The group shares the runs of the scenarios.
pytestmark = pytest.mark.xdist_group("scenarios")
EACH = pytest.mark.parametrize("name", slow_but(["line_follower", "push_ball", "supervised_line_follower"], SCENARIOS))
#: Scenarios with a second run.
SOME = pytest.mark.parametrize("name", matrix_but(["line_follower", "maze_solver", "simple_navigation"], SCENARIOS))


def test_there_is_a_scenario_for_each_example() -> None:
    """The simulator has one robot."""
    assert {*SCENARIOS} == {model.stem for model in EXAMPLES.glob("*/*.rscd") if model.parent.name != "fleet"}
    assert list(SCENARIOS) == list(BOOKS)


@EACH
def test_the_readme_says_how_to_run_it(name: str) -> None:
    assert f"/simulator --scenario {name}" in (EXAMPLES / name / "README.md").read_text(encoding="utf-8")


@EACH
def test_reaches_its_goal(name: str) -> None:
    simulation = run_of(name).simulation
    assert simulation.reached
    assert simulation.ended
    assert simulation.world.touched == 0, "the robot ran into something"


@EACH
def test_sends_nothing_forbidden(name: str) -> None:
    log = run_of(name).log
    assert sum(entry["direction"] == "out" for entry in log) >= 3
    assert BOOKS[name]().violations(log) == []


@EACH
def test_stands_while_stop_is_pressed(name: str) -> None:
    assert moved_while_stopped(run_of(name).record, allowance=0.3) < 0.005


@SOME
def test_errors_of_sensors_change_the_way_but_not_its_end(name: str) -> None:
    other = played(name, seed=1)
    assert other.simulation.reached
    assert other.simulation.world.touched == 0
    assert BOOKS[name]().violations(other.log) == []


@SOME
def test_a_run_is_always_the_same(name: str) -> None:
    """A third of a run is identical in each detail; the pictures cover the rest."""
    first = run_of(name)
    until = first.simulation.time / 3
    second = played(name, until=until)

    def begun(entries: Sequence[Entry]) -> list[Entry]:
        return [entry for entry in entries if entry["time"] < until - STEP]

    assert 0 < len(begun(first.log)) < len(first.log)
    assert json.dumps(begun(first.record)) == json.dumps(begun(second.record))
    assert begun(first.log) == begun(second.log)


def test_the_line_is_followed_closely_and_left_by_nobody() -> None:
    record = run_of("line_follower").record
    assert max(pose["off_line"] for pose in poses(record)) < 0.1
    assert max(pose["off_line"] for pose in poses(record, 4.0)) < 0.06
    assert poses(record)[-1]["travelled"] > 4.5


def test_the_line_follower_halts_before_the_obstacle() -> None:
    assert 0.15 < min(pose["gap"] for pose in poses(run_of("line_follower").record)) < 0.4


@pytest.mark.slow
def test_the_navigators_get_around_what_is_on_no_map() -> None:
    run = run_of("obstacle_navigation")
    # Only an obstacle placed in front of the robot comes nearer than the distance that Nav2 keeps.
    assert min(pose["gap"] for pose in poses(run.record)) > 0.02
    feedback = [entry["data"]["value"] for entry in run.log if entry["event"] == "action_navigate.u_feedback"]
    assert {value["number_of_recoveries"] if isinstance(value, dict) else value for value in feedback} == {0, 1}


@pytest.mark.slow
def test_a_click_before_the_robot_is_located_starts_nothing() -> None:
    run = run_of("simple_navigation")
    clicks, goals = times_of(run.record, "/clicked_point"), times_of(run.record, "/navigate_to_pose")
    assert clicks[0] < times_of(run.record, "/initialpose")[0] < goals[0]


@pytest.mark.slow
def test_the_object_finder_sees_other_things_before_the_sign() -> None:
    events = [entry for entry in run_of("object_finder").log if entry["event"] == "message_objects.u_response"]
    assert next(event["data"]["value"] for event in events) == "something_else"
    assert [event["data"]["value"] for event in events][-1] == "stop_sign"


@pytest.mark.slow
def test_the_maze_has_turns_to_both_sides_and_a_dead_end() -> None:
    events = [entry["event"].removesuffix(".c_trigger") for entry in run_of("maze_solver").log]
    turns = [event.rpartition("_")[2] for event in events if event in ("message_rotate_left", "message_rotate_right")]
    assert ("left", "left") in pairwise(turns)
    assert ("right", "right") in pairwise(turns)


def test_the_ball_slips_aside_and_is_caught_again() -> None:
    run = run_of("push_ball")
    assert sum(entry["event"] == "message_needs_adjustment.u_response" for entry in run.log) > 10
    ways = [pose["ball"] for pose in poses(run.record)]
    assert ways[-1][0] - ways[0][0] > 2.0


@pytest.mark.slow
def test_the_person_is_followed_at_a_distance() -> None:
    run = run_of("person_follower")
    away = [pose["person"] for pose in poses(run.record)]
    assert min(away) > 0.9
    assert max(away) < 2.6
    assert sum(abs(later - earlier) for earlier, later in pairwise(away)) > 1.0


def test_the_layer_blocks_steps_of_a_controller_that_knows_no_danger() -> None:
    run = run_of("supervised_line_follower")
    blocked = [entry["time"] for entry in run.log if entry["direction"] == "blocked"]
    ((stop, go),) = stops(run.record)
    assert sum(stop < time < go for time in blocked) > 10
    # The layer also blocks steps before the obstacle, where the robot stood for seconds.
    waiting = [pose["travelled"] for pose in poses(run.record, 8.0, 11.0)]
    assert max(waiting) - min(waiting) < 0.01
    assert sum(8.0 < time < 11.0 for time in blocked) > 20


@pytest.mark.slow
def test_the_dock_is_asked_again_after_ever_longer_pauses() -> None:
    run = run_of("warehouse_robot")
    asked = [entry["time"] for entry in run.log if entry["event"] == "action_dock.c_trigger"]
    first, second, third, _ = asked
    assert (second - first, third - second) == pytest.approx((5.0, 30.0), abs=0.2)


@pytest.mark.slow
def test_the_warehouse_robot_is_slow_where_it_comes_near_to_something() -> None:
    run = run_of("warehouse_robot")
    limits = [entry["data"]["speed_limit"] for entry in run.record if entry["topic"] == "/speed_limit"]
    assert limits[:4] == [0.3, 1.0, 0.3, 1.0]


@pytest.mark.slow
def test_the_sprayer_leaves_out_what_has_been_sprayed() -> None:
    boom = run_of("sprayer").simulation.device(Boom)
    assert len(boom.sprayed) > 60
    # Overlaps occur at the edges of squares, and where a route begins within a square.
    assert boom.twice < 0.1 * len(boom.sprayed)


@pytest.mark.slow
def test_the_sprayer_sprays_nothing_beyond_the_field() -> None:
    boom = run_of("sprayer").simulation.device(Boom)
    assert max(column for column, _ in boom.sprayed) < 100
