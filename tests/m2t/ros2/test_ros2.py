"""The ROS 2 package of the courier, file by file; that it builds and works, `tests/ros` shows."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest
from catkin_pkg.package import parse_package_string

import robosc
from robosc.config import Configuration

if TYPE_CHECKING:
    from collections.abc import Callable

FOLDER = Path(__file__).parent / "courier"
ENGINE = ("src/courier_supervisor.c", "src/courier_supervisor.h")


@pytest.fixture(scope="module")
def files(courier: robosc.Models, settings: Configuration) -> dict[str, str]:
    return robosc.generate("ros2", courier, settings)


def test_every_file(files: dict[str, str], golden: Callable[[Path, str], None]) -> None:
    # The engine in C has goldens of its own.
    assert set(ENGINE) < set(files)
    for path, text in files.items():
        if path not in ENGINE:
            golden(FOLDER / path, text)
    kept = {path.relative_to(FOLDER).as_posix() for path in FOLDER.rglob("*") if path.is_file()}
    assert kept == set(files) - set(ENGINE)


def test_package_lists_what_is_used(files: dict[str, str]) -> None:
    package = parse_package_string(files["package.xml"])
    package.validate()
    assert [each.name for each in package.buildtool_depends] == ["ament_cmake"]
    used = {"geometry_msgs", "rclcpp", "rclcpp_components", "sensor_msgs", "std_msgs"}
    assert {each.name for each in package.build_depends} == used
    assert {each.name for each in package.exec_depends} == used | {"launch", "launch_ros"}
    described = ElementTree.fromstring(files["package.xml"]).findtext("description")  # noqa: S314  # our own text
    assert described == "Carries <data> & more: ]]> -->"
    assert package.maintainers[0].name == "A. O'Tester <&>"


def test_launch_file_is_python(files: dict[str, str]) -> None:
    (function,) = [
        each
        for each in ast.parse(files["launch/courier_controller.launch.py"]).body
        if isinstance(each, ast.FunctionDef)
    ]
    assert function.name == "generate_launch_description"


@pytest.mark.parametrize(
    ("quality", "expected"),
    [
        ("{}", "rclcpp::SensorDataQoS()"),
        ('{"scan": {"depth": 3}}', "rclcpp::SensorDataQoS().keep_last(3)"),
        ('{"/scan": {"reliability": "reliable"}}', "rclcpp::SensorDataQoS().reliable()"),
        (
            '{"scan": {"reliability": "best_effort", "durability": "transient_local", "depth": 1}}',
            "rclcpp::SensorDataQoS().keep_last(1).best_effort().transient_local()",
        ),
        ('{"scan": {"durability": "volatile"}}', "rclcpp::SensorDataQoS().durability_volatile()"),
        ('{"target": {"depth": 1}}', "rclcpp::SensorDataQoS()"),
    ],
)
def test_quality_of_service(courier: robosc.Models, quality: str, expected: str) -> None:
    settings = Configuration.model_validate_json(f'{{"qos": {quality}}}')
    node = robosc.generate("ros2", courier, settings)["src/courier_controller_node.cpp"]
    assert f'"/scan", {expected},' in " ".join(node.split())
    assert '"count", rclcpp::QoS(10),' in " ".join(node.split())


def test_leaves_out_what_is_not_asked_for(courier: robosc.Models) -> None:
    silent = robosc.generate("ros2", courier, Configuration(publish_state_information=False))
    assert "include/courier_controller/definition.hpp" not in silent
    assert "~/" not in silent["src/courier_controller_node.cpp"]


def test_the_same_twice(courier: robosc.Models, settings: Configuration, files: dict[str, str]) -> None:
    assert robosc.generate("ros2", courier, settings) == files


def test_every_text_ends_with_a_line(files: dict[str, str]) -> None:
    for path, text in files.items():
        assert text.endswith("\n"), path
        assert not any(line != line.rstrip() for line in text.split("\n")), path


def test_the_platform_s_linter_is_content(files: dict[str, str], tmp_path: Path) -> None:
    # As ament_lint_cmake calls it.
    filters = "--filter=-convention/filename,-package/consistency,-package/stdargs"
    (tmp_path / "CMakeLists.txt").write_text(files["CMakeLists.txt"], encoding="utf-8")
    command = [sys.executable, "-m", "cmakelint.main", filters, "--linelength=140", tmp_path / "CMakeLists.txt"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
