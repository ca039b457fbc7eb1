"""Lines and discs on a plane: what a ray meets, and what is near."""

from __future__ import annotations

import math
from dataclasses import dataclass

_ON_THE_EDGE = 1e-9


@dataclass(frozen=True)
class Pose:
    """A place and a direction."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0

    def towards(self, x, y):
        """How far (x, y) is straight ahead, and how far to the left."""
        dx, dy = x - self.x, y - self.y
        cos, sin = math.cos(self.heading), math.sin(self.heading)
        return dx * cos + dy * sin, dy * cos - dx * sin

    def ahead(self, way, left=0.0):
        """The point so far straight ahead, and so far to the left."""
        cos, sin = math.cos(self.heading), math.sin(self.heading)
        return self.x + way * cos - left * sin, self.y + way * sin + left * cos


@dataclass(frozen=True)
class Segment:
    """A straight wall, without thickness."""

    x1: float
    y1: float
    x2: float
    y2: float

    def nearest(self, x, y):
        """Its point nearest to (x, y)."""
        dx, dy = self.x2 - self.x1, self.y2 - self.y1
        length = dx * dx + dy * dy
        along = ((x - self.x1) * dx + (y - self.y1) * dy) / length if length else 0.0
        along = min(1.0, max(0.0, along))
        return self.x1 + along * dx, self.y1 + along * dy

    def distance(self, x, y):
        """How far (x, y) is from it."""
        near_x, near_y = self.nearest(x, y)
        return math.hypot(near_x - x, near_y - y)


@dataclass
class Disc:
    """Something round: a pillar, a ball, a person's legs."""

    x: float
    y: float
    radius: float

    @property
    def width(self):
        """From edge to edge."""
        return 2 * self.radius

    def distance(self, x, y):
        """How far (x, y) is from its edge; negative inside."""
        return math.hypot(self.x - x, self.y - y) - self.radius


def box(x1, y1, x2, y2):
    """The four walls of an upright rectangle."""
    return path((x1, y1), (x2, y1), (x2, y2), (x1, y2), (x1, y1))


def path(*points):
    """Walls from each point to the next."""
    return [Segment(*start, *end) for start, end in zip(points, points[1:])]  # noqa: B905, RUF007  # old Pythons, too


def turned(angle):
    """The same direction as an angle from -pi (not included) to pi."""
    return math.pi - (math.pi - angle) % (2 * math.pi)


def cast(pose, shapes, rays, reach):
    """The distance that each of so many rays from a pose has to the nearest of the shapes; infinite beyond `reach`.

    Rays are spread evenly, counter-clockwise from straight ahead. Each shape is tried only with the rays between its
    edges.
    """
    seen = [math.inf] * rays
    for shape in shapes:
        meet = _meet_segment if isinstance(shape, Segment) else _meet_disc
        meet(seen, shape, pose)
    return [distance if distance <= reach else math.inf for distance in seen]


def clear(start, end, shapes):
    """Whether one can see from one point to another past these shapes."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    away = math.hypot(dx, dy)
    return cast(Pose(*start, math.atan2(dy, dx)), shapes, 1, away)[0] >= away - _ON_THE_EDGE


def _meet_segment(seen, wall, pose):
    x1, y1, x2, y2 = wall.x1 - pose.x, wall.y1 - pose.y, wall.x2 - pose.x, wall.y2 - pose.y
    area = x1 * y2 - y1 * x2
    if area < 0:
        x1, y1, x2, y2, area = x2, y2, x1, y1, -area
    if area == 0:
        return  # Seen from its end.
    dx, dy = x2 - x1, y2 - y1
    first = math.atan2(y1, x1)
    for ray, angle in _between(len(seen), first - pose.heading, math.atan2(area, x1 * x2 + y1 * y2)):
        across = math.cos(angle + pose.heading) * dy - math.sin(angle + pose.heading) * dx
        if across > 0 and area / across < seen[ray]:
            seen[ray] = area / across


def _meet_disc(seen, disc, pose):
    dx, dy = disc.x - pose.x, disc.y - pose.y
    away = math.hypot(dx, dy)
    if away <= disc.radius:
        return  # From within nothing of it is seen.
    middle, half = math.atan2(dy, dx) - pose.heading, math.asin(disc.radius / away)
    for ray, angle in _between(len(seen), middle - half, 2 * half):
        aside = away * math.sin(angle - middle)
        root = disc.radius**2 - aside**2
        distance = away * math.cos(angle - middle) - math.sqrt(max(0.0, root))
        seen[ray] = min(seen[ray], distance)


def _between(rays, first, span):
    """The rays from an angle on, over a span, each with its angle."""
    step = 2 * math.pi / rays
    first = first % (2 * math.pi)
    start = math.ceil((first - _ON_THE_EDGE) / step)
    stop = math.floor((first + span + _ON_THE_EDGE) / step)
    return [(number % rays, number * step) for number in range(start, stop + 1)]
