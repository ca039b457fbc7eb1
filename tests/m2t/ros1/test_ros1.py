"""The ROS 1 package of the courier, file by file; `tests/ros` shows that it builds and works."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest
from catkin_pkg.package import parse_package_string

import robosc
from robosc.language.configuration import Configuration

if TYPE_CHECKING:
    from collections.abc import Callable

HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def files(courier: robosc.Models, settings: Configuration) -> dict[str, str]:
    return robosc.generate("ros1", courier, settings)


@pytest.fixture(scope="module")
def porter_files(porter: robosc.Models, porter_settings: Configuration) -> dict[str, str]:
    return robosc.generate("ros1", porter, porter_settings)


def test_every_file(files: dict[str, str], golden_package: Callable[[Path, dict[str, str]], None]) -> None:
    golden_package(HERE / "courier", files)


def test_every_file_for_services_and_actions(
    porter_files: dict[str, str], golden_package: Callable[[Path, dict[str, str]], None]
) -> None:
    golden_package(HERE / "porter", porter_files)


def test_package_lists_what_is_used(files: dict[str, str]) -> None:
    package = parse_package_string(files["package.xml"])
    package.validate()
    assert [buildtool_depend.name for buildtool_depend in package.buildtool_depends] == ["catkin"]
    used = {"diagnostic_msgs", "geometry_msgs", "rosconsole", "roscpp", "sensor_msgs", "std_msgs", "xmlrpcpp"}
    assert {build_depend.name for build_depend in package.build_depends} == used
    assert {exec_depend.name for exec_depend in package.exec_depends} == used
    described = ElementTree.fromstring(files["package.xml"]).findtext("description")  # noqa: S314  # our own text
    assert described == "Carries <data> & more: ]]> -->"
    assert package.maintainers[0].name == "A. O'Tester <&>"


def test_package_lists_what_services_and_actions_need(porter_files: dict[str, str]) -> None:
    package = parse_package_string(porter_files["package.xml"])
    messages = {"diagnostic_msgs", "geometry_msgs", "nav2_msgs", "std_msgs", "std_srvs"}
    used = {"actionlib", "rosconsole", "roscpp", "xmlrpcpp"} | messages
    assert {build_depend.name for build_depend in package.build_depends} == used
    assert {exec_depend.name for exec_depend in package.exec_depends} == used


def test_leaves_out_what_is_not_asked_for(courier: robosc.Models) -> None:
    silent = robosc.generate("ros1", courier, Configuration(publish_state_information=False))
    assert "include/courier_controller/definition.hpp" not in silent
    assert "state_report_" not in silent["src/courier_controller_node.cpp"]


def test_the_same_twice(courier: robosc.Models, settings: Configuration, files: dict[str, str]) -> None:
    assert robosc.generate("ros1", courier, settings) == files


def test_every_text_ends_with_a_line(files: dict[str, str], porter_files: dict[str, str]) -> None:
    for path, text in (*files.items(), *porter_files.items()):
        assert text.endswith("\n"), path
        assert not any(line != line.rstrip() for line in text.split("\n")), path


@pytest.mark.parametrize("name", ["courier", "porter"])
def test_the_platform_s_linter_is_content(name: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    files: dict[str, str] = request.getfixturevalue("files" if name == "courier" else "porter_files")
    package = tmp_path / f"{name}_controller"
    for path, text in files.items():
        (package / path).parent.mkdir(parents=True, exist_ok=True)
        (package / path).write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "catkin_lint", "-W2", "--strict", package]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
