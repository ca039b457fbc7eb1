"""`robosc interfaces build` builds modules for the ROS 2 wheels from packages that no registry offers."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main
from tests.ros.running import PROJECT, Runner

if TYPE_CHECKING:
    from pathlib import Path

#: Serializes and deserializes a message with the middleware, and compares the results.
ROUND_TRIP = """
from rclpy.serialization import deserialize_message, serialize_message
from alpha_msgs.msg import Track
from zeta_msgs.msg import Mark
sent = Track(marks=[Mark(number=7)])
sent.header.frame_id = "map"
assert deserialize_message(serialize_message(sent), Track) == sent
print(sent.marks[0].number)
"""


@pytest.fixture
def packages(tmp_path: Path) -> Path:
    """Two packages: the first one by name uses a type of the second one and a type of ROS."""
    folder = tmp_path / "packages"
    write(folder / "alpha_msgs/msg/Track.msg", "std_msgs/Header header\nzeta_msgs/Mark[] marks\n")
    write(folder / "zeta_msgs/msg/Mark.msg", "int32 number\n")
    return folder


def write(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True)
    file.write_text(text, encoding="utf-8")


def robosc(runner: Runner, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """Run the tool in the Python of the wheels."""
    command = [runner.ros.python, "-m", "robosc", *arguments]
    environment = {**runner.ros.environment, "PYTHONPATH": str(PROJECT)}
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.build
def test_packages_are_built_in_their_order(run_ros2: Runner, packages: Path, tmp_path: Path) -> None:
    out = tmp_path / "modules"
    done = robosc(run_ros2, "interfaces", "build", packages, "-o", out)
    assert (done.returncode, done.stdout) == (0, "zeta_msgs\nalpha_msgs\n"), done.stderr
    assert done.stderr == f"{out}: 2 packages; export PYTHONPATH={out}\n"
    assert sorted(path.name for path in out.iterdir()) == ["alpha_msgs", "zeta_msgs"]
    environment = {**run_ros2.ros.environment, "PYTHONPATH": str(out)}
    command = [run_ros2.ros.python, "-c", ROUND_TRIP]
    told = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert told.stdout == "7\n", told.stderr


@pytest.mark.parametrize(
    ("field", "said"),
    [
        ("int3 number", "zeta_msgs/srv/Ask.srv: "),
        ("beta_msgs/Mark mark", "beta_msgs, which is neither installed nor in the call"),
        ("alpha_msgs/Track track", "of each other: alpha_msgs, zeta_msgs"),
    ],
)
def test_what_keeps_a_package_from_being_built(
    run_ros2: Runner, packages: Path, tmp_path: Path, field: str, said: str
) -> None:
    write(packages / "zeta_msgs/srv/Ask.srv", f"{field}\n---\n")
    out = tmp_path / "modules"
    done = robosc(run_ros2, "interfaces", "build", packages, "-o", out)
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert [*out.iterdir()] == []


def test_a_folder_without_types(run_ros2: Runner, tmp_path: Path) -> None:
    done = robosc(run_ros2, "interfaces", "build", tmp_path)
    assert done.returncode == 2
    assert "no package has msg/*.msg" in done.stderr


def test_a_node_without_modules_names_the_command(run_ros2: Runner) -> None:
    done = robosc(run_ros2, "run", PROJECT / "examples/person_follower/person_follower.rscd", "--ros2")
    assert done.returncode == 2
    assert "bboxes_ex_msgs/BoundingBoxes: the ROS package bboxes_ex_msgs is not built for Python here" in done.stderr
    assert "`robosc interfaces build FOLDER -o OUT`" in done.stderr


def test_another_python_is_told_of_the_wheels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "robosc.run.runtime.ros2.interfaces", raising=False)
    monkeypatch.setitem(sys.modules, "numpy", None)
    answer = CliRunner().invoke(main, ["interfaces", "build", str(tmp_path)])
    assert answer.exit_code == 2
    assert "has no numpy" in answer.output
    assert "pip install 'robosc[ros2]'" in answer.output
