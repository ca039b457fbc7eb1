"""What is in a field: a satellite receiver, a radio, a tank, a stick, a boom with three sections, and a driver."""

from __future__ import annotations

import math

from .devices import BOOLEAN, EMPTY, NUMBER, TWIST, Device, as_pose, header
from .geometry import turned
from .world import STEP, Area

ACTION = "/navigate_to_pose"
SECTIONS = {"left": 1.0, "middle": 0.0, "right": -1.0}
#: The map of what has been sprayed: squares of this size.
CELL = 1.0


class Receiver(Device):
    """Says where the sprayer is in the field."""

    says = {"/odom": "nav_msgs/Odometry"}  # noqa: RUF012

    def __init__(self, noise):
        """`noise` gives an error in metres."""
        self._noise = noise
        self.in_view = True

    def say(self, world):
        """A pose in the frame of the field, and the speed; nothing where no satellites are in view."""
        if not self.in_view:
            return []
        pose = as_pose(world.pose)
        pose["position"] = {axis: place + self._noise() for axis, place in pose["position"].items()}
        linear, angular = world.drive.speed
        twist = {"linear": {"x": linear}, "angular": {"z": angular}}
        data = {"header": header(world, "field"), "pose": {"pose": pose}, "twist": {"twist": twist}}
        return [("/odom", data)]


class Radio(Device):
    """Beats as long as it is in reach."""

    period = 0.2
    says = {"/radio/heartbeat": EMPTY}  # noqa: RUF012

    def __init__(self):
        self.in_reach = True

    def say(self, world):
        """A beat."""
        del world
        return [("/radio/heartbeat", {})] if self.in_reach else []


class Remote(Device):
    """A switch between driving by hand and by itself, and a stick; a stick that is let go says nothing."""

    says = {"/mode/automatic": BOOLEAN, "/stick": TWIST}  # noqa: RUF012

    def __init__(self):
        self.automatic = False
        #: The velocity that the stick asks for: linear, angular; None: it is let go.
        self.stick = None

    def say(self, world):
        """The switch, and the stick where it is held."""
        del world
        said = [("/mode/automatic", {"data": self.automatic})]
        if self.stick is not None:
            linear, angular = self.stick
            said.append(("/stick", {"linear": {"x": linear}, "angular": {"z": angular}}))
        return said


class Boom(Device):
    """Three sections side by side, each with a valve, a tank for all of them, and a map of what has been sprayed.

    A section asks the map about the ground a little ahead of it, so that its valve is right when it gets there.
    """

    says = {  # noqa: RUF012
        **{f"/nozzles/{section}/sprayed": BOOLEAN for section in SECTIONS},
        "/tank/level": NUMBER,
    }
    hears = {f"/nozzles/{section}/valve": BOOLEAN for section in SECTIONS}  # noqa: RUF012
    ahead, behind = 0.3, -0.4
    #: What an open section takes from the tank in a second.
    flow = 0.001

    def __init__(self):
        self.level = 0.5
        self.open = set()
        self.sprayed = set()
        #: How often a square was sprayed that had been sprayed before.
        self.twice = 0
        self._under = dict.fromkeys(SECTIONS)

    def hear(self, world, topic, data):
        """Turns a valve."""
        del world
        section = topic.split("/")[2]
        (self.open.add if data["data"] else self.open.discard)(section)

    def act(self, world):
        """Sprays the ground below the open sections, while there is something in the tank."""
        for section in SECTIONS:
            cell = self._cell(world, section, self.behind)
            if cell != self._under[section]:
                self._under[section] = cell
                if section in self.open and self.level > 0.0:
                    self.twice += cell in self.sprayed
                    self.sprayed.add(cell)
        self.level = max(0.0, self.level - self.flow * STEP * len(self.open))

    def say(self, world):
        """What has been sprayed, and the level."""
        said = [
            (f"/nozzles/{section}/sprayed", {"data": self._cell(world, section, self.ahead) in self.sprayed})
            for section in SECTIONS
        ]
        return [*said, ("/tank/level", {"data": self.level})]

    def areas(self):
        """What has been sprayed: rows of squares."""
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
    """Drives straight to a pose, whatever the way is like; `trouble`: it gets stuck, and gives up.

    `events` is filled with what happens to goals, as that of `Navigation`.
    """

    serves = {ACTION: "nav2_msgs/NavigateToPose"}  # noqa: RUF012
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
        """Whether it has a goal."""
        return self._goal is not None

    def accept(self, world, goal, data):
        """Sets off; a newer goal ends the old one."""
        if self._goal is not None:
            self._end(world, "aborted", "gives way to a newer goal")
        position = data["pose"]["pose"]["position"]
        self._goal, self._destination = goal, (position["x"], position["y"])
        self._news.append("sets off")
        return True

    def cancel(self, world, goal):
        """Ends a journey; whether it was under way."""
        if goal != self._goal:
            return False
        self._end(world, "canceled", "the journey is cancelled")
        return True

    def act(self, world):
        """Drives on."""
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
        """Tells how far it is, to whoever set the goal."""
        if self._goal is not None:
            x, y = self._destination
            self.events.append(
                (self._goal, "feedback", {"distance_remaining": math.hypot(x - world.pose.x, y - world.pose.y)})
            )
        return []

    def news(self):
        """What became of journeys."""
        news, self._news = self._news, []
        return news

    def _end(self, world, how, words):
        world.drive.command(0.0, 0.0)
        self.events.append((self._goal, how, {}))
        self._goal = None
        self._news.append(words)
