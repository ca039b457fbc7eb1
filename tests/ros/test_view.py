"""The page of `robosc view` beside a robot that runs: what it shows is what the node has decided."""

from __future__ import annotations

import json
import os
import re
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.request import urlopen

import pytest

import robosc
from robosc.metamodel import sct
from robosc.simulation import Simulation
from robosc.simulation.simulation import whole_state
from tests.chromium import chromium, opened, shown
from tests.ros.processes import Processes
from tests.ros.workspaces import middleware
from tests.view.robots import wholes

if TYPE_CHECKING:
    import subprocess

    from tests.ros.running import Runner
    from tests.ros.workspaces import Workspace

__all__ = ["chromium"]

HERE = Path(__file__).parent
PROJECT = HERE.parents[1]
PACKAGE = "line_follower_controller"
MODEL = PROJECT / "examples" / "line_follower" / "line_follower.rscd"
SIMULATOR = PROJECT / "examples" / "simulator"


def view(processes: Processes, runner: Runner, folder: Path, *others: Path) -> tuple[str, subprocess.Popen[bytes]]:
    """The address of the page beside the robot, and those of other models."""
    path = os.pathsep.join(filter(None, (str(PROJECT), processes.environment.get("PYTHONPATH"))))
    command = ["env", f"PYTHONPATH={path}", runner.robosc, "-m", "robosc", "view", MODEL, *others]
    command.append(f"--ros{runner.ros.version}")
    process, log = processes.start("view", command), folder / "view.log"
    address = re.compile(r"^http://\S+$", re.MULTILINE)
    processes.wait_until(lambda: address.search(log.read_text()) is not None, "the page is served")
    found = address.search(log.read_text())
    assert found is not None
    return found[0], process


def told(address: str, number: int) -> list[dict[str, Any]]:
    """The moments that the page is told, so many of them."""
    moments: list[dict[str, Any]] = []
    with urlopen(f"{address}moments", timeout=60) as stream:  # noqa: S310
        while len(moments) < number:
            line = stream.readline().decode()
            if line.startswith("data: "):
                moments += json.loads(line.removeprefix("data: "))["moments"]
    return moments


def says(processes: Processes, page: Any, part: str) -> None:
    """Waits until the page says something of where its moments come from; "": nothing."""
    status = page.locator("#status")
    processes.wait_until(lambda: (part or "@") in (status.text_content() or "@"), f"the page says: {part or 'nothing'}")


def moment(page: Any) -> int:
    """The number of the moment that the page shows."""
    return int(page.locator("body").get_attribute("data-moment"))


@pytest.mark.parametrize("kind", ["ros1_workspace", "run_ros2"])
def test_it_shows_what_the_node_decides(
    kind: str, request: pytest.FixtureRequest, chromium: Any, tmp_path: Path
) -> None:
    nodes: Workspace | Runner = request.getfixturevalue(kind)
    ros, folder = nodes.ros, tmp_path / "run"
    runner: Runner = request.getfixturevalue(f"run_ros{ros.version}")
    events = folder / "events.jsonl"
    with middleware(nodes, folder, simulated=True) as processes:
        address, viewer = view(processes, runner, folder)
        with opened(chromium, address, drawn="") as page:
            says(processes, page, f"Waiting for /{PACKAGE}")
            assert page.locator("#controls button").count() == 0
            clock = ["use_sim_time:=true"] if ros.version == 2 else []
            node = processes.start("node", nodes.node(PACKAGE, f"event_log:={events}", *clock))
            if ros.version == 2:  # In ROS 1 the node tells nothing before there is a clock.
                says(processes, page, "")
            options = ["--scenario", "line_follower", "--ros", str(ros.version), "--speed", "5"]
            world = processes.start("world", [ros.python, SIMULATOR, *options])
            processes.wait_until(lambda: world.poll() is not None, "the scenario has ended", seconds=900)
            assert world.returncode == 0, processes.logs()
            assert processes.stop(node) == 0
            says(processes, page, "to come back")
            last = moment(page)
            seen = shown(page)
            with opened(chromium, address) as late:
                assert shown(late) == seen
        moments = told(address, last + 1)
        assert processes.stop(viewer) in (0, 130)
    compare(moments, [json.loads(line) for line in events.read_text().splitlines()], ros.version)
    now = wholes(moments)[-1]
    assert {name: state for name, state, _ in seen["states"]} == {
        name.removeprefix("component_"): state for name, state in now["state"].items() if name.startswith("component_")
    }


def compare(moments: list[dict[str, Any]], log: list[dict[str, Any]], ros: int) -> None:
    """What the page was told, with what the log of the node's events says that happened."""
    robot = robosc.load(MODEL)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    simulation = Simulation(model, robosc.to_rosgraph(robot))
    happened = [entry for entry in log if entry["direction"] != "outside"]
    names = [entry["event"] for entry in happened]
    seen = [moment["event"] for moment in moments if "event" in moment]
    first = next((at for at in range(len(names)) if names[at : at + len(seen)] == seen), None)
    assert first is not None, "each event is shown, once, in its order"
    # What the node tells as it ends may be lost, and in ROS 1 what it tells before the page is connected.
    assert len(seen) > (0.9 if ros == 2 else 0.5) * len(names)
    components = [plant.name for plant in model.plants if plant.kind == sct.PlantKind.behaviour]
    at = 0
    for entry in happened[:first]:
        assert simulation.perform(entry["event"], entry.get("data", {})).accepted
        at += 1
    known = list(zip(moments, wholes(moments), strict=True))
    for _, report in groupby(known, key=lambda pair: pair[0]["time"]):
        whole: dict[str, Any] = {}
        for seen_then, whole in report:  # noqa: B007
            if "event" in seen_then:
                assert simulation.perform(seen_then["event"], happened[at].get("data", {})).accepted
                at += 1
        # The last of a report has the state that the node told.
        engine = simulation.engine
        state = whole_state(engine)
        assert {name: whole["state"][name] for name in components} == {name: state[name] for name in components}
        # And the number that the node keeps beside its supervisor.
        offsets = [
            entry["data"]["value"] for entry in happened[:at] if entry["event"] == "message_correction.u_response"
        ]
        assert whole["state"]["LineDetector.offset"] == (offsets[-1] if offsets else 0.0)
        verdicts = {command: verdict and verdict["by"] for command, verdict in whole["commands"].items()}
        assert verdicts == {command: by and str(by) for command in verdicts for by in [engine.blocked_by(command)]}


def test_without_a_master_it_waits_and_can_be_ended(run_ros1: Runner, tmp_path: Path) -> None:
    environment = {**run_ros1.environment(), "ROS_MASTER_URI": "http://127.0.0.1:1"}
    with Processes(environment, tmp_path) as processes:
        address, viewer = view(processes, run_ros1, tmp_path)
        with urlopen(f"{address}moments", timeout=60) as stream:  # noqa: S310
            assert "Waiting for /line_follower_controller" in stream.readline().decode()
        assert processes.stop(viewer) in (0, 130)
        assert processes.logs().splitlines()[1:] == [address]


@pytest.mark.parametrize("kind", [pytest.param("run_ros1", marks=pytest.mark.matrix), "run_ros2"])
def test_a_node_that_starts_again_is_followed(
    kind: str, request: pytest.FixtureRequest, chromium: Any, tmp_path: Path
) -> None:
    runner: Runner = request.getfixturevalue(kind)
    folder = tmp_path / "run"
    with middleware(runner, folder) as processes:
        node = processes.start("node", runner.node(PACKAGE))
        address, _ = view(processes, runner, folder, HERE / "times" / "patience.rscd")
        with opened(chromium, f"{address}?robot=1", drawn="") as other:
            says(processes, other, "Waiting for /patience_controller")
        with opened(chromium, address) as page:
            says(processes, page, "")
            node.kill()
            node.wait()
            before = moment(page)
            processes.start("again", runner.node(PACKAGE))
            processes.wait_until(lambda: moment(page) > before + 20, "the page goes on")
            assert {command[1] for command in shown(page)["commands"]} <= {"allowed", "forbidden", "unready"}
