"""Devices in a field: a satellite receiver, a radio, a tank, a stick, a boom with three sections, and a driver."""

from __future__ import annotations

import math

from .devices import BOOLEAN, EMPTY, NUMBER, TWIST, Device, as_pose, header
from .geometry import turned
from .world import STEP, Area

ACTION = "/navigate_to_pose"
SECTIONS = {"left": 1.0, "middle": 0.0, "right": -1.0}
#: The map of sprayed squares: the size of a square.
CELL = 1.0


class Receiver(Device):
    """The position of the sprayer in the field."""

    says = {"/odom": "nav_msgs/Odometry"}

    def __init__(self, noise):
        """Create the receiver. `noise` returns an error in meters."""
        self._noise = noise
        self.in_view = True

    def say(self, world):
        """Return a pose in the frame of the field, and the speed. Return no message without satellites in view."""
        if not self.in_view:
            return []
        pose = as_pose(world.pose)
        pose["position"] = {axis: place + self._noise() for axis, place in pose["position"].items()}
        linear, angular = world.drive.speed
        twist = {"linear": {"x": linear}, "angular": {"z": angular}}
        data = {"header": header(world, "field"), "pose": {"pose": pose}, "twist": {"twist": twist}}
        return [("/odom", data)]


class Radio(Device):
    """A radio that sends a heartbeat while it is in reach."""

    period = 0.2
    says = {"/radio/heartbeat": EMPTY}

    def __init__(self):
        self.in_reach = True

    def say(self, world):
        """Return a heartbeat."""
        del world
        return [("/radio/heartbeat", {})] if self.in_reach else []


class Remote(Device):
    """A switch between manual and automatic driving, and a stick. A released stick sends no messages."""

    says = {"/mode/automatic": BOOLEAN, "/stick": TWIST}

    def __init__(self):
        self.automatic = False
        #: The requested velocity, linear and angular. None: the stick is released.
        self.stick = None

    def say(self, world):
        """Return the messages of the switch, and of the stick while it is held."""
        del world
        said = [("/mode/automatic", {"data": self.automatic})]
        if self.stick is not None:
            linear, angular = self.stick
            said.append(("/stick", {"linear": {"x": linear}, "angular": {"z": angular}}))
        return said


class Boom(Device):
    """Three sections side by side, each with a valve, a tank for all of them, and a map of the sprayed ground.

    A section reads the map a little ahead of its place, so that its valve has switched when it arrives there.
    """

    says = {
        **{f"/nozzles/{section}/sprayed": BOOLEAN for section in SECTIONS},
        "/tank/level": NUMBER,
    }
    hears = {f"/nozzles/{section}/valve": BOOLEAN for section in SECTIONS}
    ahead, behind = 0.3, -0.4
    #: The consumption of an open section per second.
    flow = 0.001

    def __init__(self):
        self.level = 0.5
        self.open = set()
        self.sprayed = set()
        #: The number of times that a sprayed square was sprayed again.
        self.twice = 0
        self._under = dict.fromkeys(SECTIONS)

    def hear(self, world, topic, data):
        """Open or close a valve."""
        del world
        section = topic.split("/")[2]
        (self.open.add if data["data"] else self.open.discard)(section)

    def act(self, world):
        """Spray the ground below the open sections while the tank is not empty."""
        for section in SECTIONS:
            cell = self._cell(world, section, self.behind)
            if cell != self._under[section]:
                self._under[section] = cell
                if section in self.open and self.level > 0.0:
                    self.twice += cell in self.sprayed
                    self.sprayed.add(cell)
        self.level = max(0.0, self.level - self.flow * STEP * len(self.open))

    def say(self, world):
        """Return the map's answers and the level of the tank."""
        said = [
            (f"/nozzles/{section}/sprayed", {"data": self._cell(world, section, self.ahead) in self.sprayed})
            for section in SECTIONS
        ]
        return [*said, ("/tank/level", {"data": self.level})]

    def areas(self):
        """Return the sprayed ground as rows of squares."""
        rows = {}
        for column, row in self.sprayed:
            rows.setdefault(row, set()).add(column)
        for row, columns in sorted(rows.items()):
            for first in sorted(column for column in columns if column - 1 not in columns):
                last = first
                while last + 1 in columns:
                    last += 1
                yield Area("", first * CELL, row * CELL, (last + 1) * CELL, (row + 1) * CELL, "#cfe8cf")

    @staticmethod
    def _cell(world, section, ahead):
        x, y = world.pose.ahead(ahead, SECTIONS[section])
        return math.floor(x / CELL), math.floor(y / CELL)


class Driver(Device):
    """A driver that drives straight to a pose regardless of the ground. With `trouble`, it gets stuck and gives up.

    It adds the events of goals to `events`, as `Navigation` does.
    """

    serves = {ACTION: "nav2_msgs/NavigateToPose"}
    period = 0.2
    speed, turn_speed, tolerance = 1.0, 1.5, 0.15

    def __init__(self):
        self.events = []
        self.arrived = 0
        self.trouble = False
        self._goal = self._destination = None
        self._news = []

    @property
    def under_way(self):
        """Whether there is a goal."""
        return self._goal is not None

    def accept(self, world, goal, data):
        """Begin a journey. A newer goal ends the previous one."""
        if self._goal is not None:
            self._end(world, "aborted", "gives way to a newer goal")
        position = data["pose"]["pose"]["position"]
        self._goal, self._destination = goal, (position["x"], position["y"])
        self._news.append("sets off")
        return True

    def cancel(self, world, goal):
        """End a journey. Return whether it was under way."""
        if goal != self._goal:
            return False
        self._end(world, "canceled", "the journey is cancelled")
        return True

    def act(self, world):
        """Continue the journey."""
        if self._goal is None:
            return
        ahead, left = world.pose.towards(*self._destination)
        away = math.hypot(ahead, left)
        if self.trouble:
            self.trouble = False
            self._end(world, "aborted", "is stuck in the mud")
        elif away < self.tolerance:
            self.arrived += 1
            self._end(world, "succeeded", "arrives")
        else:
            off = turned(math.atan2(left, ahead))
            turn = max(-self.turn_speed, min(self.turn_speed, 2.5 * off))
            world.drive.command(0.0 if abs(off) > 0.5 else min(self.speed, max(0.3, away)) * (1 - abs(off)), turn)

    def say(self, world):
        """Add feedback on the progress of the goal."""
        if self._goal is not None:
            x, y = self._destination
            self.events.append(
                (self._goal, "feedback", {"distance_remaining": math.hypot(x - world.pose.x, y - world.pose.y)})
            )
        return []

    def news(self):
        """Return descriptions of the ends of journeys."""
        news, self._news = self._news, []
        return news

    def _end(self, world, how, words):
        world.drive.command(0.0, 0.0)
        self.events.append((self._goal, how, {}))
        self._goal = None
        self._news.append(words)
