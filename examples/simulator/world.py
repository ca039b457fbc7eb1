"""The plane and its contents. One step of time moves all of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from .drive import ACCELERATION, MAX_LINEAR, Drive
from .geometry import Disc, Pose, Segment

STEP = 0.02
ROBOT_RADIUS = 0.14
#: The robot's flat front, as wide as the robot. It holds a ball that it pushes.
FRONT = 0.14
#: The deceleration of a rolling ball in m/s².
ROLLING = 0.4


@dataclass
class Ball(Disc):
    """A ball below the lidar's height. It rolls when pushed, and a little further."""

    vx: float = 0.0
    vy: float = 0.0


@dataclass
class Person(Disc):
    """A person who walks from point to point."""

    speed: float = 0.0
    way: list = field(default_factory=list)

    def walk(self, speed, *points):
        """Walk to each of the points, one after the other."""
        self.speed, self.way = speed, list(points)


@dataclass
class Sight:
    """A thing that a camera's software can name, and its certainty."""

    name: str
    x: float
    y: float
    width: float
    certainty: float = 1.0


@dataclass
class Area:
    """A marked area of the floor: the corners of a rectangle, its name, its color in a picture."""

    name: str
    x1: float
    y1: float
    x2: float
    y2: float
    colour: str


@dataclass
class World:
    """Walls, pillars, a line on the floor, a ball and its goal, a person, visible things, and the robot.

    Walls (segments), pillars (discs) and the person are solid, and visible to the lidar. The ball is solid but below
    the lidar. `touched` counts the steps in which a solid thing held the robot.
    """

    start: Pose
    walls: list[Segment] = field(default_factory=list)
    pillars: list[Disc] = field(default_factory=list)
    #: Points of the yellow line, close together, in the driving direction.
    line: list[tuple[float, float]] = field(default_factory=list)
    line_covered: bool = False
    ball: Ball | None = None
    #: The goal's ranges: x from, y from, x to, y to. Its back wall is at the last x.
    goal: tuple[float, float, float, float] | None = None
    person: Person | None = None
    sights: list[Sight] = field(default_factory=list)
    areas: list[Area] = field(default_factory=list)
    #: The greatest speed and acceleration of the robot's wheels.
    fastest: float = MAX_LINEAR
    acceleration: float = ACCELERATION
    steps: int = 0
    travelled: float = 0.0
    touched: int = 0

    def __post_init__(self):
        self.drive = Drive(self.start, self.fastest, self.acceleration)

    @property
    def time(self):
        """Seconds since the start."""
        return self.steps * STEP

    @property
    def pose(self):
        """The robot's pose."""
        return self.drive.pose

    @property
    def seen_by_lidar(self):
        """All things as high as the lidar."""
        return [*self.walls, *self.pillars, *([self.person] if self.person else [])]

    @property
    def gap(self):
        """The free distance between the robot and the nearest thing as high as the lidar. Infinite without one."""
        return min((shape.distance(self.pose.x, self.pose.y) for shape in self.seen_by_lidar), default=math.inf) - (
            ROBOT_RADIUS
        )

    @property
    def off_line(self):
        """The robot's distance to the line."""
        return min(math.hypot(x - self.pose.x, y - self.pose.y) for x, y in self.line)

    @property
    def ball_in_goal(self):
        """Whether the whole ball is in the goal."""
        x1, y1, x2, y2 = self.goal
        radius = self.ball.radius
        return x1 + radius <= self.ball.x <= x2 and y1 + radius <= self.ball.y <= y2 - radius

    def step(self):
        """Advance the time. The robot does not enter solid things: it stands there, even if its wheels turn."""
        self.steps += 1
        before, after = self.pose, self.drive.step(STEP)
        if self._free(before, after):
            self.drive.pose = after
            self.travelled += math.hypot(after.x - before.x, after.y - before.y)
        else:
            self.touched += 1
        if self.ball:
            self._roll(self.ball)
        if self.person:
            self._walk(self.person)

    def _free(self, before, after):
        """Return whether the robot may move there: no closer to a touched thing, and not against a blocked ball."""
        for shape in self.seen_by_lidar:
            there = shape.distance(after.x, after.y)
            if there < ROBOT_RADIUS and there < shape.distance(before.x, before.y):
                return False
        if self.ball:
            pushed = self._pushed(after, self.ball.x, self.ball.y)
            return math.dist(pushed, self._off_walls(*pushed)) < 1e-9
        return True

    def _roll(self, ball):
        speed = math.hypot(ball.vx, ball.vy)
        kept = max(0.0, speed - ROLLING * STEP) / speed if speed else 0.0
        x, y = ball.x + ball.vx * kept * STEP, ball.y + ball.vy * kept * STEP
        x, y = self._off_walls(*self._pushed(self.pose, x, y))
        ball.vx, ball.vy = (x - ball.x) / STEP, (y - ball.y) / STEP
        ball.x, ball.y = x, y

    def _pushed(self, pose, x, y):
        """Return the place of a ball from (x, y) for a pose of the robot: before its front, or beside it."""
        touching = FRONT + self.ball.radius
        ahead, left = pose.towards(x, y)
        away = math.hypot(ahead, left)
        if 0 < ahead < touching and abs(left) < ROBOT_RADIUS:
            return pose.ahead(touching, left)
        if 0 < away < ROBOT_RADIUS + self.ball.radius:
            out = (ROBOT_RADIUS + self.ball.radius) / away
            return pose.ahead(ahead * out, left * out)
        return x, y

    def _off_walls(self, x, y):
        """Return the place of a ball at (x, y) outside of walls."""
        for wall in self.walls:
            near_x, near_y = wall.nearest(x, y)
            gap = math.hypot(x - near_x, y - near_y)
            if 0 < gap < self.ball.radius:
                out = self.ball.radius / gap
                x, y = near_x + (x - near_x) * out, near_y + (y - near_y) * out
        return x, y

    @staticmethod
    def _walk(person):
        left = person.speed * STEP
        while person.way and left > 0:
            x, y = person.way[0]
            away = math.hypot(x - person.x, y - person.y)
            if away <= left:
                person.x, person.y = person.way.pop(0)
            else:
                person.x += (x - person.x) / away * left
                person.y += (y - person.y) / away * left
            left -= away
