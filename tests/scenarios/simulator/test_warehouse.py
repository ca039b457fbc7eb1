"""Inputs, actions, outputs and answers of each device of the warehouse."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from examples.simulator.geometry import Pose, Segment, box
from examples.simulator.warehouse import (
    AisleManager,
    Battery,
    Bumpers,
    Docking,
    DockServer,
    Lift,
    SafetyLidars,
    Server,
    Undocking,
    WarehouseNavigation,
)
from examples.simulator.world import STEP, World

if TYPE_CHECKING:
    from examples.simulator.devices import Device


def passed(world: World, device: Device, seconds: float) -> None:
    for _ in range(round(seconds / STEP)):
        device.act(world)
        world.step()


def answers(server: Server) -> list[tuple[str, bool]]:
    given = [(call, data["success"]) for _, call, data in server.given]
    server.given.clear()
    return given


def test_the_lidars_look_ahead_and_back_each_over_its_part() -> None:
    lidars = SafetyLidars(lambda: 0.0)
    world = World(Pose(0.0, 0.0), walls=[Segment(1.0, -0.1, 1.0, 0.1), Segment(-2.0, -0.1, -2.0, 0.1)])
    said = {topic: data["ranges"] for topic, data in lidars.say(world)}
    assert min(said["/front/scan"]) == said["/front/scan"][15] == pytest.approx(1.0)
    assert min(said["/rear/scan"]) == said["/rear/scan"][15] == pytest.approx(2.0)
    assert said["/front/scan"][0] == math.inf
    lidars.silent.add("/rear/scan")
    assert [topic for topic, _ in lidars.say(world)] == ["/front/scan"]


def test_bumpers_say_which_is_pressed() -> None:
    bumpers = Bumpers()
    bumpers.pressed.add("/left/bumper")
    assert [topic for topic, data in bumpers.say(World(Pose())) if data["data"]] == ["/left/bumper"]


def test_the_battery_is_charged_in_the_dock_and_used_on_the_way() -> None:
    docking, world = Docking(0.0), World(Pose())
    battery = Battery(docking, 0.5)
    passed(world, battery, 2.0)
    ((_, data),) = battery.say(world)
    assert data["percentage"] == pytest.approx(0.6)
    docking.docked = False
    world.drive.command(0.2, 0.0)
    passed(world, battery, 5.0)
    assert battery.charge == pytest.approx(0.6 - 0.004 * world.travelled, abs=0.001)


def test_the_lift_answers_when_it_is_there_and_jams() -> None:
    lift, world = Lift(), World(Pose())
    lift.ask(world, "/lift/raise", 1)
    passed(world, lift, 1.4)
    assert answers(lift) == []
    passed(world, lift, 0.2)
    assert (answers(lift), lift.height) == ([(1, True)], 1.0)
    lift.jams = 1
    for call, done in [(2, False), (3, True)]:
        lift.ask(world, "/lift/lower", call)
        passed(world, lift, 1.6)
        assert answers(lift) == [(call, done)]
    assert lift.height == 0.0


def test_the_aisle_lets_nobody_in_while_it_is_crowded() -> None:
    aisle, world = AisleManager(), World(Pose())
    for call, (service, crowded, done, inside) in enumerate(
        [
            ("/aisle/enter", True, False, False),
            ("/aisle/enter", False, True, True),
            ("/aisle/leave", True, True, False),
        ]
    ):
        aisle.crowded = crowded
        aisle.ask(world, service, call)
        passed(world, aisle, 0.4)
        assert (answers(aisle), aisle.let_in) == ([(call, done)], inside)


def goal_of(dock: str) -> dict[str, Any]:
    return {"dock_id": dock, "navigate_to_staging_pose": False}


def ends(server: DockServer) -> list[tuple[int, str, bool]]:
    found = [(number, how, data["success"]) for number, how, data in server.events]
    server.events.clear()
    return found


def test_the_dock_lets_go_and_takes_back_whichever_way_the_robot_looks() -> None:
    docking, world = Docking(-0.7), World(Pose(-0.7, 0.0), fastest=1.0, acceleration=5.0)
    undocking = Undocking(docking)
    assert undocking.accept(world, 1, {})
    passed(world, undocking, 4.0)
    assert (ends(undocking), docking.docked) == ([(1, "succeeded", True)], False)
    assert world.pose.x == pytest.approx(0.0, abs=0.05)
    world.drive.pose = Pose(0.0, 0.0, 3.0)
    assert not docking.accept(world, 2, goal_of("another"))
    docking.refusals = 1
    assert docking.accept(world, 3, goal_of("home"))
    assert (ends(docking), docking.docked) == ([(3, "aborted", False)], False)
    assert docking.accept(world, 4, goal_of("home"))
    assert not docking.accept(world, 5, goal_of("home"))
    passed(world, docking, 8.0)
    assert (ends(docking), docking.docked) == ([(4, "succeeded", True)], True)
    assert (world.pose.x, world.pose.heading) == pytest.approx((-0.7, 0.0), abs=0.05)


def test_a_canceled_movement_at_the_dock_stops_the_robot() -> None:
    docking, world = Docking(-0.7), World(Pose(0.0, 0.0), fastest=1.0, acceleration=5.0)
    docking.docked = False
    assert docking.accept(world, 1, goal_of("home"))
    passed(world, docking, 1.0)
    assert not docking.cancel(world, 2)
    assert docking.cancel(world, 1)
    stopped = world.pose.x
    passed(world, docking, 1.0)
    assert (ends(docking), docking.docked) == ([(1, "canceled", False)], False)
    assert world.pose.x == pytest.approx(stopped, abs=0.05)
    assert -0.6 < stopped < -0.1


def test_nav2_keeps_to_the_limit_and_to_its_distance() -> None:
    def goal(x: float) -> dict[str, Any]:
        return {"pose": {"header": {"frame_id": "map"}, "pose": {"position": {"x": x, "y": 0.0}}}}

    walls = box(-2.0, -1.5, 8.0, 1.5)
    world = World(Pose(), walls=walls, fastest=1.0, acceleration=5.0)
    navigation = WarehouseNavigation(walls, Pose())
    assert navigation.accept(world, 1, goal(6.0))
    speeds = []
    for limit in (None, 0.3, 0.8):
        if limit is not None:
            navigation.hear(world, "/speed_limit", {"percentage": False, "speed_limit": limit})
        passed(world, navigation, 2.0)
        speeds.append(world.drive.speed[0])
    assert speeds == pytest.approx([0.2, 0.3, 0.8], abs=0.05)
    assert navigation.under_way
    passed(world, navigation, 8.0)
    assert (navigation.arrived, navigation.under_way) == (1, False)
    assert navigation.accept(world, 2, goal(7.6))
    passed(world, navigation, 1.0)
    assert world.pose.x < 7.0, "nearer to the wall than it keeps"
