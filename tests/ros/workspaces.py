"""Workspaces of generated packages, built by the platform's own tool, with the environment to run their programs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from xmlrpc.client import ServerProxy

import pytest

from tests.ros.installations import Found, Ros, find_ros1, find_ros2, free_port
from tests.ros.processes import Processes
from tests.sharing import made_once, own_domain

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

HERE = Path(__file__).parent
EXAMPLES = HERE.parents[1] / "examples"
#: A line follower behind a supervisory layer.
SUPERVISED = EXAMPLES / "supervised_line_follower"
#: A robot behind a supervisory layer, and its controller.
USHER, DRIVER = HERE.parent / "m2t" / "layer", HERE / "usher_driver.py"
#: Two generated controllers in one process.
TWO_IN_ONE = HERE / "faults" / "two_in_one"
#: A base behind a layer that sends a stop in place of blocked commands.
BLOCKED = HERE / "blocked"
#: A robot with a latched stop button.
LATCHED = HERE / "latched"
#: A component in a delayed executor, and components in an executor that queues the callbacks of timers.
LATE = HERE / "late_arrival"
QUEUED = HERE / "events_executor"
#: A robot that serves services and actions.
SERVING = HERE / "serving"
#: A managed node with times, stored data, parameters, and a command that it sends on change.
MANAGED = HERE / "managed"
#: A robot with assumptions, limits, conditions on the data of commands, and comparisons with stored values.
RESTRICTED = HERE / "restricted"
CPP = HERE.parent / "m2t" / "cpp"
RUNTIME = HERE.parent / "run" / "runtime"


@dataclass(frozen=True)
class Package:
    """A package to generate: ROS name, model, target, configuration (by default, that of the model)."""

    name: str
    model: Path
    target: str
    configuration: Path | None = None
    with_tests: bool = False
    #: Whether the node publishes its state as a typed message, from a package built beside it.
    typed: bool = False
    #: Whether the model uses other types than those of its packages that `robosc` knows: those of `interfaces`.
    own_types: bool = False
    #: A fault to inject: a file of the package, a text in it, and its replacement.
    fault: tuple[str, str, str] | None = None


def _packages(target: str) -> list[Package]:
    """Return the controllers of the examples and of the test models for one ROS version."""
    examples = (
        "line_follower",
        "maze_solver",
        "object_finder",
        "obstacle_navigation",
        "person_follower",
        "push_ball",
        "simple_navigation",
        "sprayer",
        "supervised_line_follower",
        "warehouse_robot",
    )
    return [
        *(
            Package(f"{name}_controller", EXAMPLES / name / f"{name}.rscd", target, with_tests=name == "line_follower")
            for name in examples
        ),
        Package("courier_controller", CPP / "courier.rscd", target, typed=True),
        Package(
            "porter_controller", CPP / "porter.rscd", target, CPP / "porter-config.json", with_tests=True, typed=True
        ),
        Package("scout_controller", HERE / "faults" / "scout.rscd", target, own_types=True),
        Package("carrier_controller", HERE / "ends" / "carrier.rscd", target),
        Package("cruise_controller", HERE.parent / "run" / "runtime" / "cruise.rscd", target),
        Package("patience_controller", HERE / "times" / "patience.rscd", target),
        Package("keeper_controller", HERE / "kept" / "keeper.rscd", target),
        Package("waypoints_controller", RUNTIME / "waypoints.rscd", target, with_tests=True),
        Package("latch_controller", LATCHED / "latch.rscd", target, LATCHED / "controller-config.json"),
        Package(
            "clerk_controller", SERVING / "clerk.rscd", target, SERVING / "controller-config.json", own_types=True
        ),
    ]


#: Names of the packages to build; empty for all.
CHOSEN = os.environ.get("ROBOSC_PACKAGES", "").split()
#: The packages of the only workspace of each ROS version, beside those of `interfaces`.
ROS1_PACKAGES = [
    *_packages("ros1"),
    # This controller may move while its stop button is pressed.
    Package(
        "careless_controller",
        EXAMPLES / "line_follower" / "line_follower.rscd",
        "ros1",
        HERE / "careless-config.json",
        with_tests=True,
        fault=(
            "src/line_follower_supervisor.c",
            "&& state->component_EmergencyStop == line_follower_component_EmergencyStop_in_service;",
            "&& true;",
        ),
    ),
]
ROS2_PACKAGES = [
    *_packages("ros2"),
    Package("supervised_line_follower_layer", SUPERVISED / "supervised_line_follower.rscd", "ros2-layer"),
    Package("line_stepper_controller", SUPERVISED / "controller" / "line_stepper.rscd", "ros2"),
    Package("carrier_layer", HERE / "ends" / "carrier.rscd", "ros2-layer"),
    Package("usher_layer", USHER / "usher.rscd", "ros2-layer", USHER / "controller-config.json"),
    Package("hoist_layer", BLOCKED / "hoist.rscd", "ros2-layer", BLOCKED / "controller-config.json"),
    Package("guard_layer", HERE.parent / "run" / "runtime" / "guard.rscd", "ros2-layer"),
    Package("careless_controller", HERE / "ends" / "careless.rscd", "ros2"),
    Package("managed_carrier", HERE / "ends" / "carrier.rscd", "ros2", HERE / "ends" / "managed-config.json"),
    Package("managed_porter", CPP / "porter.rscd", "ros2", CPP / "managed-porter-config.json", with_tests=True),
    Package("hauler_controller", RESTRICTED / "hauler.rscd", "ros2", RESTRICTED / "controller-config.json"),
    Package("hauler_layer", RESTRICTED / "hauler.rscd", "ros2-layer", RESTRICTED / "layer-config.json"),
    Package("managed_hauler", RESTRICTED / "hauler.rscd", "ros2", RESTRICTED / "managed-config.json"),
    Package("managed_clerk", SERVING / "clerk.rscd", "ros2", SERVING / "managed-config.json", own_types=True),
    Package("managed_watch", MANAGED / "watch.rscd", "ros2", MANAGED / "controller-config.json"),
]


@dataclass(frozen=True)
class Workspace:
    """A folder with built packages, and the output of the build."""

    ros: Ros
    folder: Path
    build: str

    def node(self, package: str, *parameters: str) -> list[str | Path]:
        """Return the command that starts a node with parameters (`name:=value`), in ROS 1 by its launch file."""
        if self.ros.version == 1:
            return ["roslaunch", "--wait", package, f"{package}.launch", *parameters]
        options = [word for parameter in parameters for word in ("-p", parameter)]
        return [self.folder / f"install/{package}/lib/{package}/{package}", "--ros-args", *options]

    def source(self, package: str) -> Path:
        """Return the C++ file of a node."""
        return self.folder / "src" / package / "src" / f"{package}_node.cpp"

    def compiler_options(self, package: str) -> list[str]:
        """Return the include options of a ROS 1 node, as in catkin; the headers of ROS are system headers."""
        prefix = Path(self.ros.environment["ROS_PACKAGE_PATH"].partition(":")[0]).parent
        folders = [self.folder / "devel/include", prefix / "include", prefix / "include/xmlrpcpp"]
        system = [f"-isystem{folder}" for folder in folders if folder != Path("/usr/include")]
        return ["-std=c++17", f"-I{self.folder / 'src' / package / 'include'}", *system]

    def environment(self) -> dict[str, str]:
        """Return the environment in which programs find the packages and the Python modules of their interfaces."""
        environment = {**self.ros.environment, "PYTHONDONTWRITEBYTECODE": "1"}
        if self.ros.version == 1:
            return environment | {
                "ROS_PACKAGE_PATH": f"{self.folder / 'src'}:{environment['ROS_PACKAGE_PATH']}",
                "CMAKE_PREFIX_PATH": f"{self.folder / 'devel'}:{environment.get('CMAKE_PREFIX_PATH', '')}",
                "PYTHONPATH": f"{self.folder / 'devel/lib/python3/dist-packages'}:{environment.get('PYTHONPATH', '')}",
            }
        installed = sorted(path for path in (self.folder / "install").iterdir() if path.is_dir())
        found = {
            "AMENT_PREFIX_PATH": installed,
            "LD_LIBRARY_PATH": [prefix / "lib" for prefix in installed],
            "PYTHONPATH": [path for prefix in installed for path in prefix.glob("lib/python3*/site-packages")],
        }
        return environment | {
            name: ":".join([*map(str, paths), environment.get(name, "")]) for name, paths in found.items()
        }


@pytest.fixture(scope="session")
def ros1_build(shared_folder: Path) -> Iterator[Future[Workspace]]:
    """Build `ros1_workspace` in the background: the build takes minutes, and the earlier tests leave a core idle."""
    others = [*sorted((HERE / "interfaces" / "ros1").iterdir()), TWO_IN_ONE]
    with ThreadPoolExecutor(1) as executor:
        yield executor.submit(_workspace, shared_folder, found_or_skipped("ros1", find_ros1()), ROS1_PACKAGES, others)


@pytest.fixture(scope="session")
def ros1_workspace(request: pytest.FixtureRequest) -> Workspace:
    """The packages of `ROS1_PACKAGES` and `interfaces/ros1`.

    `ROBOSC_ROS1_WORKSPACE` names a permanent folder, in which only changed packages are built again.
    """
    future: Future[Workspace] = request.getfixturevalue("ros1_build")
    return future.result()


@pytest.fixture(scope="session")
def ros2_workspace(shared_folder: Path) -> Workspace:
    """The packages of `ROS2_PACKAGES` and `interfaces/ros2`; `ROBOSC_ROS2_WORKSPACE` names a permanent folder."""
    others = [*sorted((HERE / "interfaces" / "ros2").iterdir()), LATE, QUEUED]
    return _workspace(shared_folder, found_or_skipped("ros2", find_ros2()), ROS2_PACKAGES, others)


def _workspace(shared: Path, ros: Ros, packages: Sequence[Package], others: Sequence[Path]) -> Workspace:
    """Return a workspace that is built once in each run of the tests."""
    name = f"ros{ros.version}"
    folder = Path(os.environ.get(f"ROBOSC_{name.upper()}_WORKSPACE") or shared / f"{name}-workspace")
    return Workspace(ros, folder, made_once(shared, name, lambda: build(ros, folder, packages, others)))


def found_or_skipped(name: str, found: Found) -> Ros:
    """Return the installation; without one, skip the test, or fail if `ROBOSC_REQUIRE` lists its name."""
    if found.ros is None:
        reason = f"{name}: {', '.join(found.missing)}"
        if name in os.environ.get("ROBOSC_REQUIRE", "").split(","):
            pytest.fail(reason)
        pytest.skip(reason)
    return found.ros


def build(ros: Ros, folder: Path, packages: Sequence[Package], others: Sequence[Path]) -> str:
    """Generate packages into a workspace, link others beside them, and build all; return the output of the build."""
    source = folder / "src"
    source.mkdir(parents=True, exist_ok=True)
    chosen = [package for package in packages if not CHOSEN or package.name in CHOSEN]
    generated = {package: folder / "generated" / package.name for package in chosen}
    calls = [_transform(package, out) for package, out in generated.items()]
    done = subprocess.run(
        [sys.executable, "-m", "tests.ros.transform"],
        cwd=EXAMPLES.parent, input=json.dumps(calls), capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    for package, out in generated.items():
        made = out / package.target.removesuffix("-layer") / package.name
        if package.fault:
            _spoil(made, *package.fault)
        for folder_made in [made, *made.parent.glob("*_msgs")]:
            _link(source / folder_made.name, folder_made)
    for other in others:
        _link(source / other.name, other)
    return ros.built(folder)


def _transform(package: Package, out: Path) -> list[str]:
    """Return the arguments of `robosc` that generate a package into a folder."""
    settings = ["--config", str(package.configuration)] if package.configuration else []
    settings += ["--with-tests"] if package.with_tests else []
    settings += ["--typed-state"] if package.typed else []
    interfaces = HERE / "interfaces" / package.target[:4]
    if package.target == "ros1" and not package.own_types:
        interfaces /= "nav2_msgs"  # which ROS 1 itself does not have
    if package.target == "ros1" or package.own_types:
        settings += ["--interface-path", str(interfaces)]
    return ["transform", str(package.model), "-o", str(out), "--to", package.target, *settings]


@contextmanager
def middleware(workspace: Workspace, folder: Path, *, simulated: bool = False) -> Iterator[Processes]:
    """Run programs in the environment of a workspace, on loopback and isolated from others; for ROS 1 with a master.

    `folder` must not exist; it receives the logs of the programs and of ROS (`log/`). With `simulated`, time comes from
    `/clock`.
    """
    folder.mkdir()
    environment = workspace.environment() | {"ROS_LOG_DIR": str(folder / "log")}
    if workspace.ros.version == 2:
        with own_domain() as domain, Processes(environment | {"ROS_DOMAIN_ID": str(domain)}, folder) as processes:
            yield processes
        return
    port = free_port()
    environment |= {
        "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
        "ROS_IP": "127.0.0.1",
        "ROS_HOSTNAME": "127.0.0.1",
        "ROS_HOME": str(folder),
        # Output of a compiled node must reach a log file at once.
        "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1",
    }
    with Processes(environment, folder) as processes:
        # `roscore` starts the same master, but takes seconds of CPU time for each test.
        processes.start("rosmaster", ["rosmaster", "--core", "-p", str(port)])
        master = ServerProxy(environment["ROS_MASTER_URI"])
        processes.wait_until(lambda: _answers(master, simulated=simulated), "the master is online")
        yield processes


def _answers(master: ServerProxy, *, simulated: bool) -> bool:
    """Whether a ROS 1 master is online and has the source of time for its nodes."""
    try:
        master.setParam("/test", "/run_id", "test")  # without it, `roslaunch --wait` never ends
        master.setParam("/test", "/use_sim_time", simulated)
    except OSError:
        return False
    return True


def _spoil(package: Path, name: str, right: str, wrong: str) -> None:
    file = package / name
    text = file.read_text(encoding="utf-8")
    assert text.count(right) == 1
    file.write_text(text.replace(right, wrong), encoding="utf-8")


def _link(place: Path, package: Path) -> None:
    if not place.is_symlink():
        place.symlink_to(package, target_is_directory=True)
