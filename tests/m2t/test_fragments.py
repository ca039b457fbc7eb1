"""Generated parts of the user's own package or CMake project; `tests/cmake` shows that they build."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import robosc
from robosc.language import configuration as config

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.language.configuration import Configuration

HERE = Path(__file__).parent / "fragments"
USHER = HERE.parent / "layer"
#: The layer for one ROS represents the other. Its robot has different commands on different topics.
TARGETS = ("ros1", "ros2", "ros2-layer", "supervisor")


@pytest.fixture(scope="module")
def usher() -> robosc.Models:
    robot = robosc.load(USHER / "usher.rscd")
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return robosc.Models(model, robosc.to_rosgraph(robot), robot)


@pytest.fixture
def models(target: str, porter: robosc.Models, usher: robosc.Models) -> robosc.Models:
    return usher if target.endswith("layer") else porter


@pytest.fixture
def settings(target: str, porter_settings: Configuration) -> Configuration:
    return config.read(USHER / "controller-config.json") if target.endswith("layer") else porter_settings


@pytest.mark.parametrize("target", TARGETS)
def test_the_fragment(
    target: str, models: robosc.Models, settings: Configuration, golden: Callable[[Path, str], None]
) -> None:
    files = robosc.generate(target, models, settings, into="my_robot", with_tests=True)
    golden(HERE / f"{target}.cmake", files["fragment.cmake"])
    assert {"package.xml", "CMakeLists.txt", "Dockerfile"}.isdisjoint(files)
    for path, text in files.items():
        assert text.endswith("\n"), path
        assert not any(line != line.rstrip() for line in text.split("\n")), path


@pytest.mark.parametrize("target", TARGETS)
def test_the_code_is_that_of_a_package_of_its_own(target: str, models: robosc.Models, settings: Configuration) -> None:
    """Only launch files, which name the package, and the path of the engine's header differ."""
    own = robosc.generate(target, models, settings)
    part = robosc.generate(target, models, settings, into="my_robot")
    assert {path.rpartition("/")[2] for path in own} - {path.rpartition("/")[2] for path in part} == {
        name for name in ("CHANGELOG.rst", "CMakeLists.txt", "LICENSE", "README.md", "package.xml") if name in own
    }
    shared = own.keys() & part.keys()
    assert any(path.endswith("_supervisor.c") for path in shared)
    assert {path for path in shared if own[path] != part[path]} <= {path for path in shared if "launch" in path}


@pytest.mark.parametrize("target", ["ros1", "ros2"])
def test_launch_files_look_into_the_package(target: str, porter: robosc.Models, porter_settings: Configuration) -> None:
    files = robosc.generate(target, porter, porter_settings, into="my_robot")
    (launch,) = [text for path, text in files.items() if path.startswith("launch/")]
    if target == "ros1":
        assert 'pkg="my_robot" type="porter_controller"' in launch
        assert "$(find my_robot)/config/porter_controller.yaml" in launch
    else:
        assert 'PACKAGE = "my_robot"' in launch
        assert "executable=NAME" in launch


@pytest.mark.parametrize("target", ["ros1", "ros2"])
def test_types_of_the_package_itself_are_not_looked_for(target: str, porter: robosc.Models) -> None:
    fragment = robosc.generate(target, porter, into="nav2_msgs")["fragment.cmake"]
    assert "nav2_msgs" in robosc.generate(target, porter, into="my_robot")["fragment.cmake"]
    looked_for = fragment.partition("add_library")[0].partition("\n")[2]
    assert "nav2_msgs" not in looked_for
    assert ("rosidl_get_typesupport_target" if target == "ros2" else "${CATKIN_DEVEL_PREFIX}") in fragment


def test_what_is_no_code_becomes_part_of_nothing(porter: robosc.Models) -> None:
    with pytest.raises(ValueError, match="is not code"):
        robosc.generate("cif", porter, into="my_robot")


def test_the_linter_is_content() -> None:
    root = Path(__file__).parents[2]
    files = [path for pattern in ("*.cmake", "CMakeLists.txt") for path in (root / "cmake").rglob(pattern)]
    files += [*HERE.glob("*.cmake"), *(root / "examples" / "workspace").glob("*/*/CMakeLists.txt")]
    assert len(files) > 12
    filters = "--filter=-convention/filename,-package/consistency,-package/stdargs"
    command = [sys.executable, "-m", "cmakelint.main", filters, "--linelength=140", *files]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
