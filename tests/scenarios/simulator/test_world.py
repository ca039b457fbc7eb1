"""Solid bodies, a rolling ball, and walking persons."""

from __future__ import annotations

import math

import pytest

from examples.simulator.geometry import Disc, Pose, Segment
from examples.simulator.world import FRONT, ROBOT_RADIUS, STEP, Ball, Person, World


def driven(world: World, linear: float, angular: float, seconds: float) -> World:
    world.drive.command(linear, angular)
    for _ in range(round(seconds / STEP)):
        world.step()
    return world


@pytest.mark.parametrize("thing", [Segment(0.5, -1.0, 0.5, 1.0), Disc(0.6, 0.0, 0.1)])
def test_walls_and_pillars_are_solid(thing: Segment | Disc) -> None:
    solid = {"walls": [thing]} if isinstance(thing, Segment) else {"pillars": [thing]}
    world = driven(World(Pose(0.0, 0.0), **solid), 0.2, 0.0, 5.0)
    assert world.gap == pytest.approx(0.0, abs=0.005)
    assert world.pose.x == pytest.approx(0.5 - ROBOT_RADIUS, abs=0.005)
    assert world.travelled == pytest.approx(world.pose.x)
    assert world.touched > 100
    # The robot can drive away from the wall that it touches.
    assert driven(world, -0.2, 0.0, 2.0).pose.x < 0.1


def test_without_anything_there_is_no_gap() -> None:
    assert World(Pose(0.0, 0.0)).gap == math.inf


def test_a_pushed_ball_stays_before_the_robot_and_rolls_on() -> None:
    world = driven(World(Pose(0.0, 0.0), ball=Ball(0.4, 0.05, 0.1)), 0.2, 0.0, 4.0)
    assert world.ball is not None
    pushed = world.ball.x
    assert pushed - world.pose.x == pytest.approx(FRONT + 0.1, abs=1e-6)
    assert world.ball.y == pytest.approx(0.05)
    driven(world, 0.0, 0.0, 2.0)
    # The ball rolls v² / 2a, which is 5 cm; the robot follows it for 1 cm.
    assert world.ball.x - pushed == pytest.approx(0.2**2 / 0.8, abs=0.006)


def test_a_ball_that_is_passed_by_is_not_moved() -> None:
    world = driven(World(Pose(0.0, 0.0), ball=Ball(0.5, 0.4, 0.1)), 0.2, 0.0, 5.0)
    assert world.ball is not None
    assert (world.ball.x, world.ball.y) == (0.5, 0.4)


def test_a_ball_does_not_roll_through_a_wall() -> None:
    world = driven(World(Pose(0.0, 0.0), walls=[Segment(1.0, -1.0, 1.0, 1.0)], ball=Ball(0.4, 0.0, 0.1)), 0.2, 0.0, 6.0)
    assert world.ball is not None
    assert world.ball.x == pytest.approx(0.9, abs=0.01)
    assert world.pose.x <= world.ball.x - 0.1 - FRONT + 1e-6
    assert world.touched > 0


def test_a_ball_in_the_goal() -> None:
    world = World(Pose(0.0, 0.0), ball=Ball(2.15, 0.0, 0.1), goal=(2.0, -0.5, 2.5, 0.5))
    assert world.ball is not None
    assert world.ball_in_goal
    world.ball.x = 2.05
    assert not world.ball_in_goal
    world.ball.x, world.ball.y = 2.2, 0.45
    assert not world.ball_in_goal


def test_a_person_walks_from_point_to_point() -> None:
    world = World(Pose(9.0, 9.0), person=Person(0.0, 0.0, 0.15))
    assert world.person is not None
    world.person.walk(0.5, (1.0, 0.0), (1.0, 1.0))
    driven(world, 0.0, 0.0, 3.0)
    assert (world.person.x, world.person.y) == pytest.approx((1.0, 0.5))
    driven(world, 0.0, 0.0, 3.0)
    assert (world.person.x, world.person.y) == (1.0, 1.0)
    assert world.person.way == []
