"""Generated nodes of ROS 2 against the wheels' own headers: names of messages, their fields, and of the supervisor.

The wheels have no rclcpp. Its headers are empty files here, so that only errors about these names count.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

import robosc
from robosc.language import configuration as config
from tests.m2t.conftest import models

pytestmark = pytest.mark.build

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
NAV2 = HERE.parents[1] / "ros" / "interfaces" / "ros2" / "nav2_msgs"
#: Headers that no wheel has. Headers that include one of them can't be compiled here.
WITHOUT_WHEEL = {
    "rclcpp/rclcpp.hpp",
    "rclcpp_action/rclcpp_action.hpp",
    "rclcpp_components/register_node_macro.hpp",
    "rclcpp_lifecycle/lifecycle_node.hpp",
    "rclcpp_lifecycle/lifecycle_publisher.hpp",
}
#: Functions with one wrong name of each kind, which the compiler has to find.
WRONG = """
double field(const geometry_msgs::msg::Point& message) {{ return message.none; }}
void function({prefix}_supervisor* supervisor) {{ {prefix}_none(supervisor); }}
"""


def wheels(name: str) -> Path:
    """Return the environment of the wheels of ROS 2; without it, skip the test."""
    environment = ROOT / name
    if not (environment / "include" / "rcl").exists():
        pytest.skip(f"no wheels of ROS 2 in {name}: see run-tests")
    if shutil.which("clang++") is None:
        pytest.skip("no clang++")
    return environment


def unknown_names(source: Path, prefix: str, include: list[Path]) -> list[str]:
    """Return the unknown headers, the unknown members of message types, and the unknown names of the supervisor."""
    command = ["clang++", "-std=c++20", "-fsyntax-only", "-ferror-limit=0", *(f"-isystem{path}" for path in include)]
    done = subprocess.run([*command, source], capture_output=True, text=True, check=False)
    assert "undeclared identifier 'rclcpp'" in done.stderr
    kinds = r"'(\S+)' file not found", r"no member named '(\w+)' in '\w+::(?:msg|srv|action)::"
    kinds += (
        r"no member named '(\w+)' in namespace '\w+_(?:msgs|srvs)",
        rf"use of undeclared identifier '({prefix}_\w+)'",
    )
    kinds += rf"unknown type name '({prefix}_\w+)'", rf"no member named '(\w+)' in '{prefix}_supervisor"
    return [name for kind in kinds for name in re.findall(f"error: {kind}", done.stderr)]


@pytest.mark.parametrize(("robot", "environment"), [("courier", ".venv-ros2"), ("porter", ".venv-ros2-kilted")])
def test_names_of_messages_and_of_the_supervisor(robot: str, environment: str, tmp_path: Path) -> None:
    prefix = wheels(environment)
    for header in WITHOUT_WHEEL:
        assert not (prefix / "include" / header.partition("/")[0]).exists()
        (tmp_path / "empty" / header).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "empty" / header).touch()
    command = [prefix / "bin" / "python", HERE / "message_headers.py", NAV2, tmp_path / "nav2"]
    subprocess.run(command, check=True, capture_output=True)
    settings = config.read(HERE / f"{'controller' if robot == 'courier' else robot}-config.json")
    for path, text in robosc.generate("ros2", models(robot), settings).items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    (source,) = (tmp_path / "src").glob("*.cpp")
    with source.open("a", encoding="utf-8") as file:
        file.write(WRONG.format(prefix=robot))
    include = [tmp_path / "empty", tmp_path / "nav2", *sorted((prefix / "include").iterdir()), tmp_path / "include"]
    assert unknown_names(source, robot, include) == ["none", f"{robot}_none"]
