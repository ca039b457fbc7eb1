"""Devices in a warehouse: lidars before and behind, bumpers, a battery, a lift, a dock, an aisle, and Nav2."""

from __future__ import annotations

import math

from .devices import BOOLEAN, RANGE_MAX, TRIGGER, Device, header
from .geometry import Pose, cast, turned
from .navigation import Navigation
from .world import STEP


class Server(Device):
    """A server of services without data. A call gets its answer at its time, or when `act` sends it."""

    period = STEP

    def __init__(self):
        self.given = []
        self._news = []

    def answer(self, service, call, success, words):
        """Answer a call. The picture shows the words, too."""
        self.given.append((service, call, {"success": success, "message": words}))
        self._news.append(words)

    def news(self):
        """Return descriptions of answers and other events."""
        news, self._news = self._news, []
        return news


class SafetyLidars(Device):
    """Two lidars, ahead and behind, each with rays every other degree over 60 degrees. `silent`: disconnected ones."""

    says = {"/front/scan": "sensor_msgs/LaserScan", "/rear/scan": "sensor_msgs/LaserScan"}
    #: The rays in degrees from the middle.
    rays = range(-30, 31, 2)

    def __init__(self, noise):
        """Create the lidars. `noise` returns the error of each ray in meters."""
        self._noise = noise
        self.silent = set()

    def say(self, world):
        """Return two scans from right to left."""
        seen = cast(world.pose, world.seen_by_lidar, 360, RANGE_MAX)
        fields = {"/front/scan": 0, "/rear/scan": 180}
        return [
            (topic, self._scan(world, topic, [seen[(middle + ray) % 360] for ray in self.rays]))
            for topic, middle in fields.items()
            if topic not in self.silent
        ]

    def _scan(self, world, topic, distances):
        return {
            "header": header(world, topic.split("/")[1] + "_lidar"),
            "angle_min": math.radians(self.rays[0]),
            "angle_max": math.radians(self.rays[-1]),
            "angle_increment": math.radians(self.rays.step),
            "range_min": 0.05,
            "range_max": RANGE_MAX,
            "ranges": [distance + self._noise() if distance < math.inf else distance for distance in distances],
        }


class Bumpers(Device):
    """Four switches around the robot. `pressed`: the touched ones."""

    says = {f"/{side}/bumper": BOOLEAN for side in ("front", "rear", "left", "right")}

    def __init__(self):
        self.pressed = set()

    def say(self, world):
        """Return the state of each switch."""
        del world
        return [(topic, {"data": topic in self.pressed}) for topic in self.says]


class Battery(Device):
    """A battery, discharged on the way and charged in the dock. Faster than real ones, for short simulations."""

    period = 0.2
    says = {"/battery_state": "sensor_msgs/BatteryState"}
    per_metre, per_second = 0.004, 0.05

    def __init__(self, docking, charge):
        self._docking = docking
        self._travelled = 0.0
        self.charge = charge

    def act(self, world):
        """Charge or discharge."""
        self.charge -= (world.travelled - self._travelled) * self.per_metre
        self._travelled = world.travelled
        if self._docking.docked:
            self.charge = min(1.0, self.charge + self.per_second * STEP)

    def say(self, world):
        """Return the remaining charge."""
        return [("/battery_state", {"header": header(world, "battery"), "percentage": self.charge})]


class Lift(Server):
    """A lift below a shelf that moves up or down in a second and a half. `jams`: how often it will not come down."""

    answers = {"/lift/raise": TRIGGER, "/lift/lower": TRIGGER}
    takes = 1.5

    def __init__(self):
        super().__init__()
        #: From 0 (down) to 1.
        self.height = 0.0
        self.jams = 0
        self._call = None

    def ask(self, world, service, call):
        """Begin to move."""
        del world
        if service == "/lift/lower" and self.jams:
            self.jams -= 1
            self.answer(service, call, False, "the lift jams")
        else:
            self._call = service, call

    def act(self, world):
        """Continue to move."""
        del world
        if self._call is None:
            return
        service, call = self._call
        wanted = 1.0 if service == "/lift/raise" else 0.0
        change = STEP / self.takes
        self.height += max(-change, min(change, wanted - self.height))
        if abs(self.height - wanted) < change / 2:
            self.height, self._call = wanted, None
            self.answer(service, call, True, "the lift is up" if wanted else "the lift is down")


class AisleManager(Server):
    """A manager that lets robots into the aisle while people leave room there."""

    answers = {"/aisle/enter": TRIGGER, "/aisle/leave": TRIGGER}
    takes = 0.3

    def __init__(self):
        super().__init__()
        self.crowded = False
        self.let_in = False
        self._calls = []

    def ask(self, world, service, call):
        """Queue a call, to be answered later."""
        self._calls.append((world.time + self.takes, service, call))

    def act(self, world):
        """Answer the calls that are due."""
        while self._calls and world.time >= self._calls[0][0]:
            _, service, call = self._calls.pop(0)
            entering = service == "/aisle/enter"
            refused = entering and self.crowded
            if not refused:
                self.let_in = entering
            words = "into the aisle" if entering else "out of the aisle"
            self.given.append((service, call, {"success": not refused, "message": words}))
            if not refused:
                self._news.append(words)


class DockServer(Device):
    """One of the two action servers of Nav2's docking. A movement follows the x axis, to the east or to the west.

    The robot stands before its dock at the map's origin. A subclass moves the robot in `step`, until that returns True.
    """

    speed, turn_speed, precision = 0.3, 1.0, math.radians(1)
    words = ""

    def __init__(self):
        self.events = []
        self._goal = None
        self._news = []

    def accept(self, world, goal, data):
        """Begin a movement. Return whether that is possible."""
        del world, data
        if self._goal is not None:
            return False
        self._goal = goal
        return True

    def cancel(self, world, goal):
        """End a movement. Return whether it was under way."""
        if goal != self._goal:
            return False
        self.end(world, "canceled", "the robot stops at its dock")
        return True

    def act(self, world):
        """Continue the movement."""
        if self._goal is None:
            return
        off = turned(-world.pose.heading)
        if abs(off) > self.precision:
            world.drive.command(0.0, max(-self.turn_speed, min(self.turn_speed, 4 * off)))
        elif self.step(world):
            self.end(world, "succeeded", self.words)

    def end(self, world, how, words):
        """End the goal. The picture shows the words."""
        world.drive.command(0.0, 0.0)
        self.events.append((self._goal, how, {"success": how == "succeeded"}))
        self._goal = None
        self._news.append(words)

    def news(self):
        """Return descriptions of the ends of movements."""
        news, self._news = self._news, []
        return news


class Docking(DockServer):
    """Drives the robot into its dock. `refusals`: how often it will not."""

    serves = {"/dock_robot": "nav2_msgs/DockRobot"}
    words = "in the dock"

    def __init__(self, place):
        """Create the server. `place` is the dock's position on the x axis."""
        super().__init__()
        self.docked = True
        self.refusals = 0
        self._place = place

    def accept(self, world, goal, data):
        """Begin a movement. Return whether that is possible. The only dock is `home`."""
        if data["dock_id"] != "home" or not super().accept(world, goal, data):
            return False
        if self.refusals:
            self.refusals -= 1
            self.end(world, "aborted", "the dock refuses")
        return True

    def step(self, world):
        """Drive backwards. Return whether the robot is in the dock."""
        if world.pose.x > self._place:
            world.drive.command(-self.speed, 0.0)
        else:
            self.docked = True
        return self.docked


class Undocking(DockServer):
    """Drives the robot off its dock."""

    serves = {"/undock_robot": "nav2_msgs/UndockRobot"}
    words = "off the dock"

    def __init__(self, docking):
        super().__init__()
        self._docking = docking

    def step(self, world):
        """Drive ahead. Return whether the robot is off the dock."""
        self._docking.docked = False
        if world.pose.x < 0.0:
            world.drive.command(self.speed, 0.0)
        return world.pose.x >= 0.0


class WarehouseNavigation(Navigation):
    """Nav2 that knows the robot's start, keeps more distance from obstacles, and obeys a speed limit."""

    hears = {"/speed_limit": "nav2_msgs/SpeedLimit"}
    clearance = 0.65
    #: The creeping speed without a limit, and near the goal.
    creep = 0.2

    def __init__(self, known_walls, start):
        """Create the server. `start` is the robot's initial position."""
        super().__init__(known_walls)
        self._origin, self._odometry_then = start, Pose()
        self._limit = self.creep

    @property
    def under_way(self):
        """Whether there is a goal."""
        return self._goal is not None

    def hear(self, world, topic, data):
        """Set a limit in meters per second. Ignore percentages."""
        del world, topic
        if not data["percentage"]:
            self._limit = data["speed_limit"]

    def _speed(self, pose):
        left = math.hypot(self._destination[0] - pose.x, self._destination[1] - pose.y)
        return min(self._limit, max(self.creep, left))
