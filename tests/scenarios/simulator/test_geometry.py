"""Rays, edges and directions agree with cases solved by hand."""

from __future__ import annotations

import math

import pytest

from examples.simulator.geometry import Disc, Pose, Segment, box, cast, clear, path, turned

HERE = Pose(0.0, 0.0, 0.0)


def test_a_wall_ahead() -> None:
    seen = cast(HERE, [Segment(2.0, -1.0, 2.0, 1.0)], 360, 10.0)
    assert seen[0] == pytest.approx(2.0)
    # The ray at 20 degrees is longer by 1 / cos 20; the wall ends at atan(1/2), which is 26.57 degrees.
    assert seen[20] == pytest.approx(2.0 / math.cos(math.radians(20)))
    assert seen[340] == pytest.approx(seen[20])
    assert [ray for ray, away in enumerate(seen) if away < math.inf] == [*range(27), *range(334, 360)]


@pytest.mark.parametrize("heading", [0.0, 90.0, -90.0, 180.0, 45.0, 359.0, -725.0])
def test_in_the_middle_of_a_square_room(heading: float) -> None:
    seen = cast(Pose(0.0, 0.0, math.radians(heading)), box(-1.0, -1.0, 1.0, 1.0), 360, 10.0)
    for ray, away in enumerate(seen):
        angle = math.radians(heading + ray)
        assert away == pytest.approx(1.0 / max(abs(math.cos(angle)), abs(math.sin(angle))))


def test_a_disc() -> None:
    seen = cast(Pose(1.0, 0.0, math.pi / 2), [Disc(1.0, 3.0, 0.5)], 360, 10.0)
    assert seen[0] == pytest.approx(2.5)
    # From 3 m, a radius of 0.5 m extends asin(1/6), which is 9.59 degrees, to each side.
    assert [ray for ray, away in enumerate(seen) if away < math.inf] == [*range(10), *range(351, 360)]
    # At 5 degrees the distance is 3 cos a - sqrt(0.5² - (3 sin a)²).
    angle = math.radians(5)
    expected = 3 * math.cos(angle) - math.sqrt(0.25 - (3 * math.sin(angle)) ** 2)
    assert seen[5] == pytest.approx(expected)


def test_the_nearest_thing_hides_what_is_behind_it() -> None:
    seen = cast(HERE, [Segment(2.0, -1.0, 2.0, 1.0), Disc(1.0, 0.0, 0.1)], 360, 10.0)
    assert seen[0] == pytest.approx(0.9)
    assert seen[8] == pytest.approx(2.0 / math.cos(math.radians(8)))


def test_what_is_out_of_reach_or_edge_on_is_not_seen() -> None:
    assert cast(HERE, [Segment(4.0, -1.0, 4.0, 1.0)], 4, 3.5) == [math.inf] * 4
    assert cast(HERE, [Segment(1.0, 0.0, 2.0, 0.0)], 4, 3.5) == [math.inf] * 4
    assert cast(HERE, [], 4, 3.5) == [math.inf] * 4


def test_many_random_walls_are_seen_as_by_trying_every_ray() -> None:
    for number in range(60):
        wall = Segment(*(3 * math.sin(number * step + step) for step in (1.3, 2.7, 4.1, 5.9)))
        pose = Pose(math.sin(number * 7.7), math.cos(number * 3.3), number * 0.7)
        for ray, away in enumerate(cast(pose, [wall], 72, 100.0)):
            assert away == pytest.approx(by_solving(pose, wall, math.radians(5 * ray)), rel=1e-6), (number, ray)


def by_solving(pose: Pose, wall: Segment, angle: float) -> float:
    """Return the distance from a ray's origin to a wall, by Cramer's rule on both as a point and a direction."""
    ux, uy = math.cos(pose.heading + angle), math.sin(pose.heading + angle)
    dx, dy = wall.x2 - wall.x1, wall.y2 - wall.y1
    determinant = dx * uy - dy * ux
    rx, ry = wall.x1 - pose.x, wall.y1 - pose.y
    away, along = (dx * ry - dy * rx) / determinant, (ux * ry - uy * rx) / determinant
    return away if away >= 0 and 0 <= along <= 1 else math.inf


def test_clear_sight() -> None:
    wall = Segment(1.0, -1.0, 1.0, 1.0)
    assert not clear((0.0, 0.0), (2.0, 0.0), [wall])
    assert clear((0.0, 0.0), (0.5, 0.0), [wall])
    assert clear((0.0, 0.0), (2.0, 3.0), [wall])
    assert clear((0.0, 0.0), (-2.0, 0.0), [wall])


def test_distances() -> None:
    wall = Segment(0.0, 0.0, 2.0, 0.0)
    assert wall.distance(1.0, 3.0) == pytest.approx(3.0)
    assert wall.distance(5.0, 4.0) == pytest.approx(5.0)
    assert Segment(1.0, 1.0, 1.0, 1.0).distance(4.0, 5.0) == pytest.approx(5.0)
    assert Disc(0.0, 0.0, 1.0).distance(3.0, 4.0) == pytest.approx(4.0)
    assert Disc(0.0, 0.0, 1.0).distance(0.5, 0.0) == pytest.approx(-0.5)


def test_walls_in_a_row() -> None:
    assert path((0, 0), (1, 0), (1, 2)) == [Segment(0, 0, 1, 0), Segment(1, 0, 1, 2)]


def test_directions() -> None:
    assert turned(0.0) == 0.0
    assert turned(math.pi) == pytest.approx(math.pi)
    assert turned(-math.pi) == pytest.approx(math.pi)
    assert turned(5 * math.pi / 2) == pytest.approx(math.pi / 2)


def test_ahead_and_to_the_left() -> None:
    pose = Pose(1.0, 2.0, math.pi / 2)
    assert pose.ahead(3.0, 1.0) == pytest.approx((0.0, 5.0))
    assert pose.towards(0.0, 5.0) == pytest.approx((3.0, 1.0))
