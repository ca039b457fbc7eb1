"""The page of `robosc view` beside a ROS 2 robot shows the decisions of the node."""

from __future__ import annotations

import json
import os
import re
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.request import urlopen

import robosc
from robosc.model import sct
from robosc.run.simulation import Simulation
from robosc.run.simulation.simulation import whole_state
from tests.chromium import chromium, opened, shown
from tests.ros.workspaces import middleware
from tests.tools.view.robots import wholes

if TYPE_CHECKING:
    import subprocess

    from tests.ros.processes import Processes
    from tests.ros.running import Runner

__all__ = ["chromium"]

HERE = Path(__file__).parent
PROJECT = HERE.parents[1]
PACKAGE = "line_follower_controller"
MODEL = PROJECT / "examples" / "line_follower" / "line_follower.rscd"
SIMULATOR = PROJECT / "examples" / "simulator"


def view(processes: Processes, runner: Runner, folder: Path, *others: Path) -> tuple[str, subprocess.Popen[bytes]]:
    """Start the page for the robot and other models; return its address and the process."""
    path = os.pathsep.join(filter(None, (str(PROJECT), processes.environment.get("PYTHONPATH"))))
    command = ["env", f"PYTHONPATH={path}", runner.ros.python, "-m", "robosc", "view", MODEL, *others, "--ros2"]
    process, log = processes.start("view", command), folder / "view.log"
    address = re.compile(r"^http://\S+$", re.MULTILINE)
    processes.wait_until(lambda: address.search(log.read_text()) is not None, "the page is served")
    found = address.search(log.read_text())
    assert found is not None
    return found[0], process


def told(address: str, number: int) -> list[dict[str, Any]]:
    """Return the first `number` moments that the page receives."""
    moments: list[dict[str, Any]] = []
    with urlopen(f"{address}moments", timeout=60) as stream:  # noqa: S310
        while len(moments) < number:
            line = stream.readline().decode()
            if line.startswith("data: "):
                moments += json.loads(line.removeprefix("data: "))["moments"]
    return moments


def says(processes: Processes, page: Any, part: str) -> None:
    """Wait until the page shows a certain status of its source; "" means no status."""
    status = page.locator("#status")
    processes.wait_until(lambda: (part or "@") in (status.text_content() or "@"), f"the page says: {part or 'nothing'}")


def moment(page: Any) -> int:
    """Return the number of the moment that the page shows."""
    return int(page.locator("body").get_attribute("data-moment"))


def test_it_shows_what_the_node_decides(run_ros2: Runner, chromium: Any, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    events = folder / "events.jsonl"
    with middleware(run_ros2, folder, simulated=True) as processes:
        address, viewer = view(processes, run_ros2, folder)
        with opened(chromium, address, drawn="") as page:
            says(processes, page, f"Waiting for /{PACKAGE}")
            assert page.locator("#controls button").count() == 0
            node = processes.start("node", run_ros2.node(PACKAGE, f"event_log:={events}", "use_sim_time:=true"))
            says(processes, page, "")
            options = ["--scenario", "line_follower", "--ros", "2", "--speed", "5"]
            world = processes.start("world", [run_ros2.ros.python, SIMULATOR, *options])
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
    compare(moments, [json.loads(line) for line in events.read_text().splitlines()])
    now = wholes(moments)[-1]
    assert {name: state for name, state, _ in seen["states"]} == {
        name.removeprefix("component_"): state for name, state in now["state"].items() if name.startswith("component_")
    }


def compare(moments: list[dict[str, Any]], log: list[dict[str, Any]]) -> None:
    """Compare the moments of the page with the event log of the node."""
    robot = robosc.load(MODEL)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    simulation = Simulation(model, robosc.to_rosgraph(robot))
    happened = [entry for entry in log if entry["direction"] != "outside"]
    names = [entry["event"] for entry in happened]
    seen = [moment["event"] for moment in moments if "event" in moment]
    first = next((at for at in range(len(names)) if names[at : at + len(seen)] == seen), None)
    assert first is not None, "each event is shown, once, in its order"
    # The last output of an ending node may be lost.
    assert len(seen) > 0.9 * len(names)
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
        # The last moment of a report has the state that the node reported.
        engine = simulation.engine
        state = whole_state(engine)
        assert {name: whole["state"][name] for name in components} == {name: state[name] for name in components}
        # It also has the number that the node stores beside its supervisor.
        offsets = [
            entry["data"]["value"] for entry in happened[:at] if entry["event"] == "message_correction.u_response"
        ]
        assert whole["state"]["LineDetector.offset"] == (offsets[-1] if offsets else 0.0)
        verdicts = {command: verdict and verdict["by"] for command, verdict in whole["commands"].items()}
        assert verdicts == {command: by and str(by) for command in verdicts for by in [engine.blocked_by(command)]}


def test_a_node_that_starts_again_is_followed(run_ros2: Runner, chromium: Any, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with middleware(run_ros2, folder) as processes:
        node = processes.start("node", run_ros2.node(PACKAGE))
        address, _ = view(processes, run_ros2, folder, HERE / "times" / "patience.rscd")
        with opened(chromium, f"{address}?robot=1", drawn="") as other:
            says(processes, other, "Waiting for /patience_controller")
        with opened(chromium, address) as page:
            says(processes, page, "")
            node.kill()
            node.wait()
            before = moment(page)
            processes.start("again", run_ros2.node(PACKAGE))
            processes.wait_until(lambda: moment(page) > before + 20, "the page goes on")
            assert {command[1] for command in shown(page)["commands"]} <= {"allowed", "forbidden", "unready"}
