"""`robosc run`: its messages if it cannot start."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[3] / "examples"
MODEL = EXAMPLES / "line_follower" / "line_follower.rscd"


def run(*arguments: str | Path, blocked: str = "") -> subprocess.CompletedProcess[str]:
    """Run the command in a Python that lacks a module."""
    code = "import sys; sys.modules[sys.argv.pop(1)] = None; from robosc.tools.cli import run; run()"
    return subprocess.run(
        [sys.executable, "-c", code, blocked, "run", *arguments], capture_output=True, text=True, check=False
    )


def test_a_node_of_ros_1_is_generated() -> None:
    done = run(MODEL, "--ros1")
    assert done.returncode == 2
    assert "for ROS 1, generate a node with `transform --to ros1`" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("options", [[], ["--ros2"]])
def test_names_the_repair_where_ros_is_missing(options: list[str]) -> None:
    done = run(MODEL, *options, blocked="rclpy")
    assert done.returncode == 2
    assert "this Python has no ROS 2" in done.stderr
    assert "pip install -e '.[ros2]' in robosc's repository" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_lifecycle_is_not_there(tmp_path: Path) -> None:
    configuration = tmp_path / "config.json"
    configuration.write_text('{"lifecycle": true, "onShutdown": ["halt"]}')
    done = run(MODEL, "--config", configuration, blocked="rclpy")
    assert "config.json:1:2: warning" in done.stdout
    assert '"lifecycle" has no effect on `run`: its node is always active' in done.stdout


def test_an_error_in_the_model_comes_first(tmp_path: Path) -> None:
    broken = tmp_path / "broken.rscd"
    broken.write_text("robot Broken { component A { behaviour { } } }")
    done = run(broken, "--ros2", blocked="rclpy")
    assert done.returncode == 1
    assert "ROS 2" not in done.stderr
