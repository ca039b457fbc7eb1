"""Devices, which receive commands, act on the world and publish measurements. The simple ones are here."""

from __future__ import annotations

import math

from .geometry import cast
from .world import STEP

RAYS, RANGE_MIN, RANGE_MAX = 360, 0.12, 3.5
EMPTY, NUMBER, TWIST = "std_msgs/Empty", "std_msgs/Float32", "geometry_msgs/Twist"
BOOLEAN, TRIGGER = "std_msgs/Bool", "std_srvs/Trigger"
STOP, GO_ON = "/emergency_stop", "/continue"


class Device:
    """A device with topics.

    `says` and `hears` map its topics to ROS types, `answers` its services, `serves` its actions. Data is a mapping from
    fields to values. The simulation calls `say` once per `period`. A device with services has a list `given`, to which
    it adds answers as (service, call, data).
    """

    period = 0.1
    says: dict[str, str] = {}
    hears: dict[str, str] = {}
    answers: dict[str, str] = {}
    serves: dict[str, str] = {}

    def ask(self, world, service, call):
        """Accept a call of one of the device's services, to be answered later."""

    def hear(self, world, topic, data):
        """Handle a message on one of the device's subscribed topics."""

    def act(self, world):
        """Move the device's parts, before each step of the world."""

    def say(self, world):
        """Return the messages to send now: topics with data."""
        del world
        return []

    def news(self):
        """Return descriptions of the events since the last call, for the picture."""
        return []

    def areas(self):
        """Return the areas of the floor that the device has changed, for the picture."""
        return ()


def header(world, frame):
    """Return a header with the world's time."""
    return {"stamp": world.time, "frame_id": frame}


class Wheels(Device):
    """Wheels that drive at the last received velocity."""

    hears = {"/cmd_vel": TWIST}

    def hear(self, world, topic, data):
        """Set the velocity."""
        del topic
        world.drive.command(data["linear"]["x"], data["angular"]["z"])


class Steps(Device):
    """Wheels that drive at each velocity for a tenth of a second (thesis section 6.3.9)."""

    hears = {"/simple_movement": TWIST}
    length = 0.1

    def __init__(self):
        self._until = 0.0

    def hear(self, world, topic, data):
        """Begin a step."""
        del topic
        world.drive.command(data["linear"]["x"], data["angular"]["z"])
        self._until = world.time + self.length

    def act(self, world):
        """Stop at the end of the step."""
        if world.time >= self._until - STEP / 2:
            world.drive.command(0.0, 0.0)


class Odometry(Device):
    """The position of the robot according to the encoders of its wheels."""

    period = 0.1
    says = {"/odom": "nav_msgs/Odometry"}

    def say(self, world):
        """Return a pose in the frame of the start, and the speed."""
        pose, (linear, angular) = world.drive.odometry, world.drive.speed
        data = {
            "header": header(world, "odom"),
            "child_frame_id": "base_footprint",
            "pose": {"pose": as_pose(pose)},
            "twist": {"twist": {"linear": {"x": linear}, "angular": {"z": angular}}},
        }
        return [("/odom", data)]


class Lidar(Device):
    """360 rays, one per degree, counter-clockwise from straight ahead. A ray without a hit is infinite (REP 117)."""

    says = {"/scan": "sensor_msgs/LaserScan"}

    def __init__(self, noise):
        """Create the lidar. `noise` returns the error of each ray in meters."""
        self._noise = noise

    def say(self, world):
        """Return a scan."""
        seen = cast(world.pose, world.seen_by_lidar, RAYS, RANGE_MAX)
        data = {
            "header": header(world, "base_scan"),
            "angle_min": 0.0,
            "angle_max": 2 * math.pi * (RAYS - 1) / RAYS,
            "angle_increment": 2 * math.pi / RAYS,
            "time_increment": 0.0,
            "scan_time": self.period,
            "range_min": RANGE_MIN,
            "range_max": RANGE_MAX,
            "ranges": [distance + self._noise() if distance < math.inf else distance for distance in seen],
        }
        return [("/scan", data)]


class Button(Device):
    """An emergency stop that repeats whether it is pressed, or is `silent`, and a button to continue."""

    says = {STOP: BOOLEAN, GO_ON: EMPTY}

    def __init__(self):
        self.pressed = self.silent = False

    def say(self, world):
        """Return whether the emergency stop is pressed."""
        del world
        return [] if self.silent else [(STOP, {"data": self.pressed})]


class Rotator(Device):
    """A device that turns the robot by a number of degrees on request and reports the end (thesis section 6.3.5).

    The encoders determine the end of a turn. The device interrupts a turn, without a report, while the emergency stop
    is pressed or has been silent for `patience` seconds. `by` is the number of degrees for messages without a number.
    """

    period = STEP
    says = {"/rotate_done": EMPTY}
    fastest, precision, patience = 0.8, math.radians(0.05), 0.5

    def __init__(self, kind, by=90):
        self.hears = {"/rotate_left": kind, "/rotate_right": kind, STOP: BOOLEAN}
        self._by = by
        self._button_heard = 0.0
        self._target = None
        self._done = False
        self._news = []

    @property
    def turning(self):
        """Whether the device is turning."""
        return self._target is not None

    def hear(self, world, topic, data):
        """Begin a turn, or interrupt it."""
        if topic == STOP:
            self._button_heard = world.time
            if data["data"]:
                self._give_up(world)
            return
        angle = math.radians(data.get("data", self._by))
        left = topic == "/rotate_left"
        self._target = world.drive.odometry.heading + (angle if left else -angle)
        self._news.append("turns left" if left else "turns right")

    def act(self, world):
        """Continue the turn, more slowly towards its end."""
        if world.time - self._button_heard > self.patience:
            self._give_up(world)
        if self._target is None:
            return
        missing = self._target - world.drive.odometry.heading
        if abs(missing) < self.precision and abs(world.drive.speed[1]) < 0.01:
            world.drive.command(0.0, 0.0)
            self._target, self._done = None, True
        else:
            world.drive.command(0.0, max(-self.fastest, min(self.fastest, 4 * missing)))

    def _give_up(self, world):
        if self.turning:
            self._target = None
            world.drive.command(0.0, 0.0)
            self._news.append("a turn is given up")

    def say(self, world):
        """Return the report of a finished turn."""
        del world
        done, self._done = self._done, False
        return [("/rotate_done", {})] if done else []

    def news(self):
        """Return descriptions of turns."""
        news, self._news = self._news, []
        return news


def as_pose(pose):
    """Return a pose in the form of ROS."""
    return {
        "position": {"x": pose.x, "y": pose.y},
        "orientation": {"z": math.sin(pose.heading / 2), "w": math.cos(pose.heading / 2)},
    }
