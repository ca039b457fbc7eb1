"""`robosc run` over a real ROS, and the Python modules of the interfaces that no registry has."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.ros.installations import Found, Ros, find_ros1
from tests.sharing import made_once

if TYPE_CHECKING:
    from collections.abc import Sequence

HERE = Path(__file__).parent
PROJECT = HERE.parents[1]
#: The models of some packages: what a generated node does is asked of the node run from its model, too.
MODELS = {
    "line_follower_controller": PROJECT / "examples" / "line_follower" / "line_follower.rscd",
    "courier_controller": HERE.parent / "m2t" / "cpp" / "courier.rscd",
    "cruise_controller": HERE.parent / "runtime" / "cruise.rscd",
    "patience_controller": HERE / "times" / "patience.rscd",
    "keeper_controller": HERE / "kept" / "keeper.rscd",
}
#: What the packages of `interfaces/ros1` depend on.
KNOWN = ("actionlib_msgs", "geometry_msgs", "std_msgs")


@dataclass(frozen=True)
class Runner:
    """Runs models as nodes. `interfaces` is a folder with Python modules of ROS packages, for everybody there."""

    ros: Ros
    robosc: str
    interfaces: Path

    def command(
        self,
        model: str | Path,
        *parameters: str,
        layer: bool = False,
        configuration: str | Path | None = None,
        remappings: Sequence[str] = (),
    ) -> list[str]:
        """The command that runs a model with parameters (`name:=value`) and remappings (`/from:=/to`)."""
        options = ["--layer"] if layer else []
        options += ["--config", str(configuration)] if configuration else []
        if self.ros.version == 1:
            arguments = [*(f"_{parameter}" for parameter in parameters), *remappings]
        else:
            arguments = ["--ros-args", *(word for parameter in parameters for word in ("-p", parameter))]
            arguments += [word for remapping in remappings for word in ("-r", remapping)]
        return [self.robosc, "-m", "robosc", "run", str(model), f"--ros{self.ros.version}", *options, *arguments]

    def node(self, package: str, *parameters: str) -> list[str]:
        """The command that starts what a generated package of `MODELS` would be."""
        return self.command(MODELS[package], *parameters)

    def environment(self) -> dict[str, str]:
        """What the node needs, and the programs that talk to it: `ros.python` runs them; the tool of this tree."""
        found = [str(self.interfaces), str(PROJECT), self.ros.environment.get("PYTHONPATH")]
        path = os.pathsep.join(filter(None, found))
        return {**self.ros.environment, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONUNBUFFERED": "1"}


def find_rclpy() -> Found:
    """ROS 2 as far as `robosc run` needs it: a Python that has rclpy and robosc, as `run-tests` makes one."""
    found = Found()
    # Another installation's libraries, and its word that they are found already, are not for these wheels.
    others = ("AMENT_PREFIX_PATH", "LD_LIBRARY_PATH", "PYTHONPATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE")
    environment = {name: value for name, value in os.environ.items() if name not in others}
    environment |= {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}
    for python in (PROJECT / ".venv-ros2" / "bin" / "python", Path(sys.executable)):
        command = [python, "-c", "import rclpy, robosc"]
        if (
            python.exists()
            and not subprocess.run(command, env=environment, check=False, capture_output=True).returncode
        ):
            found.ros = Ros(2, environment, str(python), [])
            return found
    found.missing.append("no Python with rclpy and robosc: see run-tests")
    return found


def ros1_modules(ros: Ros, folder: Path) -> str:
    """The Python modules of `interfaces/ros1`, made in a folder: where they are."""
    for package in sorted((HERE / "interfaces" / "ros1").iterdir()):
        _generate_ros1(ros, package, folder)
    return str(folder / "modules")


def ros2_modules(ros: Ros, folder: Path) -> str:
    """The Python modules of `interfaces/ros2`, made in a folder if they are not there: where they are."""
    modules = folder / "modules"
    if not modules.exists():
        _done(ros, [ros.python, "-m", "robosc", "interfaces", "build", HERE / "interfaces" / "ros2", "-o", modules])
    return str(modules)


@pytest.fixture(scope="session")
def run_ros1(shared_folder: Path) -> Runner:
    """`robosc run --ros1`, with the interfaces of `interfaces/ros1`."""
    ros, folder = _found_or_skipped("ros1", find_ros1()), shared_folder / "interfaces-ros1"
    return Runner(ros, sys.executable, Path(made_once(shared_folder, "run-ros1", lambda: ros1_modules(ros, folder))))


@pytest.fixture(scope="session")
def run_ros2(shared_folder: Path) -> Runner:
    """`robosc run --ros2`, with the interfaces of `interfaces/ros2`."""
    ros = _found_or_skipped("ros2-run", find_rclpy())
    folder = Path(os.environ.get("ROBOSC_ROS2_INTERFACES") or shared_folder / "interfaces-ros2")
    return Runner(ros, ros.python, Path(made_once(shared_folder, "run-ros2", lambda: ros2_modules(ros, folder))))


@pytest.fixture(scope="session", params=["ros1", "ros2"])
def runner(request: pytest.FixtureRequest) -> Runner:
    """`robosc run` over each ROS."""
    made: Runner = request.getfixturevalue(f"run_{request.param}")
    return made


def _found_or_skipped(name: str, found: Found) -> Ros:
    if found.ros is None:
        reason = f"{name}: {', '.join(found.missing)}"
        if name in os.environ.get("ROBOSC_REQUIRE", "").split(","):
            pytest.fail(reason)
        pytest.skip(reason)
    return found.ros


def _generate_ros1(ros: Ros, package: Path, folder: Path) -> None:
    """The Python modules of one package, by the generators that catkin calls."""
    name, messages = package.name, folder / "messages" / package.name
    for action in sorted(package.glob("action/*.action")):
        _done(ros, [ros.python, "/usr/lib/actionlib_msgs/genaction.py", action, "-o", messages])
    known = [f"-I{known_package}:/usr/share/{known_package}/msg" for known_package in KNOWN] + [
        f"-I{name}:{messages}",
        f"-I{name}:{package}/msg",
    ]
    for kind, files in {
        "msg": [*sorted(package.glob("msg/*.msg")), *sorted(messages.glob("*.msg"))],
        "srv": sorted(package.glob("srv/*.srv")),
    }.items():
        out = folder / "modules" / name / kind
        if files:
            out.mkdir(parents=True)
            generator = f"/usr/lib/genpy/gen{kind}_py.py"
            _done(ros, [ros.python, generator, *known, "-p", name, "-o", out, *files])
            _done(ros, [ros.python, generator, "--initpy", "-p", name, "-o", out])
    (folder / "modules" / name / "__init__.py").touch()


def _done(ros: Ros, command: Sequence[str | Path]) -> None:
    done = subprocess.run(command, env=ros.environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
