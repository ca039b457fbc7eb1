"""Inputs, actions and outputs of each device of the field."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from examples.simulator.field import Boom, Driver, Radio, Receiver, Remote
from examples.simulator.geometry import Pose
from examples.simulator.world import STEP, World

if TYPE_CHECKING:
    from examples.simulator.devices import Device


def passed(world: World, device: Device, seconds: float) -> None:
    for _ in range(round(seconds / STEP)):
        device.act(world)
        world.step()


def field(pose: Pose) -> World:
    return World(pose, fastest=1.5, acceleration=5.0)


def test_the_receiver_says_where_it_is_in_the_field_and_nothing_without_satellites() -> None:
    receiver, world = Receiver(lambda: 0.01), field(Pose(90.0, 30.0, math.pi))
    ((_, data),) = receiver.say(world)
    assert data["pose"]["pose"]["position"] == {"x": 90.01, "y": 30.01}
    receiver.in_view = False
    assert receiver.say(world) == []


def test_radio_and_stick_fall_silent() -> None:
    radio, remote, world = Radio(), Remote(), field(Pose())
    assert radio.say(world) == [("/radio/heartbeat", {})]
    radio.in_reach = False
    assert radio.say(world) == []
    assert remote.say(world) == [("/mode/automatic", {"data": False})]
    remote.stick = (0.5, 0.1)
    assert remote.say(world)[1] == ("/stick", {"linear": {"x": 0.5}, "angular": {"z": 0.1}})


def driven(boom: Boom, world: World, seconds: float) -> None:
    world.drive.command(1.0, 0.0)
    passed(world, boom, seconds)


def test_open_sections_spray_what_they_pass_over() -> None:
    boom, world = Boom(), field(Pose(0.5, 0.5))
    for section in ("left", "middle"):
        boom.hear(world, f"/nozzles/{section}/valve", {"data": True})
    driven(boom, world, 3.0)
    assert {row for _, row in boom.sprayed} == {0, 1}
    assert boom.level == pytest.approx(0.5 - 3.0 * 2 * boom.flow)
    boom.hear(world, "/nozzles/left/valve", {"data": False})
    before = {cell for cell in boom.sprayed if cell[1] == 1}
    driven(boom, world, 3.0)
    assert {cell for cell in boom.sprayed if cell[1] == 1} == before
    areas = sorted((area.x1, area.y1, area.x2, area.y2) for area in boom.areas())
    assert [area[1] for area in areas] == [0.0, 1.0]


def test_the_map_is_asked_about_the_ground_ahead() -> None:
    boom, world = Boom(), field(Pose(0.8, 0.5))
    boom.sprayed.add((1, 0))
    said: dict[str, Any] = dict(boom.say(world))
    assert [topic for topic, data in said.items() if data["data"] is True] == ["/nozzles/middle/sprayed"]


def test_an_empty_tank_sprays_nothing() -> None:
    boom, world = Boom(), field(Pose(0.5, 0.5))
    boom.level = 0.0
    boom.hear(world, "/nozzles/middle/valve", {"data": True})
    driven(boom, world, 2.0)
    assert boom.sprayed == set()


def goal(x: float, y: float) -> dict[str, Any]:
    return {"pose": {"pose": {"position": {"x": x, "y": y}}}}


def test_the_driver_arrives_gives_up_and_gives_way() -> None:
    driver, world = Driver(), field(Pose())
    driver.accept(world, 1, goal(3.0, 1.0))
    passed(world, driver, 6.0)
    assert (world.pose.x, world.pose.y) == pytest.approx((3.0, 1.0), abs=0.25)
    driver.accept(world, 2, goal(9.0, 1.0))
    driver.trouble = True
    passed(world, driver, 0.5)
    driver.accept(world, 3, goal(9.0, 1.0))
    driver.accept(world, 4, goal(9.0, 1.0))
    assert not driver.cancel(world, 3)
    assert driver.cancel(world, 4)
    ends = [(number, outcome) for number, outcome, _ in driver.events]
    assert ends == [(1, "succeeded"), (2, "aborted"), (3, "aborted"), (4, "canceled")]
    assert (driver.arrived, driver.under_way) == (1, False)
