"""Costs of the nodes of the eight scenarios while their robots drive: processor, memory, time of a tick."""

from __future__ import annotations

import os
import random
import re
import time
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from statistics import fmean, pstdev
from typing import TYPE_CHECKING

from benchmarks.timed_packages import EXAMPLES, HERE, STEPPER, Scenario, scenarios
from tests.ros.reactions import one_process
from tests.ros.running import Runner
from tests.ros.workspaces import Workspace, middleware

if TYPE_CHECKING:
    import subprocess

    from tests.ros.processes import Processes

LAYER = "/supervised_line_follower_layer"
#: Seconds of the start-up, before the measurement.
WARM_UP = 5.0
#: Seconds between two ticks, as the examples have it.
PERIOD = 0.1


@dataclass
class Costs:
    """Costs of a node: processor share, peak resident and virtual megabytes, nanoseconds of its ticks."""

    processor: float
    resident: float
    virtual: float
    node: list[int] = field(default_factory=list)
    engine: list[int] = field(default_factory=list)
    #: Number of times that its scenario was played to the end, and that its goal was reached.
    played: int = 0
    reached: int = 0


def costs(nodes: Workspace | Runner, folder: Path, seconds: float) -> dict[str, Costs]:
    """Run all nodes at once, each against its own world, which restarts when it ends; return the costs by title."""
    folder.mkdir()
    domain = random.randrange(1, 90)  # noqa: S311  # so that concurrent runs don't meet
    with ExitStack() as stack:
        runs = []
        for number, scenario in enumerate(scenarios(nodes.ros.version)):
            place = folder / scenario.name
            processes = stack.enter_context(middleware(nodes, place))
            processes.environment |= {"ROBOSC_TICK_TIMES": str(place / "ticks.txt"), "ROS_HOME": str(place)}
            if nodes.ros.version == 2:
                processes.environment["ROS_DOMAIN_ID"] = str(domain + number)
            runs.append(_Run(nodes, scenario, processes, place))
        _watch(runs, WARM_UP)
        before = [run.processor() for run in runs]
        began = time.monotonic()
        _watch(runs, seconds)
        passed = time.monotonic() - began
        return {
            run.scenario.title: run.end((run.processor() - start) / passed, round(passed / PERIOD))
            for run, start in zip(runs, before, strict=True)
        }


def _watch(runs: list[_Run], seconds: float) -> None:
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        for run in runs:
            run.go_on()
        time.sleep(0.2)


class _Run:
    """Node and its world."""

    def __init__(self, nodes: Workspace | Runner, scenario: Scenario, processes: Processes, folder: Path) -> None:
        self.scenario = scenario
        self._processes = processes
        self._folder = folder
        world = [nodes.ros.python, EXAMPLES / "simulator", "--scenario", scenario.name, "--until", "end"]
        self._world_command = [*world, "--ros", str(nodes.ros.version)]
        if scenario.layer:
            names = ("/correction", "/no_line", "/simple_movement")
            behind = [f"{name}:={LAYER}/controller{name}" for name in names]
            stepper = {**processes.environment, "ROBOSC_TICK_TIMES": str(folder / "stepper.txt")}
            processes.environment, kept = stepper, processes.environment
            processes.start("stepper", _node(nodes, STEPPER, behind))
            processes.environment = kept
        self._played = self._reached = 0
        self._node = processes.start("node", _node(nodes, scenario))
        self._world = self._start_world()

    def _start_world(self) -> subprocess.Popen[bytes]:
        return self._processes.start("world", self._world_command)

    def go_on(self) -> None:
        """Restart the world if it has ended. Fails if the node has ended."""
        assert self._node.poll() is None, self._processes.logs()
        if self._world.poll() is not None:
            assert self._world.returncode in (0, 1), self._processes.logs()
            self._played += 1
            self._reached += self._world.returncode == 0
            self._world = self._start_world()

    def processor(self) -> float:
        """Return the processor seconds that the node has taken."""
        fields = Path(f"/proc/{self._node.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def end(self, processor: float, ticks: int) -> Costs:
        """End the node; return its costs, with those of its last ticks."""
        status = Path(f"/proc/{self._node.pid}/status").read_text()
        resident, virtual = (int(re.findall(rf"{name}:\s+(\d+)", status)[0]) / 1024 for name in ("VmHWM", "VmSize"))
        found = Costs(processor, resident, virtual, played=self._played, reached=self._reached)
        assert self._processes.stop(self._node) == 0, self._processes.logs()
        if not self.scenario.layer:
            for line in (self._folder / "ticks.txt").read_text().splitlines()[-ticks:]:
                whole, *engine = map(int, line.split())
                found.node.append(whole)
                found.engine += engine
        return found


def _node(nodes: Workspace | Runner, scenario: Scenario, remappings: list[str] | None = None) -> list[str | Path]:
    """Return the command that starts a node, as one process."""
    if isinstance(nodes, Runner):
        command = nodes.command(scenario.model, layer=scenario.layer, remappings=remappings or [])
        timed = [*command[:1], HERE / "timed_run.py", *command[3:]]
        return [*command] if scenario.layer else timed
    command = one_process(nodes, scenario.package)
    return command + [word for remapping in remappings or [] for word in ("-r", remapping)]


def summary(times: list[int]) -> dict[str, float]:
    """Return mean, minimum, maximum and standard deviation in microseconds."""
    micro = [nanoseconds / 1000 for nanoseconds in times]
    return {"mean": fmean(micro), "min": min(micro), "max": max(micro), "deviation": pstdev(micro)}
