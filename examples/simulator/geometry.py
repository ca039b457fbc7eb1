"""Lines and discs on a plane: intersections with rays, and distances."""

from __future__ import annotations

import math
from dataclasses import dataclass

_ON_THE_EDGE = 1e-9


@dataclass(frozen=True)
class Pose:
    """A position and a heading."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0

    def towards(self, x, y):
        """Return the distances of (x, y) straight ahead and to the left."""
        dx, dy = x - self.x, y - self.y
        cos, sin = math.cos(self.heading), math.sin(self.heading)
        return dx * cos + dy * sin, dy * cos - dx * sin

    def ahead(self, way, left=0.0):
        """Return the point at these distances straight ahead and to the left."""
        cos, sin = math.cos(self.heading), math.sin(self.heading)
        return self.x + way * cos - left * sin, self.y + way * sin + left * cos


@dataclass(frozen=True)
class Segment:
    """A straight wall without thickness."""

    x1: float
    y1: float
    x2: float
    y2: float

    def nearest(self, x, y):
        """Return the wall's nearest point to (x, y)."""
        dx, dy = self.x2 - self.x1, self.y2 - self.y1
        length = dx * dx + dy * dy
        along = ((x - self.x1) * dx + (y - self.y1) * dy) / length if length else 0.0
        along = min(1.0, max(0.0, along))
        return self.x1 + along * dx, self.y1 + along * dy

    def distance(self, x, y):
        """Return the distance of (x, y) to the wall."""
        near_x, near_y = self.nearest(x, y)
        return math.hypot(near_x - x, near_y - y)


@dataclass
class Disc:
    """A round thing: a pillar, a ball, a person's legs."""

    x: float
    y: float
    radius: float

    @property
    def width(self):
        """The diameter."""
        return 2 * self.radius

    def distance(self, x, y):
        """Return the distance of (x, y) to the edge. Negative inside."""
        return math.hypot(self.x - x, self.y - y) - self.radius


def box(x1, y1, x2, y2):
    """Return the four walls of an upright rectangle."""
    return path((x1, y1), (x2, y1), (x2, y2), (x1, y2), (x1, y1))


def path(*points):
    """Return walls from each point to the next."""
    return [Segment(*start, *end) for start, end in zip(points, points[1:])]  # noqa: B905, RUF007  # old Pythons


def turned(angle):
    """Return an angle of the same direction from -pi (not included) to pi."""
    return math.pi - (math.pi - angle) % (2 * math.pi)


def cast(pose, shapes, rays, reach):
    """Return the distances from a pose to the nearest shape along each ray. Infinite beyond `reach`.

    The rays are spread evenly, counter-clockwise from straight ahead. Only the rays between the edges of a shape are
    tested with it.
    """
    seen = [math.inf] * rays
    for shape in shapes:
        meet = _meet_segment if isinstance(shape, Segment) else _meet_disc
        meet(seen, shape, pose)
    return [distance if distance <= reach else math.inf for distance in seen]


def clear(start, end, shapes):
    """Return whether no shape hides one point from the other."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    away = math.hypot(dx, dy)
    return cast(Pose(*start, math.atan2(dy, dx)), shapes, 1, away)[0] >= away - _ON_THE_EDGE


def _meet_segment(seen, wall, pose):
    x1, y1, x2, y2 = wall.x1 - pose.x, wall.y1 - pose.y, wall.x2 - pose.x, wall.y2 - pose.y
    area = x1 * y2 - y1 * x2
    if area < 0:
        x1, y1, x2, y2, area = x2, y2, x1, y1, -area
    if area == 0:
        return  # The wall is seen from its end.
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
        return  # A disc is invisible from within.
    middle, half = math.atan2(dy, dx) - pose.heading, math.asin(disc.radius / away)
    for ray, angle in _between(len(seen), middle - half, 2 * half):
        aside = away * math.sin(angle - middle)
        root = disc.radius**2 - aside**2
        distance = away * math.cos(angle - middle) - math.sqrt(max(0.0, root))
        seen[ray] = min(seen[ray], distance)


def _between(rays, first, span):
    """Return the rays in a span from the angle `first` on, each with its angle."""
    step = 2 * math.pi / rays
    first = first % (2 * math.pi)
    start = math.ceil((first - _ON_THE_EDGE) / step)
    stop = math.floor((first + span + _ON_THE_EDGE) / step)
    return [(number % rays, number * step) for number in range(start, stop + 1)]
