"""Reaction times of a line follower, measured over a real ROS by `reaction_times.py`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from tests.ros.processes import PATIENCE
from tests.ros.workspaces import Workspace, middleware

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.ros.processes import Processes
    from tests.ros.running import Runner

HERE = Path(__file__).parent
PACKAGE = "line_follower_controller"
SENSORS_HZ = 30


def one_process(nodes: Workspace | Runner, package: str, *parameters: str) -> list[str | Path]:
    """Return the command that starts a node without any other process, with parameters (`name:=value`)."""
    if isinstance(nodes, Workspace) and nodes.ros.version == 1:
        executable = nodes.folder / f"devel/lib/{package}/{package}"
        return [executable, f"__name:={package}", *(f"_{parameter}" for parameter in parameters)]
    return [*nodes.node(package, *parameters)]


def reactions(
    nodes: Workspace | Runner,
    folder: Path,
    reason: str,
    times: int,
    parameters: Sequence[str] = (),
    *,
    hz: float = SENSORS_HZ,
) -> tuple[list[float], list[float]]:
    """Return the seconds from an input (`stop` or `obstacle`) to the first zero of the robot, at random moments.

    Also returns round trips of an echo, measured in between. The sensors publish at 30 Hz; for a `stop`, at `hz`.
    `folder` must not exist.
    """
    with middleware(nodes, folder) as processes:
        processes.start("node", one_process(nodes, PACKAGE, *parameters))
        if reason == "stop":
            processes.start("sensors", [nodes.ros.python, HERE / "sensors.py", str(nodes.ros.version), str(hz)])
        return _measured(nodes, folder, processes, reason, times)


def reactions_without_ticks(nodes: Workspace | Runner, folder: Path, times: int) -> tuple[list[float], list[float]]:
    """Measure like `reactions` for obstacles, with a control loop whose next tick never comes."""
    period = 3600
    parameters = [f"period_ms:={1000 * period}", "reactions_per_tick:=65535"]
    if nodes.ros.version == 2:
        parameters.append("use_sim_time:=true")
    with middleware(nodes, folder, simulated=True) as processes:
        processes.start("node", one_process(nodes, PACKAGE, *parameters))
        return _measured(nodes, folder, processes, "obstacle", times, "--frozen", str(period))


def _measured(
    nodes: Workspace | Runner, folder: Path, processes: Processes, reason: str, times: int, *options: str
) -> tuple[list[float], list[float]]:
    python, version, out = nodes.ros.python, str(nodes.ros.version), folder / "measured.json"
    processes.start("echo", [python, HERE / "echo.py", version])
    command = [python, HERE / "reaction_times.py", version, out, "--reason", reason, "--times", str(times)]
    world = processes.start("world", [*command, *options])
    processes.wait_until(lambda: world.poll() is not None, "all is measured", seconds=PATIENCE * (1 + times))
    assert world.returncode == 0, processes.logs()
    found = json.loads(out.read_text())
    return found["reactions"], found["echoes"]
