"""Nodes run from their models behave like compiled ones; faults prevent them from starting."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.ros.workspaces import middleware
from tests.sharing import own_domain

if TYPE_CHECKING:
    from tests.ros.running import Runner
    from tests.ros.workspaces import Workspace

HERE = Path(__file__).parent
PACKAGE = "courier_controller"
LISTEN = HERE.parents[1] / "examples" / "listen.py"
LINE_FOLLOWER = HERE.parents[1] / "examples" / "line_follower" / "line_follower.rscd"
NAVIGATION = HERE.parents[1] / "examples" / "simple_navigation" / "simple_navigation.rscd"


def delivered(nodes: Workspace | Runner, folder: Path) -> tuple[dict[str, Any], set[str]]:
    """Return the courier's reports and messages after each input, and the distinct lines of its log without times."""
    steps, log = folder / "steps.json", folder / "events.jsonl"
    with middleware(nodes, folder) as processes:
        processes.start("node", nodes.node(PACKAGE, f"event_log:={log}"))
        command = [nodes.ros.python, HERE / "send_to_courier.py", "2", steps]
        client = processes.start("client", command)
        processes.wait_until(lambda: client.poll() is not None, "all steps are done", seconds=600)
        assert client.returncode == 0, processes.logs()
    results = json.loads(steps.read_text())
    for step in results.values():
        header = step["sent"].get("target", {}).get("header", {})
        header.pop("stamp", None)
        step.pop("typed", None)  # only built packages have its type
    return results, {line.partition(",")[2] for line in log.read_text(encoding="utf-8").splitlines()}


def test_it_does_what_the_compiled_node_does(run_ros2: Runner, ros2_workspace: Workspace, tmp_path: Path) -> None:
    compiled = delivered(ros2_workspace, tmp_path / "compiled")
    run = delivered(run_ros2, tmp_path / "run")
    assert run[0] == compiled[0]
    assert run[1] == compiled[1], "the same bytes, but for the time"


def test_a_package_that_is_not_built_is_named(run_ros2: Runner) -> None:
    environment = {**run_ros2.environment(), "PYTHONPATH": ""}
    done = subprocess.run(run_ros2.command(NAVIGATION), env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "the ROS package nav2_msgs is not built for Python here" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_log_folder_that_can_not_be_written_is_named(run_ros2: Runner) -> None:
    environment = {**run_ros2.environment(), "ROS_LOG_DIR": "/proc/log"}
    done = subprocess.run(run_ros2.command(LINE_FOLLOWER), env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "Failed to create log directory '/proc/log'" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("parameter", ["period_ms:=0", "period_ms:=often"])
def test_a_parameter_out_of_range_is_named(run_ros2: Runner, parameter: str, tmp_path: Path) -> None:
    with middleware(run_ros2, tmp_path / "run") as processes:
        node = processes.start("node", run_ros2.command(LINE_FOLLOWER, parameter))
        processes.wait_until(lambda: node.poll() is not None, "the node gives up")
        assert node.returncode == 2
        text = processes.logs()
        assert "period_ms" in text
        assert "Traceback" not in text


def test_it_says_what_it_hears_and_sends(run_ros2: Runner, tmp_path: Path) -> None:
    with middleware(run_ros2, tmp_path / "run") as processes:
        processes.start("node", run_ros2.command(LINE_FOLLOWER))
        said = "line_follower_controller runs: hears"
        processes.wait_until(lambda: said in processes.logs(), "it says so at its start")
        (line,) = (line for line in processes.logs().splitlines() if said in line)
        assert "/scan" in line.partition("sends")[0]
        assert "/cmd_vel" in line.partition("sends")[2]
        assert "Ctrl-C ends it." in line


def test_its_reports_can_be_listened_to_without_the_commands_of_ros_2(run_ros2: Runner, tmp_path: Path) -> None:
    with middleware(run_ros2, tmp_path / "run") as processes:
        processes.start("node", run_ros2.command(LINE_FOLLOWER))
        listener = processes.start("listener", [run_ros2.ros.python, LISTEN, "line_follower_controller/state"])
        heard = tmp_path / "run" / "listener.log"
        processes.wait_until(lambda: heard.read_text().count("\n") > 1, "it reports, and somebody listens")
        topic, _, report = heard.read_text().splitlines()[0].partition(": ")
        assert topic == "/line_follower_controller/state"
        assert json.loads(report)["robot"] == "LineFollower"
        assert processes.stop(listener) == 0


def test_a_stop_does_not_wait_behind_a_fast_topic(run_ros2: Runner) -> None:
    with own_domain() as domain:
        environment = run_ros2.environment() | {"ROS_DOMAIN_ID": str(domain)}
        command = [run_ros2.ros.python, HERE / "take_ros2.py"]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) < 50
