"""Packages with tests: `rostest`, `launch_testing` or the player alone play traces against nodes."""

from __future__ import annotations

import itertools
import json
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest

from tests.ros.workspaces import CPP, EXAMPLES, RUNTIME, Workspace, middleware

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.running import Runner

MODELS = {
    "line_follower_controller": (EXAMPLES / "line_follower" / "line_follower.rscd", None),
    "porter_controller": (CPP / "porter.rscd", CPP / "porter-config.json"),
    "waypoints_controller": (RUNTIME / "waypoints.rscd", None),
}


def rostest(workspace: Workspace, package: str, folder: Path, trace: str = "tour_1") -> tuple[int, str]:
    """Return the exit status of `rostest`, and the messages of failed tests."""
    folder.mkdir(exist_ok=True)
    results = folder / "results"
    command = ["rostest", "--results-base-dir", results, package, "play_trace.test", f"trace:={trace}"]
    environment = workspace.environment() | {
        "ROS_HOME": str(folder),
        "ROS_LOG_DIR": str(folder / "log"),
        "ROS_IP": "127.0.0.1",
        "ROS_HOSTNAME": "127.0.0.1",
        "TMPDIR": str(folder),
    }
    done = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=900, check=False, cwd=folder
    )
    (result,) = results.rglob(f"rosunit-{trace}.xml")
    suite = ElementTree.parse(result).getroot()  # noqa: S314  # rosunit's own
    assert suite.get("tests") == "1", done.stdout + done.stderr
    return done.returncode, "\n".join(failure.text or "" for failure in suite.iter("failure"))


@pytest.mark.parametrize("package", MODELS)
def test_the_compiled_node_follows_its_trace(ros1_workspace: Workspace, package: str, tmp_path: Path) -> None:
    assert rostest(ros1_workspace, package, tmp_path) == (0, "")


def test_a_node_that_dropped_a_requirement_does_not(ros1_workspace: Workspace, tmp_path: Path) -> None:
    status, failure = rostest(ros1_workspace, "careless_controller", tmp_path)
    assert status != 0
    assert "the trace has out message_halt.c_trigger" in failure
    assert "but the node did out message_move.c_trigger" in failure


def test_the_log_of_a_drive_is_a_trace(ros1_workspace: Workspace, tmp_path: Path) -> None:
    """The log of a simulated controller is a trace until the robot drives; its later ticks are late."""
    package = "line_follower_controller"
    log = ros1_workspace.folder / "src" / package / "test" / "traces" / "drive.jsonl"
    log.unlink(missing_ok=True)
    command = [sys.executable, EXAMPLES / "simulator", "--scenario", "line_follower", "--until", "1.2", "--log", log]
    subprocess.run(command, check=False, capture_output=True)  # the robot does not reach its goal
    events = [json.loads(line)["event"] for line in log.read_text(encoding="utf-8").splitlines()]
    assert "message_move.c_trigger" in events[events.index("message_halt.c_trigger") :]
    assert rostest(ros1_workspace, package, tmp_path, "drive") == (0, "")


def test_scenarios_are_played_against_the_compiled_node(ros1_workspace: Workspace, tmp_path: Path) -> None:
    package, example = "line_follower_controller", EXAMPLES / "line_follower"
    traces = ros1_workspace.folder / "src" / package / "test" / "traces"
    files = [example / "line_follower.rscd", example / "line_follower.scenarios"]
    command = [sys.executable, "-m", "robosc", "test", *files, "--traces", tmp_path / "traces"]
    subprocess.run(command, check=True, capture_output=True)
    for name in ("scenario_1", "scenario_2", "scenario_3", "scenario_4"):
        shutil.copy(tmp_path / "traces" / f"{name}.jsonl", traces)
        assert rostest(ros1_workspace, package, tmp_path / name, name) == (0, ""), name


def test_catkin_knows_the_tests(ros1_workspace: Workspace) -> None:
    targets = subprocess.run(
        ["make", "-C", ros1_workspace.folder / "build", "help"],
        env=ros1_workspace.environment(),
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    for package in MODELS:
        assert f"run_tests_{package}_rostest_play_trace__trace_tour_1.test\n" in targets


@pytest.mark.parametrize("package", MODELS)
def test_the_node_run_over_ros_2_follows_its_trace(run_ros2: Runner, package: str, tmp_path: Path) -> None:
    play_model(run_ros2, package, tmp_path)


def test_the_node_run_over_kilted_follows_its_trace(run_kilted: Runner, tmp_path: Path) -> None:
    play_model(run_kilted, "porter_controller", tmp_path)


def play_model(runner: Runner, package: str, folder: Path) -> None:
    """Play the trace of a package against the node that `robosc run` starts."""
    model, configuration = MODELS[package]
    settings = ["--config", str(configuration)] if configuration else []
    robosc = [runner.ros.python, "-m", "robosc", "transform", str(model), "--to", "ros2", "--with-tests", *settings]
    subprocess.run([*robosc, "-o", folder], check=True, capture_output=True, env=runner.environment())
    test = folder / "ros2" / package / "test"
    play(runner, runner.command(model, *parameters(test, folder), configuration=configuration), test, folder)


@pytest.mark.parametrize("package", MODELS)
def test_the_compiled_node_of_ros_2_follows_its_trace(ros2_workspace: Workspace, package: str, tmp_path: Path) -> None:
    test = ros2_workspace.folder / "src" / package / "test"
    play(ros2_workspace, ros2_workspace.node(package, *parameters(test, tmp_path)), test, tmp_path)


@pytest.mark.parametrize("package", [*MODELS, "managed_porter"])
def test_launch_testing_plays_the_trace(ros2_workspace: Workspace, package: str, tmp_path: Path) -> None:
    test = ros2_workspace.folder / "src" / package / "test" / "test_trace.py"
    status, said = launch_test(ros2_workspace, test, tmp_path)
    assert (status, said.count("OK")) == (0, 2), said


def test_launch_testing_fails_where_the_node_leaves_the_trace(ros2_workspace: Workspace, tmp_path: Path) -> None:
    package = ros2_workspace.folder / "src" / "line_follower_controller" / "test"
    lines = (package / "traces" / "tour_1.jsonl").read_text(encoding="utf-8").splitlines()
    events = [json.loads(line) for line in lines]
    # The player notices a missing line only if the next line differs.
    pairs = enumerate(itertools.pairwise(events))
    sent = next(at for at, (line, later) in pairs if line["direction"] == "out" and line["event"] != later["event"])
    trace = tmp_path / "wrong.jsonl"
    trace.write_text("\n".join(lines[:sent] + lines[sent + 1 :]), encoding="utf-8")
    status, said = launch_test(ros2_workspace, package / "test_trace.py", tmp_path, trace)
    assert status != 0
    assert f"wrong.jsonl: line {sent + 1}: the trace has" in said


@pytest.mark.parametrize("package", MODELS)
def test_colcon_knows_the_tests(ros2_workspace: Workspace, package: str, tmp_path: Path) -> None:
    with_launch_testing(ros2_workspace)
    messages = ";".join(str(path) for path in (ros2_workspace.folder / "install").iterdir())
    package_folder = (ros2_workspace.folder / "src" / package).resolve()
    cmake = ["cmake", "-DBUILD_TESTING=ON", f"-DCMAKE_PREFIX_PATH={messages}", package_folder]
    environment = ros2_workspace.environment()
    subprocess.run(cmake, cwd=tmp_path, env=environment, check=True, capture_output=True)
    listed = subprocess.run(["ctest", "-N"], cwd=tmp_path, env=environment, check=True, capture_output=True, text=True)
    assert "play_tour_1" in listed.stdout


def with_launch_testing(workspace: Workspace) -> None:
    """Skip the test without launch_testing, which is not part of rclcpp."""
    found = subprocess.run(
        [workspace.ros.python, "-c", "import launch_ros, launch_testing"],
        env=workspace.environment(),
        check=False,
        capture_output=True,
    )
    if found.returncode != 0:
        pytest.skip("no launch_testing, or no launch_ros, beside rclcpp")


def launch_test(workspace: Workspace, test: Path, folder: Path, trace: Path | None = None) -> tuple[int, str]:
    """Return the exit status and the output of `launch_test`."""
    with_launch_testing(workspace)
    with middleware(workspace, folder / "run") as processes:
        # This run has a ROS domain of its own.
        done = subprocess.run(
            ["launch_test", test, *([f"trace:={trace}"] if trace else [])],
            env=processes.environment,
            capture_output=True,
            text=True,
            timeout=900,
            check=False,
            cwd=folder,
        )
    return done.returncode, done.stdout + done.stderr


def parameters(test: Path, folder: Path) -> list[str]:
    """Return the parameters that the launch file gives the node."""
    known = json.loads((test / "connections.json").read_text(encoding="utf-8"))
    found = {"use_sim_time": "true", "watchdog_stops": "false", "event_log": str(folder / "events.jsonl")}
    for kind in ("services", "actions"):
        for client in known[kind]:
            found["retry_ms"] = str(round(client["retry"] * 1000))
            if "timeout" in client:
                found["service_timeout_ms"] = str(round(client["timeout"] * 1000))
    return [f"{name}:={value}" for name, value in found.items()]


def play(nodes: Workspace | Runner, node: list[str] | list[str | Path], test: Path, folder: Path) -> None:
    with middleware(nodes, folder / "run") as processes:
        processes.start("node", node)
        trace = test / "traces" / "tour_1.jsonl"
        command = [nodes.ros.python, test / "play_trace.py", trace, folder / "events.jsonl"]
        player = processes.start("player", command)
        processes.wait_until(lambda: player.poll() is not None, "the trace has been played", seconds=900)
        assert player.returncode == 0, processes.logs()
