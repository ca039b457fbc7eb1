"""The small Nav2 accepts goals, reaches them, and ends them correctly."""

from __future__ import annotations

from typing import Any

import pytest

from examples.simulator.geometry import Disc, Pose, Segment, box
from examples.simulator.navigation import Navigation
from examples.simulator.planning import Grid
from examples.simulator.world import STEP, World

pytestmark = pytest.mark.slow

ROOM = box(0.0, 0.0, 3.0, 2.0)


def goal(x: float, y: float, frame: str = "map") -> dict[str, Any]:
    return {"pose": {"header": {"frame_id": frame}, "pose": {"position": {"x": x, "y": y, "z": 0.0}}}}


def located(world: World) -> Navigation:
    navigation = Navigation(ROOM)
    position, orientation = {"x": world.pose.x, "y": world.pose.y}, {"z": 0.0, "w": 1.0}
    navigation.hear(world, "/initialpose", {"pose": {"pose": {"position": position, "orientation": orientation}}})
    return navigation


def passed(world: World, navigation: Navigation, seconds: float) -> list[str]:
    """Let time pass; return the messages about goals, without feedback."""
    for step in range(round(seconds / STEP)):
        navigation.act(world)
        world.step()
        if step % 10 == 0:
            navigation.say(world)
    return [kind for _, kind, _ in navigation.events if kind != "feedback"]


def test_who_does_not_know_where_it_is_rejects_goals() -> None:
    world = World(Pose(0.5, 1.0))
    assert not Navigation(ROOM).accept(world, 1, goal(2.0, 1.0))
    assert not located(world).accept(world, 1, goal(2.0, 1.0, frame="moon"))


def test_it_arrives() -> None:
    world = World(Pose(0.5, 1.0), walls=ROOM)
    navigation = located(world)
    assert navigation.accept(world, 1, goal(2.5, 1.2))
    assert passed(world, navigation, 15.0) == ["succeeded"]
    assert (world.pose.x, world.pose.y) == pytest.approx((2.5, 1.2), abs=0.12)
    told = [data for _, kind, data in navigation.events if kind == "feedback"]
    assert told[0]["distance_remaining"] > told[-1]["distance_remaining"]
    assert {feedback["number_of_recoveries"] for feedback in told} == {0}


def test_it_drives_around_what_is_not_on_the_map() -> None:
    world = World(Pose(0.5, 1.0), walls=ROOM, pillars=[Disc(1.5, 1.0, 0.15)])
    navigation = located(world)
    navigation.accept(world, 1, goal(2.5, 1.0))
    assert passed(world, navigation, 20.0) == ["succeeded"]
    assert world.touched == 0


def test_it_helps_itself_and_gives_up_in_the_end() -> None:
    walls = [*ROOM, Segment(1.5, 0.0, 1.5, 2.0)]
    world = World(Pose(0.5, 1.0), walls=walls)
    navigation = located(world)
    navigation.accept(world, 1, goal(2.5, 1.0))
    assert passed(world, navigation, 60.0) == ["aborted"]
    assert max(data["number_of_recoveries"] for _, kind, data in navigation.events if kind == "feedback") >= 6
    assert world.drive.speed == (0.0, 0.0)


def test_it_cancels_its_own_goal_only() -> None:
    world = World(Pose(0.5, 1.0), walls=ROOM)
    navigation = located(world)
    navigation.accept(world, 1, goal(2.5, 1.0))
    assert not navigation.cancel(world, 2)
    assert navigation.cancel(world, 1)
    assert not navigation.cancel(world, 1)
    assert passed(world, navigation, 2.0) == ["canceled"]
    assert world.travelled < 0.05


def test_a_newer_goal_ends_the_old_one() -> None:
    world = World(Pose(0.5, 1.0), walls=ROOM)
    navigation = located(world)
    navigation.accept(world, 1, goal(2.5, 1.0))
    navigation.accept(world, 2, goal(0.8, 1.0))
    passed(world, navigation, 8.0)
    assert [(number, kind) for number, kind, _ in navigation.events if kind != "feedback"] == [
        (1, "aborted"),
        (2, "succeeded"),
    ]


def test_a_way_around_a_wall() -> None:
    grid = Grid(0.2)
    grid.block_wall(Segment(1.0, -2.0, 1.0, 1.0))
    way = grid.way((0.0, 0.0), (2.0, 0.0))
    assert way is not None
    assert way[-1] == (2.0, 0.0)
    assert max(y for _, y in way) > 1.1
    assert min(Segment(1.0, -2.0, 1.0, 1.0).distance(*leg) for leg in way) > 0.15


def test_no_way_into_what_is_blocked() -> None:
    grid = Grid(0.2)
    for wall in box(0.0, 0.0, 1.0, 1.0):
        grid.block_wall(wall)
    assert grid.way((2.0, 2.0), (0.5, 0.5)) is None
    assert grid.way((2.0, 2.0), (1.05, 0.5)) is None
