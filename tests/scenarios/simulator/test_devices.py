"""Inputs, actions and outputs of each device."""

from __future__ import annotations

import math
from typing import Any

import pytest

from examples.simulator import camera
from examples.simulator.camera import BallDetector, GoalDetector, LineDetector, ObjectDetector, PersonDetector
from examples.simulator.devices import STOP, Button, Device, Lidar, Odometry, Rotator, Steps, Wheels
from examples.simulator.geometry import Pose, Segment
from examples.simulator.world import STEP, Ball, Person, Sight, World

EXACT: Any = lambda: 0.0  # noqa: E731
HERE = Pose(0.0, 0.0)


def velocity(linear: float, angular: float) -> dict[str, Any]:
    return {"linear": {"x": linear}, "angular": {"z": angular}}


def passed(world: World, device: Device, seconds: float, *, button: bool = True) -> list[tuple[str, dict[str, Any]]]:
    """Let time pass while the button repeats its release; return the messages of the device."""
    said = []
    for _ in range(round(seconds / STEP)):
        if button and STOP in device.hears:
            device.hear(world, STOP, {"data": False})
        device.act(world)
        world.step()
        said += device.say(world)
    return said


def only(device: Device, world: World) -> Any:
    ((_, data),) = device.say(world)
    return data


def test_wheels_hold_a_velocity_and_steps_end() -> None:
    rolling, stepping = World(HERE), World(HERE)
    for world, device, topic in [(rolling, Wheels(), "/cmd_vel"), (stepping, Steps(), "/simple_movement")]:
        device.hear(world, topic, velocity(0.2, 0.0))
        passed(world, device, 2.0)
    assert rolling.pose.x == pytest.approx(0.39, abs=0.01)
    # The distance is a tenth of a second at full speed, less the loss in starting, plus the distance of stopping.
    assert stepping.pose.x == pytest.approx(0.02, abs=0.003)
    assert stepping.drive.speed == (0.0, 0.0)


def test_a_scan_has_360_rays_and_is_infinite_where_nothing_is() -> None:
    data = only(Lidar(EXACT), World(HERE, walls=[Segment(1.0, -0.5, 1.0, 0.5)], ball=Ball(0.5, 0.0, 0.1)))
    assert len(data["ranges"]) == 360
    assert data["ranges"][0] == pytest.approx(1.0)  # the ball lies below the lidar
    assert data["ranges"][180] == math.inf
    assert data["angle_increment"] * 359 == pytest.approx(data["angle_max"])


def test_odometry_begins_at_the_start() -> None:
    world = World(Pose(3.0, 3.0, math.pi / 2))
    world.drive.command(0.2, 0.0)
    passed(world, Wheels(), 3.0)
    data = only(Odometry(), world)
    assert data["pose"]["pose"]["position"]["x"] == pytest.approx(world.travelled, abs=0.001)
    assert data["pose"]["pose"]["position"]["y"] == 0.0
    assert data["twist"]["twist"]["linear"]["x"] == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("topic", "data", "degrees"),
    [("/rotate_left", {"data": 90}, 90), ("/rotate_right", {"data": 45}, -45), ("/rotate_right", {}, -90)],
)
def test_the_rotator_turns_by_degrees_and_says_so_once(topic: str, data: dict[str, Any], degrees: int) -> None:
    world, rotator = World(HERE), Rotator("std_msgs/Int16")
    rotator.hear(world, topic, data)
    assert rotator.turning
    assert passed(world, rotator, 4.0) == [("/rotate_done", {})]
    assert math.degrees(world.pose.heading) == pytest.approx(degrees, abs=0.15)
    assert not rotator.turning


def test_the_rotator_gives_up_on_stop_and_says_nothing() -> None:
    world, rotator = World(HERE), Rotator("std_msgs/Empty")
    rotator.hear(world, "/rotate_left", {})
    assert passed(world, rotator, 1.0) == []
    rotator.hear(world, STOP, {"data": True})
    assert passed(world, rotator, 4.0) == []
    assert 0.2 < world.pose.heading < 1.2
    assert world.drive.speed == (0.0, 0.0)
    rotator.hear(world, STOP, {"data": True})  # there is no turn to cancel
    rotator.hear(world, "/rotate_right", {})
    assert passed(world, rotator, 4.0) == [("/rotate_done", {})]


def test_the_rotator_gives_up_where_its_button_is_silent() -> None:
    world, rotator = World(HERE), Rotator("std_msgs/Empty")
    rotator.hear(world, "/rotate_left", {})
    assert passed(world, rotator, 0.5, button=False) == []
    assert rotator.turning
    assert passed(world, rotator, 1.0, button=False) == []
    assert not rotator.turning
    assert world.drive.speed == (0.0, 0.0)


def test_the_button_repeats_whether_it_is_pressed() -> None:
    world, button = World(HERE), Button()
    assert button.say(world) == [(STOP, {"data": False})]
    button.pressed = True
    assert button.say(world) == button.say(world) == [(STOP, {"data": True})]
    button.silent = True
    assert button.say(world) == []


def test_the_line_is_seen_where_it_is() -> None:
    line = [(x / 100, 0.0) for x in range(-100, 100)]
    assert only(LineDetector(EXACT), World(HERE, line=line)) == {"data": pytest.approx(0.0)}
    # At 0.1 m to the left of the line, the line is 64 of 640 pixels, or 0.1 of 1 m, to the right.
    assert only(LineDetector(EXACT), World(Pose(0.0, 0.1), line=line)) == {"data": pytest.approx(64.0)}
    assert LineDetector(EXACT).say(World(Pose(0.0, 0.9), line=line)) == [("/no_line", {})]
    assert LineDetector(EXACT).say(World(Pose(1.0, 0.0), line=line)) == [("/no_line", {})]
    assert LineDetector(EXACT).say(World(HERE, line=line, line_covered=True)) == [("/no_line", {})]


def test_the_pixels_of_a_pinhole() -> None:
    # An object at the edge of the view, and one at half its tangent.
    eye = World(Pose(-camera.MOUNT, 0.0))
    edge = math.tan(camera.OPENING / 2)
    assert camera.place(eye, Sight("", 1.0, -edge / 2, 0.0), []) == pytest.approx((480.0, 480.0))
    assert camera.place(eye, Sight("", 2.0, edge, edge), []) == pytest.approx((80.0, 240.0))
    assert camera.place(eye, Sight("", 1.0, edge * 1.01, 0.1), []) is None
    assert camera.place(eye, Sight("", -1.0, 0.0, 0.1), []) is None
    assert camera.place(eye, Sight("", 2.0, 0.0, 0.1), [], reach=1.9) is None
    assert camera.place(eye, Sight("", 2.0, 0.0, 0.1), [Segment(1.0, -1.0, 1.0, 1.0)]) is None


def test_the_ball_detector() -> None:
    def said(ball: Ball) -> dict[str, Any]:
        return dict(BallDetector(EXACT).say(World(HERE, ball=ball)))

    assert said(Ball(-1.0, 0.0, 0.1)) == {"/no_ball": {}}
    far = said(Ball(1.07, -0.1, 0.1))
    assert far["/ball_correction"]["data"] == pytest.approx(camera.FOCAL * 0.1)
    assert set(far) == {"/ball_correction", "/no_adjustment"}
    assert set(said(Ball(1.07, -0.4, 0.1))) == {"/ball_correction", "/needs_adjustment"}
    assert set(said(Ball(0.24, 0.0, 0.1))) == {"/ball_correction", "/no_adjustment", "/ball_front_check"}


def test_the_goal_detector() -> None:
    goal = (2.0, -0.5, 2.5, 0.5)
    assert only(GoalDetector(EXACT), World(HERE, goal=goal)) == {"data": pytest.approx(0.0)}
    assert only(GoalDetector(EXACT), World(Pose(0.0, 0.3), goal=goal))["data"] > 0
    assert GoalDetector(EXACT).say(World(Pose(0.0, 0.0, math.pi), goal=goal)) == [("/no_goal", {})]


def test_darknet_names_the_surest_first_and_shows_no_boxes_of_nothing() -> None:
    sights = [Sight("stop sign", 1.5, 0.1, 0.2, 0.8), Sight("chair", 1.5, -0.3, 0.2, 0.9), Sight("cat", 9.0, 0.0, 0.2)]
    said = dict(ObjectDetector().say(World(HERE, sights=sights)))
    assert said["/darknet_ros/found_object"]["count"] == 2
    boxes = said["/darknet_ros/bounding_boxes"]["bounding_boxes"]
    assert [box["class_id"] for box in boxes] == ["chair", "stop sign"]
    ((topic, data),) = ObjectDetector().say(World(Pose(0.0, 0.0, math.pi), sights=sights))
    assert (topic, data["count"]) == ("/darknet_ros/found_object", 0)


def test_people_are_boxes_in_pixels() -> None:
    (box,) = only(PersonDetector(), World(HERE, person=Person(2.07, 0.0, 0.2)))["bounding_boxes"]
    half = camera.FOCAL * 0.2 / 2.0
    assert (box["class_id"], box["img_width"]) == ("person", 640)
    assert (box["xmin"], box["xmax"]) == (round(320 - half), round(320 + half))
    hidden = World(HERE, person=Person(2.07, 0.0, 0.2), walls=[Segment(1.0, -1.0, 1.0, 1.0)])
    assert only(PersonDetector(), hidden)["bounding_boxes"] == []
