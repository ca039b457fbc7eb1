"""Files that `--with-tests` adds to the packages; `tests/traces` and `tests/ros` show that they find faults."""

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
from tests.m2t.conftest import differences

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.language.configuration import Configuration

HERE = Path(__file__).parent
TEST_DEPENDS = {
    "ros1": {"rosgraph_msgs", "rospy", "rostest"},
    "ros2": {
        *("ament_lint_auto", "ament_lint_common"),
        *("launch_testing", "launch_testing_ament_cmake", "rclpy", "rosgraph_msgs"),
    },
}
#: Files that are the same in each ROS and have one golden file for both.
SAME = ("test/connections.json", "test/traces/tour_1.jsonl")

pytestmark = pytest.mark.parametrize("target", TEST_DEPENDS)


@pytest.fixture
def plain(target: str, porter: robosc.Models, porter_settings: Configuration) -> dict[str, str]:
    return robosc.generate(target, porter, porter_settings)


@pytest.fixture
def files(target: str, porter: robosc.Models, porter_settings: Configuration) -> dict[str, str]:
    return robosc.generate(target, porter, porter_settings, with_tests=True)


def test_what_is_added(
    target: str, plain: dict[str, str], files: dict[str, str], golden: Callable[[Path, str], None]
) -> None:
    folder = HERE / "with_tests" / target
    new = {path: text for path, text in files.items() if plain.get(path) != text}
    assert set(plain) < set(files)
    changed = {path: new.pop(path) for path in plain if path in new}
    assert set(changed) == {"CMakeLists.txt", "package.xml"}
    golden(folder.parent / f"{target}.diff", differences(plain, changed))
    player = new.pop("test/trace_player.py")
    assert player == (Path(robosc.__file__).parent / "run/node_tests/trace_player.py").read_text(encoding="utf-8")
    # The suffix hides the scripts from pytest and from this repository's linters.
    new = {f"{path}.golden" if path.endswith(".py") else path: text for path, text in new.items()}
    for path in SAME:
        golden(folder.parent / path, new.pop(path))
    for path, text in new.items():
        golden(folder / path, text)
    kept = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert kept == set(new)


def test_nothing_is_added_to_other_targets(porter: robosc.Models, porter_settings: Configuration, target: str) -> None:
    del target
    for name in ("supervisor", "cif", "xmi"):
        assert robosc.generate(name, porter, porter_settings, with_tests=True) == robosc.generate(
            name, porter, porter_settings
        )


def test_the_package_lists_what_the_test_needs(target: str, plain: dict[str, str], files: dict[str, str]) -> None:
    with_tests, without = (parse_package_string(package["package.xml"]) for package in (files, plain))
    with_tests.validate()
    assert {test_depend.name for test_depend in with_tests.test_depends} == TEST_DEPENDS[target]
    for kind in ("build_depends", "exec_depends", "buildtool_depends"):
        assert [dependency.name for dependency in getattr(with_tests, kind)] == [
            dependency.name for dependency in getattr(without, kind)
        ]


def test_the_platform_s_linter_is_content(target: str, files: dict[str, str], tmp_path: Path) -> None:
    package = tmp_path / "porter_controller"
    for path, text in files.items():
        (package / path).parent.mkdir(parents=True, exist_ok=True)
        (package / path).write_text(text, encoding="utf-8")
    command: list[str | Path] = [sys.executable, "-m", "catkin_lint", "-W2", "--strict", package]
    if target == "ros2":
        filters = "--filter=-convention/filename,-package/consistency,-package/stdargs"
        command = [sys.executable, "-m", "cmakelint.main", filters, "--linelength=140", package / "CMakeLists.txt"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_scripts_and_launch_files_can_be_read(target: str, files: dict[str, str], tmp_path: Path) -> None:
    """Scripts for ROS 1 must be valid in Python 3.8. Ruff finds undefined and unused names."""
    scripts = {path: text for path, text in files.items() if path.endswith(".py") and path.startswith("test/")}
    assert len(scripts) == (3 if target == "ros2" else 2)
    for path, text in scripts.items():
        ast.parse(text, path, feature_version=(3, 8))
        (tmp_path / Path(path).name).write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "ruff", "check", "--isolated", "--select", "F,E9", tmp_path]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    if target == "ros1":
        launch = ElementTree.fromstring(files["test/play_trace.test"])  # noqa: S314  # our own text
        parameters = {parameter.get("name"): parameter.get("value") for parameter in launch.findall("node/param")}
        assert parameters["service_timeout_ms"] == "3000"
        assert parameters["watchdog_stops"] == "false"


def test_every_text_ends_with_a_line(files: dict[str, str]) -> None:
    for path, text in files.items():
        assert text.endswith("\n"), path
        assert not any(line != line.rstrip() for line in text.split("\n")), path
