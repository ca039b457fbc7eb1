"""What a device is: it hears commands, acts on the world, and says what it senses. And the plain ones of them."""

from __future__ import annotations

import math

from .geometry import cast
from .world import STEP

RAYS, RANGE_MIN, RANGE_MAX = 360, 0.12, 3.5
EMPTY, NUMBER, TWIST = "std_msgs/Empty", "std_msgs/Float32", "geometry_msgs/Twist"
BOOLEAN, TRIGGER = "std_msgs/Bool", "std_srvs/Trigger"
STOP, GO_ON = "/emergency_stop", "/continue"


class Device:
    """Something with topics.

    `says` and `hears` map its topics to ROS types, `answers` its services, `serves` its actions; data is a mapping from
    fields to values. `say` is asked once a `period`. A device with services has `given`, a list that it fills with
    answers, each (service, call, data).
    """

    period = 0.1
    says: dict[str, str] = {}  # noqa: RUF012  # a table, never changed
    hears: dict[str, str] = {}  # noqa: RUF012
    answers: dict[str, str] = {}  # noqa: RUF012
    serves: dict[str, str] = {}  # noqa: RUF012

    def ask(self, world, service, call):
        """Takes a call of one of its services, to be answered later."""

    def hear(self, world, topic, data):
        """Takes a message from one of the topics that it hears."""

    def act(self, world):
        """Moves what it moves, before each step of the world."""

    def say(self, world):
        """What it sends now: topics with data."""
        del world
        return []

    def news(self):
        """What has happened to it since it was last asked, in words; for the picture."""
        return []

    def areas(self):
        """The parts of the floor that it has changed; for the picture."""
        return ()


def header(world, frame):
    """A header with the world's time."""
    return {"stamp": world.time, "frame_id": frame}


class Wheels(Device):
    """Drives at the velocity that it was last sent."""

    hears = {"/cmd_vel": TWIST}  # noqa: RUF012

    def hear(self, world, topic, data):
        """Takes a velocity."""
        del topic
        world.drive.command(data["linear"]["x"], data["angular"]["z"])


class Steps(Device):
    """Drives at each velocity for a tenth of a second (thesis section 6.3.9)."""

    hears = {"/simple_movement": TWIST}  # noqa: RUF012
    length = 0.1

    def __init__(self):
        self._until = 0.0

    def hear(self, world, topic, data):
        """Takes a step."""
        del topic
        world.drive.command(data["linear"]["x"], data["angular"]["z"])
        self._until = world.time + self.length

    def act(self, world):
        """Stands when the step is over."""
        if world.time >= self._until - STEP / 2:
            world.drive.command(0.0, 0.0)


class Odometry(Device):
    """Says where the wheels' encoders say that the robot is."""

    period = 0.1
    says = {"/odom": "nav_msgs/Odometry"}  # noqa: RUF012

    def say(self, world):
        """A pose in the frame of the start, and the speed."""
        pose, (linear, angular) = world.drive.odometry, world.drive.speed
        data = {
            "header": header(world, "odom"),
            "child_frame_id": "base_footprint",
            "pose": {"pose": as_pose(pose)},
            "twist": {"twist": {"linear": {"x": linear}, "angular": {"z": angular}}},
        }
        return [("/odom", data)]


class Lidar(Device):
    """360 rays, one a degree, counter-clockwise from straight ahead; one that meets nothing is infinite (REP 117)."""

    says = {"/scan": "sensor_msgs/LaserScan"}  # noqa: RUF012

    def __init__(self, noise):
        """`noise` gives the error of each ray, in metres."""
        self._noise = noise

    def say(self, world):
        """A scan."""
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
    """An emergency stop, and beside it a button to go on: the first repeats whether it is pressed, or is `silent`."""

    says = {STOP: BOOLEAN, GO_ON: EMPTY}  # noqa: RUF012

    def __init__(self):
        self.pressed = self.silent = False

    def say(self, world):
        """Whether it is pressed."""
        del world
        return [] if self.silent else [(STOP, {"data": self.pressed})]


class Rotator(Device):
    """Turns the robot by a number of degrees when asked to and says when it has (thesis section 6.3.5).

    A turn ends where the encoders say so. It gives up, and reports nothing, while the emergency stop is pressed or has
    been silent for `patience` seconds. `by` are the degrees of a turn whose message holds none.
    """

    period = STEP
    says = {"/rotate_done": EMPTY}  # noqa: RUF012
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
        """Whether a turn is under way."""
        return self._target is not None

    def hear(self, world, topic, data):
        """Begins a turn, or gives up."""
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
        """Turns on, the slower the nearer the end."""
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
        """That it is done."""
        del world
        done, self._done = self._done, False
        return [("/rotate_done", {})] if done else []

    def news(self):
        """Turns."""
        news, self._news = self._news, []
        return news


def as_pose(pose):
    """A pose as ROS has it."""
    return {
        "position": {"x": pose.x, "y": pose.y},
        "orientation": {"z": math.sin(pose.heading / 2), "w": math.cos(pose.heading / 2)},
    }
