"""CMake 4, as a wheel, configures all CMake code of the project without a warning about it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import robosc
from robosc.language.configuration import Configuration
from robosc.m2t.targets import TARGETS
from tests.m2t.conftest import models

pytestmark = pytest.mark.build

ROOT = Path(__file__).parents[2]
CMAKE = Path(sys.executable).with_name("cmake")
CATKIN = Path("/usr/share/catkin/cmake/catkinConfig.cmake")
#: The first package that a package for ROS 2 looks for. Without it, CMake stops there.
AMENT = 'provided by "ament_cmake'


def warnings(output: str) -> list[str]:
    """Return the first lines of CMake's warnings, except those about files of an installed ROS."""
    found = re.findall(r"^CMake .*Warning.*$", output, re.MULTILINE)
    return [line for line in found if not re.search(r" at (/usr/share|/opt/ros)/", line)]


def configure(source: Path, build: Path) -> tuple[int, str]:
    """Configure a folder with CMake 4; return the exit status and the output."""
    if not CMAKE.exists():
        pytest.skip(f"no {CMAKE}: the packages of [test] are not installed")
    command = [CMAKE, "-S", source, "-B", build, f"-DROBOSC_PYTHON={sys.executable}"]
    command += [f"-DCMAKE_PREFIX_PATH={ROOT / 'cmake'}", "-DPYTHON_EXECUTABLE=/usr/bin/python3"]
    command += ["--no-warn-unused-cli"]
    environment = {name: value for name, value in os.environ.items() if name != "CMAKE_PREFIX_PATH"}
    environment |= {"PYTHONPATH": str(ROOT), "ROS_PACKAGE_PATH": "/usr/share"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    return done.returncode, done.stdout + done.stderr


def generated(target: str, folder: Path) -> list[Path]:
    """Write the package of a target and the one with the type of the robot's state, if any; return their folders."""
    courier = models("courier")
    files = {f"node/{path}": text for path, text in robosc.generate(target, courier).items()}
    for path, text in (files | TARGETS[target].beside(courier, Configuration(typed_state=True))).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return [path.parent for path in sorted(folder.rglob("CMakeLists.txt"))]


@pytest.mark.parametrize("target", ["supervisor", "ros1", "ros2"])
def test_generated_packages_draw_no_warning(target: str, tmp_path: Path) -> None:
    if target == "ros1" and not CATKIN.exists():
        pytest.skip("no catkin of Debian")
    packages = generated(target, tmp_path / "source")
    assert len(packages) == (1 if target == "supervisor" else 2)
    for number, package in enumerate(packages):
        status, output = configure(package, tmp_path / str(number))
        assert warnings(output) == []
        assert status == 0 or (target == "ros2" and AMENT in output), output


@pytest.mark.parametrize("folder", ["tests/cmake/plain", "cmake/catkin_robosc", "cmake/ament_cmake_robosc"])
def test_cmake_code_of_the_project_draws_no_warning(folder: str, tmp_path: Path) -> None:
    if "catkin" in folder and not CATKIN.exists():
        pytest.skip("no catkin of Debian")
    status, output = configure(ROOT / folder, tmp_path)
    assert warnings(output) == []
    assert status == 0 or ("ament" in folder and AMENT in output), output
