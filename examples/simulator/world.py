"""The plane and everything on it; one step of time moves all of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from .drive import ACCELERATION, MAX_LINEAR, Drive
from .geometry import Disc, Pose, Segment

STEP = 0.02
ROBOT_RADIUS = 0.14
#: The robot's flat front, as wide as the robot: it holds a ball that it pushes.
FRONT = 0.14
#: How fast a rolling ball gets slower, in m/s².
ROLLING = 0.4


@dataclass
class Ball(Disc):
    """A ball: lower than the lidar, it rolls when pushed and on for a little while."""

    vx: float = 0.0
    vy: float = 0.0


@dataclass
class Person(Disc):
    """Somebody who walks from point to point."""

    speed: float = 0.0
    way: list = field(default_factory=list)

    def walk(self, speed, *points):
        """Sets off: to each of the points, one after the other."""
        self.speed, self.way = speed, list(points)


@dataclass
class Sight:
    """Something that a camera's software has a name for, and how sure it is."""

    name: str
    x: float
    y: float
    width: float
    certainty: float = 1.0


@dataclass
class Area:
    """A part of the floor that means something: the corners of a rectangle, its name, its colour in a picture."""

    name: str
    x1: float
    y1: float
    x2: float
    y2: float
    colour: str


@dataclass
class World:
    """Walls, pillars, a line on the floor, a ball and its goal, a person, things to be seen, and the robot.

    Walls (segments) and pillars (discs) are solid, and the lidar sees them; so is the person. The ball is solid but
    below the lidar. `touched` counts the steps in which the robot was held by something solid.
    """

    start: Pose
    walls: list[Segment] = field(default_factory=list)
    pillars: list[Disc] = field(default_factory=list)
    #: Points of the yellow line, close together, in the order in which they are followed.
    line: list[tuple[float, float]] = field(default_factory=list)
    line_covered: bool = False
    ball: Ball | None = None
    #: Where the goal is: x from, y from, x to, y to. Its back wall is at the last x.
    goal: tuple[float, float, float, float] | None = None
    person: Person | None = None
    sights: list[Sight] = field(default_factory=list)
    areas: list[Area] = field(default_factory=list)
    #: How fast the robot's wheels may roll, and how fast that changes.
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
        """Where the robot is."""
        return self.drive.pose

    @property
    def seen_by_lidar(self):
        """Everything as high as the lidar."""
        return [*self.walls, *self.pillars, *([self.person] if self.person else [])]

    @property
    def gap(self):
        """The free distance between the robot and the nearest thing as high as the lidar; infinite without one."""
        return min((shape.distance(self.pose.x, self.pose.y) for shape in self.seen_by_lidar), default=math.inf) - (
            ROBOT_RADIUS
        )

    @property
    def off_line(self):
        """How far the robot is from the line."""
        return min(math.hypot(x - self.pose.x, y - self.pose.y) for x, y in self.line)

    @property
    def ball_in_goal(self):
        """Whether the whole ball is in the goal."""
        x1, y1, x2, y2 = self.goal
        radius = self.ball.radius
        return x1 + radius <= self.ball.x <= x2 and y1 + radius <= self.ball.y <= y2 - radius

    def step(self):
        """Lets time pass. The robot does not enter what is solid: it stands there, whatever its wheels do."""
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
        """Whether the robot may go there: no nearer to what it already touches, and the ball gives way."""
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
        """Where the ball is when the robot is at a pose and the ball was at (x, y): before its front, or beside it."""
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
        """Where the ball is that would be at (x, y): not inside a wall."""
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
