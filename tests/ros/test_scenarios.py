"""The scenarios over a real ROS: each robot reaches its goal, and the controllers send no forbidden command.

The scenarios run in simulated time, as fast as the controllers answer, so the load of the machine matters little. The
independent rules of `tests/scenarios/rules` judge each controller by its event log. The line follower's scenario is in
`test_line_follower.py`, which checks the same and more.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pytest

from examples.simulator.scenarios import SCENARIOS
from tests.ros.installations import find_ros2
from tests.ros.running import Runner
from tests.ros.workspaces import EXAMPLES, Workspace, middleware
from tests.scenarios.rules.books import BOOKS
from tests.scenarios.runs import moved_while_stopped, poses

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

#: Maximum speed of the world relative to real time.
SPEED = 4
#: Seconds of the world for a command to arrive and for the robot to come to rest.
ALLOWANCE = 1.0
#: The scenario with a supervisory layer: its package, the package of its controller, and the controller's model.
LAYERS = {
    "supervised_line_follower": (
        "supervised_line_follower_layer",
        "line_stepper_controller",
        "controller/line_stepper.rscd",
    )
}
#: Scenarios with topics, with an action, and with a layer run over ROS 2, the others over ROS 1. `benchmarks/matrix.py`
#: runs all over both, except for the layer, which needs ROS 2.
OVER_ROS_2 = ("maze_solver", "simple_navigation", "supervised_line_follower")


@dataclass(frozen=True)
class LiveRun:
    """A run of a scenario: the record of the world, and the log and output of the node."""

    status: int
    said: str
    record: Sequence[dict[str, Any]]
    log: Sequence[dict[str, Any]]
    node_status: int
    node_output: str


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "run" in metafunc.fixturenames:
        runs = [
            pytest.param(
                kind,
                name,
                id=f"{kind}-{name}",
                marks=[] if (kind == "ros2") == (name in OVER_ROS_2) else [pytest.mark.matrix],
            )
            for kind in ("ros1", "ros2")
            for name in SCENARIOS
            if name != "line_follower" and not (kind == "ros1" and name in LAYERS)
        ]
        metafunc.parametrize(("kind", "name"), runs, indirect=["kind"], scope="session")


@pytest.fixture(scope="session")
def kind(request: pytest.FixtureRequest) -> Workspace | Runner:
    """Compiled nodes of each ROS version; over ROS 2 nodes run from models if there is no rclcpp to build with."""
    compiled = request.param == "ros1" or find_ros2().ros is not None
    made: Workspace | Runner = request.getfixturevalue(f"{request.param}_workspace" if compiled else "run_ros2")
    return made


@pytest.fixture(scope="session")
def run(kind: Workspace | Runner, name: str, tmp_path_factory: pytest.TempPathFactory) -> LiveRun:
    """Run a scenario from start to end."""
    folder = tmp_path_factory.mktemp(name) / "run"
    events, record = folder / "events.jsonl", folder / "record.jsonl"
    with middleware(kind, folder, simulated=True) as processes:
        nodes = [
            processes.start(f"node{number}", command)
            for number, command in enumerate(node_commands(kind, name, f"event_log:={events}"))
        ]
        command = [kind.ros.python, EXAMPLES / "simulator", "--scenario", name, "--ros", str(kind.ros.version)]
        world = processes.start("world", [*command, "--speed", str(SPEED), "--record", record])
        processes.wait_until(lambda: world.poll() is not None, "the scenario has ended", seconds=900)
        statuses = [processes.stop(node) for node in nodes]
    said = (folder / "world.log").read_text()
    output = "\n".join((folder / f"node{number}.log").read_text() for number in range(len(nodes)))
    return LiveRun(world.returncode, said, lines(record), lines(events), max(map(abs, statuses)), output)


def node_commands(kind: Workspace | Runner, name: str, log: str) -> list[list[str | Path]]:
    """Return the commands that start the controller of a scenario, or the layer and the controller behind it."""
    clock = ["use_sim_time:=true"] if kind.ros.version == 2 else []
    model = EXAMPLES / name / f"{name}.rscd"
    if name not in LAYERS:
        if isinstance(kind, Runner):
            return [[*kind.command(model, log, *clock)]]
        return [kind.node(f"{name}_controller", log, *clock)]
    layer, controller, behind = LAYERS[name]
    remappings = [f"{topic}:=/{layer}/controller{topic}" for topic in ("/correction", "/no_line", "/simple_movement")]
    if isinstance(kind, Runner):
        return [
            kind.command(model, log, *clock, layer=True),
            kind.command(EXAMPLES / name / behind, *clock, remappings=remappings),
        ]
    remapped = [word for remapping in remappings for word in ("-r", remapping)]
    return [kind.node(layer, log, *clock), [*kind.node(controller, *clock), *remapped]]


def lines(path: Path) -> list[dict[str, Any]]:
    """Return the objects in a file of JSON lines."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def test_reaches_its_goal(run: LiveRun) -> None:
    assert run.status == 0, run.said + run.node_output


def test_sends_nothing_forbidden(run: LiveRun, name: str) -> None:
    log = [*run.log]
    while name not in LAYERS and log[-1]["direction"] == "outside":
        # When a controller shuts down, it halts the robot independently of the requirements.
        log.pop()
    assert sum(entry["direction"] == "out" for entry in log) >= 3
    assert BOOKS[name]().violations(log) == []
    if name in LAYERS:
        own = sum(entry["direction"] == "outside" for entry in log)
        steps = [entry["data"]["linear"]["x"] for entry in run.record if entry["topic"] == "/simple_movement"]
        assert {*steps} == {0.0, 0.2}, "the controller's steps, and the layer's stops in their place"
        assert steps.count(0.0) <= own


def test_stands_while_stop_is_pressed(run: LiveRun) -> None:
    assert moved_while_stopped(run.record, ALLOWANCE) < 0.02


def test_touches_nothing(run: LiveRun) -> None:
    assert min(pose["gap"] for pose in poses(run.record)) >= 0


def test_the_node_ends_cleanly(run: LiveRun) -> None:
    assert run.node_status == 0, run.node_output
