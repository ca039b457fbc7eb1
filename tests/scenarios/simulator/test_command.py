"""The simulator runs as a program from any folder."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

SIMULATOR = Path(__file__).parents[3] / "examples" / "simulator"


def simulator(folder: Path, *options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(SIMULATOR), *options]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_plays_a_scenario_and_writes_what_was_asked_for(tmp_path: Path) -> None:
    files = ["--record", "record.jsonl", "--log", "log.jsonl", "--picture", "run.svg"]
    done = simulator(tmp_path, "--scenario", "simple_navigation", *files)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1].startswith("the goal was reached after ")
    assert "stop is pressed" in done.stdout
    for name in ("record", "log"):
        assert [json.loads(line) for line in (tmp_path / f"{name}.jsonl").read_text().splitlines()]
    assert (tmp_path / "run.svg").read_text().startswith("<svg")


@pytest.mark.slow
def test_says_that_the_goal_was_not_reached(tmp_path: Path) -> None:
    done = simulator(tmp_path, "--scenario", "simple_navigation", "--until", "2.5")
    assert (done.returncode, done.stdout.splitlines()[-1]) == (1, "the goal was not reached")


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["--scenario", "moon_landing"],
        ["--scenario", "push_ball", "--speed", "0"],
        ["--scenario", "push_ball", "--until", "soon"],
    ],
)
def test_a_wrong_call(options: list[str], tmp_path: Path) -> None:
    done = simulator(tmp_path, *options)
    assert done.returncode == 2
    assert "usage" in done.stderr


def test_says_which_ros_is_missing(tmp_path: Path) -> None:
    command = [sys.executable, "-I", "-c", BLOCKED, str(SIMULATOR.parent)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("error: ROS 2 cannot be used: ")


#: Starts the simulator in a Python without rclpy.
BLOCKED = """
import sys
sys.path.insert(0, sys.argv[1])
sys.modules["rclpy"] = None
from simulator.command import main
sys.exit(main(["--scenario", "push_ball", "--ros", "2"]))
"""
