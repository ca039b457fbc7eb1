"""The ROS 2 package of the courier, file by file; `tests/ros` shows that it builds and works."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest
from catkin_pkg.package import parse_package_string
from ruamel.yaml import YAML

import robosc
from robosc.language.configuration import Configuration, Lifecycle, Package
from tests.m2t.conftest import differences

if TYPE_CHECKING:
    from collections.abc import Callable

HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def files(courier: robosc.Models, settings: Configuration) -> dict[str, str]:
    return robosc.generate("ros2", courier, settings)


@pytest.fixture(scope="module")
def porter_files(porter: robosc.Models, porter_settings: Configuration) -> dict[str, str]:
    return robosc.generate("ros2", porter, porter_settings)


@pytest.fixture(scope="module")
def managed_files(porter: robosc.Models, porter_settings: Configuration) -> dict[str, str]:
    managed = {"lifecycle": Lifecycle(bond=True), "package": Package(name="managed_porter")}
    return robosc.generate("ros2", porter, porter_settings.model_copy(update=managed))


def test_every_file(files: dict[str, str], golden_package: Callable[[Path, dict[str, str]], None]) -> None:
    golden_package(HERE / "courier", files)


def test_every_file_for_services_and_actions(
    porter_files: dict[str, str], golden_package: Callable[[Path, dict[str, str]], None]
) -> None:
    golden_package(HERE / "porter", porter_files)


def test_what_is_special_in_a_managed_node(
    porter_files: dict[str, str], managed_files: dict[str, str], golden: Callable[[Path, str], None]
) -> None:
    def renamed(text: str) -> str:
        return text.replace("managed_porter", "porter_controller").replace("MANAGED_PORTER", "PORTER_CONTROLLER")

    same = {path for path, text in managed_files.items() if renamed(text) == porter_files.get(renamed(path))}
    special = sorted(set(managed_files) - same)
    assert special == [
        "CMakeLists.txt",
        "include/robosc_ros2/bond.hpp",
        "include/robosc_ros2/lifecycle_services.hpp",
        "include/robosc_ros2/managed_node.hpp",
        "launch/managed_porter.launch.py",
        "package.xml",
        "src/managed_porter_node.cpp",
    ]
    managed = {renamed(path): renamed(managed_files[path]) for path in special if not path.endswith(".hpp")}
    golden(HERE / "managed.diff", differences(porter_files, managed))


def test_package_lists_what_is_used(files: dict[str, str]) -> None:
    package = parse_package_string(files["package.xml"])
    package.validate()
    assert [buildtool_depend.name for buildtool_depend in package.buildtool_depends] == ["ament_cmake"]
    used = {"diagnostic_msgs", "geometry_msgs", "rclcpp", "rclcpp_components", "sensor_msgs", "std_msgs"}
    assert {build_depend.name for build_depend in package.build_depends} == used
    assert {exec_depend.name for exec_depend in package.exec_depends} == used | {"launch", "launch_ros"}
    described = ElementTree.fromstring(files["package.xml"]).findtext("description")  # noqa: S314  # our own text
    assert described == "Carries <data> & more: ]]> -->"
    assert package.maintainers[0].name == "A. O'Tester <&>"


def test_package_lists_what_services_actions_and_managed_nodes_need(
    porter_files: dict[str, str], managed_files: dict[str, str]
) -> None:
    messages = {"action_msgs", "diagnostic_msgs", "geometry_msgs", "nav2_msgs", "std_msgs", "std_srvs"}
    used = {"rclcpp", "rclcpp_action", "rclcpp_components"} | messages
    package = parse_package_string(porter_files["package.xml"])
    assert {build_depend.name for build_depend in package.build_depends} == used
    managed = parse_package_string(managed_files["package.xml"])
    used |= {"bond", "lifecycle_msgs", "rclcpp_lifecycle"}
    assert {build_depend.name for build_depend in managed.build_depends} == used
    launching = {exec_depend.name for exec_depend in managed.exec_depends} - {
        build_depend.name for build_depend in managed.build_depends
    }
    assert launching == {"launch", "launch_ros"}


@pytest.mark.parametrize("name", ["courier", "managed"])
def test_launch_file_is_python(name: str, files: dict[str, str], managed_files: dict[str, str]) -> None:
    path = {"courier": "launch/courier_controller.launch.py", "managed": "launch/managed_porter.launch.py"}[name]
    tree = ast.parse((files | managed_files)[path])
    functions = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
    assert functions == ["start", "generate_launch_description"]
    imported = [alias.name for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names]
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert set(imported) <= used


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


@pytest.mark.parametrize(
    ("name", "default"), [("/gripper/grip", "rclcpp::ServicesQoS()"), ("/travel", "rclcpp::QoS(10)")]
)
def test_quality_of_service_of_clients(porter: robosc.Models, name: str, default: str) -> None:
    quality = f'{{"qos": {{"{name}": {{"depth": 3, "reliability": "best_effort"}}}}}}'
    for settings, expected in (("{}", default), (quality, f"{default}.keep_last(3).best_effort()")):
        files = robosc.generate("ros2", porter, Configuration.model_validate_json(settings))
        assert f'"{name}", {expected},' in " ".join(files["src/porter_controller_node.cpp"].split())


def test_parameters_of_the_file_are_those_of_the_node(porter_files: dict[str, str]) -> None:
    parameters = YAML(typ="safe").load(porter_files["config/porter_controller.yaml"])["/**"]["ros__parameters"]
    assert parameters == {
        "period_ms": 100,
        "events_per_tick": 0,
        "react_immediately": True,
        "reactions_per_tick": 10,
        "event_log": "",
        "service_timeout_ms": 3000,
        "action_timeout_ms": 2000,
        "retry_ms": 500,
        "watchdog_stops": True,
        "diagnostics_ms": 1000,
        "watchdog_ms": {"order": 0, "stop": 400},
    }
    node = " ".join(porter_files["src/porter_controller_node.cpp"].split())
    names = [*parameters, *(f"watchdog_ms.{topic}" for topic in parameters.pop("watchdog_ms"))]
    assert [name for name in names if f'"{name}",' not in node] == ["watchdog_ms"]


def test_leaves_out_what_is_not_asked_for(courier: robosc.Models) -> None:
    silent = robosc.generate("ros2", courier, Configuration(publish_state_information=False))
    assert "include/courier_controller/definition.hpp" not in silent
    assert "~/" not in silent["src/courier_controller_node.cpp"]


def test_the_same_twice(courier: robosc.Models, settings: Configuration, files: dict[str, str]) -> None:
    assert robosc.generate("ros2", courier, settings) == files


def test_every_text_ends_with_a_line(files: dict[str, str], managed_files: dict[str, str]) -> None:
    for path, text in (files | managed_files).items():
        assert text.endswith("\n"), path
        assert not any(line != line.rstrip() for line in text.split("\n")), path


@pytest.mark.parametrize("name", ["courier", "porter", "managed"])
def test_the_platform_s_linter_is_content(name: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    files = request.getfixturevalue("files" if name == "courier" else f"{name}_files")
    # The options of ament_lint_cmake.
    filters = "--filter=-convention/filename,-package/consistency,-package/stdargs"
    (tmp_path / "CMakeLists.txt").write_text(files["CMakeLists.txt"], encoding="utf-8")
    command = [sys.executable, "-m", "cmakelint.main", filters, "--linelength=140", tmp_path / "CMakeLists.txt"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
