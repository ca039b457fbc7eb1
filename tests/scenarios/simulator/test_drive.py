"""A robot with two wheels drives straight on, on the spot and in a circle, and its encoders measure that."""

from __future__ import annotations

import math

import pytest

from examples.simulator.drive import ACCELERATION, MAX_ANGULAR, MAX_LINEAR, TRACK, Drive, rolled
from examples.simulator.geometry import Pose
from examples.simulator.world import STEP


def driven(linear: float, angular: float, seconds: float) -> Drive:
    drive = Drive(Pose(0.0, 0.0, 0.0))
    drive.command(linear, angular)
    for _ in range(round(seconds / STEP)):
        drive.pose = drive.step(STEP)
    return drive


def test_straight_on() -> None:
    # The distance is that at full speed, less the loss in acceleration: v² / 2a.
    drive = driven(0.2, 0.0, 5.0)
    assert drive.pose.x == pytest.approx(1.0 - 0.2**2 / (2 * ACCELERATION), abs=0.003)
    assert (drive.pose.y, drive.pose.heading) == (0.0, 0.0)
    assert drive.speed == pytest.approx((0.2, 0.0))


def test_on_the_spot() -> None:
    drive = driven(0.0, 1.0, math.pi)
    assert math.hypot(drive.pose.x, drive.pose.y) < 1e-12
    assert drive.pose.heading == pytest.approx(math.pi, abs=0.1)


def test_a_circle_comes_back() -> None:
    """A speed of 0.2 m/s and a rate of 0.4 rad/s give a radius of half a meter."""
    pose = Pose(0.0, 0.0, 0.0)
    for _ in range(100):
        turn = 2 * math.pi / 100
        pose = rolled(pose, (0.5 - TRACK / 2) * turn, (0.5 + TRACK / 2) * turn)
        assert math.hypot(pose.x, pose.y - 0.5) == pytest.approx(0.5)
    assert (pose.x, pose.y) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert pose.heading == pytest.approx(2 * math.pi)


def test_a_quarter_of_a_circle_by_hand() -> None:
    quarter = rolled(Pose(1.0, 1.0, 0.0), (1.0 - TRACK / 2) * math.pi / 2, (1.0 + TRACK / 2) * math.pi / 2)
    assert (quarter.x, quarter.y) == pytest.approx((2.0, 2.0))
    assert quarter.heading == pytest.approx(math.pi / 2)


def test_commands_stay_within_what_the_motors_can() -> None:
    drive = driven(-9.0, 9.0, 0.0)
    assert (drive.linear, drive.angular) == (-MAX_LINEAR, MAX_ANGULAR)


@pytest.mark.parametrize("command", [(math.nan, 0.0), (0.1, math.inf)])
def test_what_is_no_number_is_no_command(command: tuple[float, float]) -> None:
    drive = driven(0.2, 0.1, 0.0)
    drive.command(*command)
    assert (drive.linear, drive.angular) == (0.2, 0.1)


def test_wheels_take_time() -> None:
    drive = driven(0.2, 0.0, STEP)
    assert drive.speed[0] == pytest.approx(ACCELERATION * STEP)


def test_odometry_follows_within_steps_of_the_encoder() -> None:
    drive = driven(0.2, 0.3, 20.0)
    assert math.dist((drive.odometry.x, drive.odometry.y), (drive.pose.x, drive.pose.y)) < 0.005
    assert drive.odometry.heading == pytest.approx(drive.pose.heading, abs=0.002)
    # Odometry counts whole steps of the encoders, so it differs from the pose.
    assert drive.odometry != drive.pose
