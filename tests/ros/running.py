"""`robosc run` over ROS 2, and the Python modules of interfaces that no registry offers."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.ros.installations import Found, Ros
from tests.ros.workspaces import found_or_skipped
from tests.sharing import made_once

if TYPE_CHECKING:
    from collections.abc import Sequence

HERE = Path(__file__).parent
PROJECT = HERE.parents[1]
#: Models of some packages. Tests of these generated nodes also run the nodes from their models.
MODELS = {
    "line_follower_controller": PROJECT / "examples" / "line_follower" / "line_follower.rscd",
    "courier_controller": HERE.parent / "m2t" / "cpp" / "courier.rscd",
    "cruise_controller": HERE.parent / "run" / "runtime" / "cruise.rscd",
    "patience_controller": HERE / "times" / "patience.rscd",
    "keeper_controller": HERE / "kept" / "keeper.rscd",
}


@dataclass(frozen=True)
class Runner:
    """Runs models as nodes. `interfaces` is a folder with Python modules of ROS packages, for all programs."""

    ros: Ros
    interfaces: Path

    def command(
        self,
        model: str | Path,
        *parameters: str,
        layer: bool = False,
        configuration: str | Path | None = None,
        remappings: Sequence[str] = (),
        own_types: bool = False,
    ) -> list[str]:
        """Return the command that runs a model with parameters (`name:=value`) and remappings (`/from:=/to`).

        With `own_types`, the types of `interfaces/ros2` replace those that `robosc` knows.
        """
        options = ["--layer"] if layer else []
        options += ["--interface-path", str(HERE / "interfaces" / "ros2")] if own_types else []
        options += ["--config", str(configuration)] if configuration else []
        arguments = ["--ros-args", *(word for parameter in parameters for word in ("-p", parameter))]
        arguments += [word for remapping in remappings for word in ("-r", remapping)]
        return [self.ros.python, "-m", "robosc", "run", str(model), *options, *arguments]

    def node(self, package: str, *parameters: str) -> list[str]:
        """Return the command that runs the model of a generated package in `MODELS`."""
        return self.command(MODELS[package], *parameters)

    def environment(self) -> dict[str, str]:
        """Return the environment of the node and its partners, run by `ros.python`, with the tool of this tree."""
        found = [str(self.interfaces), str(PROJECT), self.ros.environment.get("PYTHONPATH")]
        path = os.pathsep.join(filter(None, found))
        return {**self.ros.environment, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONUNBUFFERED": "1"}


def find_rclpy(environments: Sequence[Path] = (PROJECT / ".venv-ros2", Path(sys.prefix))) -> Found:
    """Find ROS 2 for `robosc run`: the first Python with rclpy and robosc, such as those that `run-tests` creates."""
    found = Found()
    # These wheels must not use the libraries of another installation, nor its mark that they are initialized.
    others = ("AMENT_PREFIX_PATH", "LD_LIBRARY_PATH", "PYTHONPATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE")
    environment = {name: value for name, value in os.environ.items() if name not in others}
    environment |= {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}
    for python in (folder / "bin" / "python" for folder in environments):
        command = [python, "-c", "import rclpy, robosc"]
        if (
            python.exists()
            and not subprocess.run(command, env=environment, check=False, capture_output=True).returncode
        ):
            found.ros = Ros(2, environment, str(python), [])
            return found
    found.missing.append("no Python with rclpy and robosc: see run-tests")
    return found


def ros2_modules(ros: Ros, folder: Path, package: str = "") -> str:
    """Return the folder of the Python modules of `interfaces/ros2`; build them if they do not exist.

    `package` is the only package to build.
    """
    modules = folder / "modules"
    if not modules.exists():
        source = HERE / "interfaces" / "ros2" / package
        command = [ros.python, "-m", "robosc", "interfaces", "build", source, "-o", modules]
        done = subprocess.run(command, env=ros.environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
    return str(modules)


@pytest.fixture(scope="session")
def run_ros2(shared_folder: Path) -> Runner:
    """`robosc run` with the interfaces of `interfaces/ros2`."""
    ros = found_or_skipped("ros2-run", find_rclpy())
    folder = Path(os.environ.get("ROBOSC_ROS2_INTERFACES") or shared_folder / "interfaces-ros2")
    return Runner(ros, Path(made_once(shared_folder, "run-ros2", lambda: ros2_modules(ros, folder))))


@pytest.fixture(scope="session")
def run_kilted(shared_folder: Path) -> Runner:
    """`robosc run` over ROS 2 Kilted with `nav2_msgs`."""
    ros = found_or_skipped("ros2-kilted", find_rclpy([PROJECT / ".venv-ros2-kilted"]))
    folder = shared_folder / "interfaces-kilted"
    return Runner(ros, Path(made_once(shared_folder, "run-kilted", lambda: ros2_modules(ros, folder, "nav2_msgs"))))
