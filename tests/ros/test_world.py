"""The example's world: plain geometry, the same on every run."""

from __future__ import annotations

import importlib.util
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

SCRIPT = Path(__file__).parents[2] / "examples" / "line_follower" / "world.py"


@pytest.fixture(scope="module")
def world() -> Any:
    specification = importlib.util.spec_from_file_location("world", SCRIPT)
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    sys.modules["world"] = module  # dataclasses look their module up
    specification.loader.exec_module(module)
    return module


def test_the_track_is_closed_and_smooth(world: Any) -> None:
    track = world.Track()
    step = 0.01
    for number in range(int(track.length / step) + 2):
        x, y, heading = track.point(number * step)
        there_x, there_y, _ = track.point((number + 1) * step)
        assert math.hypot(there_x - x, there_y - y) == pytest.approx(step, rel=1e-3)
        assert math.cos(math.atan2(there_y - y, there_x - x) - heading) > 0.999


def test_the_nearest_point_of_the_track(world: Any) -> None:
    track = world.Track()
    for number in range(100):
        way = number * track.length / 100
        x, y, heading = track.point(way)
        for aside in (-0.3, 0.0, 0.3):
            found, near_x, near_y = track.nearest(x - aside * math.sin(heading), y + aside * math.cos(heading))
            assert math.cos((found - way) / track.length * 2 * math.pi) > 0.9999
            assert (near_x, near_y) == pytest.approx((x, y), abs=1e-6)


def test_the_camera_sees_where_the_line_is(world: Any) -> None:
    assert world.World(y=-1.0).correction() == pytest.approx(0.0)
    assert world.World(y=-0.9).correction() == pytest.approx(64.0)  # the line is to the right
    assert world.World(y=-1.1).correction() == pytest.approx(-64.0)
    assert world.World(y=-1.0, heading=math.pi / 4).correction() > 0
    assert world.World(y=0.0).correction() is None
    assert world.World(y=-1.0, line_covered=True).correction() is None


def test_the_lidar_sees_the_obstacle_only(world: Any) -> None:
    there = world.World(y=-1.0, obstacle=world.Obstacle(1.0, -1.0))
    scan = there.scan()
    assert len(scan) == 360
    assert scan[0] == pytest.approx(0.88)
    assert all(math.isinf(each) for each in scan[8:353])
    assert all(math.isfinite(each) for each in scan[:7] + scan[354:])
    turned = world.World(y=-1.0, heading=math.pi / 2, obstacle=world.Obstacle(1.0, -1.0))
    assert turned.scan()[270] == pytest.approx(0.88)
    assert all(math.isinf(each) for each in world.World().scan())


def test_an_obstacle_is_solid(world: Any) -> None:
    there = world.World(y=-1.0, obstacle=world.Obstacle(0.5, -1.0))
    there.command(5.0, 0.0)
    for _ in range(500):
        there.step()
    assert there.gap == pytest.approx(0.0, abs=0.01)
    assert there.gap >= 0
    assert there.travelled == pytest.approx(0.5 - there.contact, abs=0.01)


def test_commands_stay_within_what_motors_can(world: Any) -> None:
    there = world.World()
    there.command(-9.0, 9.0)
    assert (there.linear, there.angular) == (-0.26, 1.82)


def test_a_run_without_ros_is_always_the_same() -> None:
    runs = [subprocess.run([sys.executable, SCRIPT], capture_output=True, text=True, check=True) for _ in range(2)]
    assert runs[0].stdout == runs[1].stdout
    assert len(runs[0].stdout.splitlines()) == 50


def test_happenings_must_be_known(world: Any) -> None:
    simulation = world.Simulation(((0.0, "earthquake"),))
    with pytest.raises(ValueError, match="earthquake"):
        simulation.advance()
