"""One drive of the line follower over a real ROS: everything is built and run once, the tests read what came of it."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from tests.ros.installations import Ros, find_ros1, find_ros2, free_port
from tests.ros.processes import Processes

EXAMPLE = Path(__file__).parents[2] / "examples" / "line_follower"
PACKAGE = "line_follower_controller"


@dataclass(frozen=True)
class Drive:
    """What the build said, what crossed the world's topics, what the node did in its own order, what it reported."""

    build: str
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


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "drive" in metafunc.fixturenames:
        metafunc.parametrize("drive", ["ros1", "ros2"], indirect=True, scope="session")


@pytest.fixture(scope="session")
def drive(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Drive:
    found = find_ros1() if request.param == "ros1" else find_ros2()
    if found.ros is None:
        reason = f"{request.param}: {', '.join(found.missing)}"
        if request.param in os.environ.get("ROBOSC_REQUIRE", "").split(","):
            pytest.fail(reason)
        pytest.skip(reason)
    folder = tmp_path_factory.mktemp(request.param)
    package = generate(request.param, folder)
    build = found.ros.built(folder)
    run = _run1 if found.ros.version == 1 else _run2
    return run(found.ros, folder, package, build)


def generate(target: str, workspace: Path) -> Path:
    """Generates the example's package into a workspace."""
    package = workspace / "src" / PACKAGE
    subprocess.run(
        [sys.executable, "-m", "robosc", "transform", EXAMPLE / "line_follower.rscd", "--to", target, "-o", workspace],
        check=True,
    )
    package.parent.mkdir()
    (workspace / target / PACKAGE).rename(package)
    return package


def _run1(ros: Ros, folder: Path, package: Path, build: str) -> Drive:
    port = free_port()
    environment = ros.environment | {
        "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
        "ROS_IP": "127.0.0.1",
        "ROS_HOSTNAME": "127.0.0.1",
        "ROS_HOME": str(folder),
        "ROS_LOG_DIR": str(folder / "log"),
        "ROS_PACKAGE_PATH": f"{folder / 'src'}:{ros.environment['ROS_PACKAGE_PATH']}",
        "CMAKE_PREFIX_PATH": f"{folder / 'devel'}:{ros.environment.get('CMAKE_PREFIX_PATH', '')}",
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    with Processes(environment, folder) as processes:
        processes.start("roscore", ["roscore", "-p", str(port)])
        online = [ros.python, "-c", "import rosgraph, sys; sys.exit(not rosgraph.is_master_online())"]
        processes.wait_until(
            lambda: subprocess.run(online, env=environment, check=False).returncode == 0, "roscore is online"
        )
        simulated = "import rosgraph; rosgraph.Master('/test').setParam('/use_sim_time', True)"
        subprocess.run([ros.python, "-c", simulated], env=environment, check=True)
        # Through the generated launch file, which so is tried too.
        node = ["roslaunch", "--wait", PACKAGE, f"{PACKAGE}.launch", f"event_log:={folder / 'events.jsonl'}"]
        return _drive(ros, processes, folder, node, build)


def _run2(ros: Ros, folder: Path, package: Path, build: str) -> Drive:
    environment = ros.environment | {
        "ROS_DOMAIN_ID": str(random.randrange(1, 100)),  # noqa: S311  # so that runs side by side don't meet
        "ROS_LOG_DIR": str(folder / "log"),
        "LD_LIBRARY_PATH": f"{folder / 'install' / PACKAGE / 'lib'}:{ros.environment.get('LD_LIBRARY_PATH', '')}",
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    with Processes(environment, folder) as processes:
        log = f"event_log:={folder / 'events.jsonl'}"
        node = [ros.executable(folder, PACKAGE), "--ros-args", "-p", "use_sim_time:=true", "-p", log]
        return _drive(ros, processes, folder, node, build)


def _drive(ros: Ros, processes: Processes, folder: Path, command: list[Any], build: str) -> Drive:
    reports, record = folder / "reports.jsonl", folder / "record.jsonl"
    listener = processes.start(
        "reports", [ros.python, Path(__file__).parent / "reports.py", str(ros.version), PACKAGE, reports]
    )
    processes.wait_until(reports.exists, "somebody listens to the node's reports")
    node = processes.start("node", command)
    script = EXAMPLE / f"world_ros{ros.version}.py"
    world = processes.start("world", [ros.python, script, "--lockstep", "--record", record])
    processes.wait_until(lambda: world.poll() is not None, "the scenario has ended", seconds=180)
    assert world.returncode == 0, processes.logs()
    status = processes.stop(node)
    processes.stop(listener)
    return Drive(
        build,
        *(_lines(each) for each in (record, folder / "events.jsonl", reports)),
        status,
        (folder / "node.log").read_text(),
    )


def _lines(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
