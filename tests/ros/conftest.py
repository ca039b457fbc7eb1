"""Generated packages over a real ROS: built and run once, so that the tests only read what came of it."""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.ros.installations import Ros, find_ros1, find_ros2, free_port
from tests.ros.processes import Processes

if TYPE_CHECKING:
    from collections.abc import Iterator

HERE = Path(__file__).parent
EXAMPLE = HERE.parents[1] / "examples" / "line_follower"
MODELS = {
    "line_follower_controller": EXAMPLE / "line_follower.rscd",
    "courier_controller": HERE.parent / "m2t" / "cpp" / "courier.rscd",
}


@dataclass(frozen=True)
class Workspace:
    """A folder in which the packages of all models were built, and what the build said."""

    ros: Ros
    folder: Path
    build: str

    def node(self, package: str, *parameters: str) -> list[str | Path]:
        """The command that starts a node with parameters (`name:=value`): for ROS 1 by its launch file."""
        if self.ros.version == 1:
            return ["roslaunch", "--wait", package, f"{package}.launch", *parameters]
        options = [each for parameter in parameters for each in ("-p", parameter)]
        return [self.folder / f"install/{package}/lib/{package}/{package}", "--ros-args", *options]


@dataclass(frozen=True)
class Drive:
    """What crossed the world's topics, what the node did in its own order, what it reported and printed."""

    record: list[dict[str, Any]]
    log: list[dict[str, Any]]
    reports: list[dict[str, Any]]
    node_status: int
    node_output: str

    def commands(self, start: float = 0.0, end: float = 1e9) -> list[tuple[float, float, float]]:
        """Time, linear and angular speed of the commands that the world received in a span of time."""
        received = ((each["time"], *each["data"]) for each in self.record if each["topic"] == "/cmd_vel")
        return [each for each in received if start <= each[0] < end]

    def poses(self, start: float = 0.0, end: float = 1e9) -> list[dict[str, Any]]:
        """Where the robot was in a span of time."""
        return [each["data"] for each in self.record if each["topic"] == "pose" and start <= each["time"] < end]


@dataclass(frozen=True)
class Courier:
    """What the courier reported and sent after each step of `send_to_courier.py`, and what it logged and printed."""

    steps: dict[str, Any]
    log: list[dict[str, Any]]
    node_output: str


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "workspace" in metafunc.fixturenames:
        metafunc.parametrize("workspace", ["ros1", "ros2"], indirect=True, scope="session")


@pytest.fixture(scope="session")
def workspace(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    found = find_ros1() if request.param == "ros1" else find_ros2()
    if found.ros is None:
        reason = f"{request.param}: {', '.join(found.missing)}"
        if request.param in os.environ.get("ROBOSC_REQUIRE", "").split(","):
            pytest.fail(reason)
        pytest.skip(reason)
    folder = tmp_path_factory.mktemp(request.param)
    (folder / "src").mkdir()
    for package, model in MODELS.items():
        out = folder / "generated"
        command = [sys.executable, "-m", "robosc", "transform", model, "--to", request.param, "-o", out]
        subprocess.run(command, check=True, capture_output=True)
        shutil.move(out / request.param / package, folder / "src" / package)
    return Workspace(found.ros, folder, found.ros.built(folder))


@pytest.fixture(scope="session")
def drive(workspace: Workspace) -> Drive:
    """The demonstration of the example, from start to end, in simulated time."""
    package, ros = "line_follower_controller", workspace.ros
    folder = workspace.folder / "drive"
    events, reports, record = folder / "events.jsonl", folder / "reports.jsonl", folder / "record.jsonl"
    with _middleware(workspace, folder, simulated=True) as processes:
        listener = processes.start("reports", [ros.python, HERE / "reports.py", str(ros.version), package, reports])
        processes.wait_until(reports.exists, "somebody listens to the node's reports")
        clock = ["use_sim_time:=true"] if ros.version == 2 else []
        node = processes.start("node", workspace.node(package, f"event_log:={events}", *clock))
        script = EXAMPLE / f"world_ros{ros.version}.py"
        world = processes.start("world", [ros.python, script, "--lockstep", "--record", record])
        processes.wait_until(lambda: world.poll() is not None, "the scenario has ended", seconds=180)
        assert world.returncode == 0, processes.logs()
        status = processes.stop(node)
        processes.stop(listener)
    output = (folder / "node.log").read_text()
    return Drive(_lines(record), _lines(events), _lines(reports), status, output)


@pytest.fixture(scope="session")
def courier(workspace: Workspace) -> Courier:
    """The courier, sent one message after the other, in real time."""
    package, ros = "courier_controller", workspace.ros
    folder = workspace.folder / "courier"
    steps = folder / "steps.json"
    with _middleware(workspace, folder, simulated=False) as processes:
        node = processes.start("node", workspace.node(package))
        client = processes.start("client", [ros.python, HERE / "send_to_courier.py", str(ros.version), steps])
        processes.wait_until(lambda: client.poll() is not None, "all steps are done", seconds=120)
        assert client.returncode == 0, processes.logs()
        processes.stop(node)
    log = _lines(folder / "log" / f"{package}-events.jsonl")
    return Courier(json.loads(steps.read_text()), log, (folder / "node.log").read_text())


@contextmanager
def _middleware(workspace: Workspace, folder: Path, *, simulated: bool) -> Iterator[Processes]:
    """Programs in the workspace's environment, on loopback and away from all others; for ROS 1 with a master."""
    folder.mkdir()
    ros, built = workspace.ros, workspace.folder
    environment = {**ros.environment, "ROS_LOG_DIR": str(folder / "log"), "PYTHONDONTWRITEBYTECODE": "1"}
    if ros.version == 2:
        domain = random.randrange(1, 100)  # noqa: S311  # so that runs side by side don't meet
        environment["ROS_DOMAIN_ID"] = str(domain)
        libraries = [str(each / "lib") for each in (built / "install").iterdir()]
        environment["LD_LIBRARY_PATH"] = ":".join([*libraries, environment.get("LD_LIBRARY_PATH", "")])
        with Processes(environment, folder) as processes:
            yield processes
        return
    port = free_port()
    environment |= {
        "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
        "ROS_IP": "127.0.0.1",
        "ROS_HOSTNAME": "127.0.0.1",
        "ROS_HOME": str(folder),
        "ROS_PACKAGE_PATH": f"{built / 'src'}:{ros.environment['ROS_PACKAGE_PATH']}",
        "CMAKE_PREFIX_PATH": f"{built / 'devel'}:{ros.environment.get('CMAKE_PREFIX_PATH', '')}",
    }
    with Processes(environment, folder) as processes:
        processes.start("roscore", ["roscore", "-p", str(port)])
        # Fails until the master is there.
        parameter = f"import rosgraph; rosgraph.Master('/test').setParam('/use_sim_time', {simulated})"
        command = [ros.python, "-c", parameter]
        processes.wait_until(
            lambda: subprocess.run(command, env=environment, check=False, capture_output=True).returncode == 0,
            "roscore is online",
        )
        yield processes


def _lines(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
