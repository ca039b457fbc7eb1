"""Delays of a node's timers, measured over a real ROS by `expiry_times.py`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from tests.ros.processes import PATIENCE
from tests.ros.reactions import one_process
from tests.ros.workspaces import middleware

if TYPE_CHECKING:
    from tests.ros.running import Runner
    from tests.ros.workspaces import Workspace

HERE = Path(__file__).parent
PACKAGE = "patience_controller"
#: Duration of the timer in the model, in seconds.
DURATION = 0.2


def expiries(nodes: Workspace | Runner, folder: Path, times: int, hz: float) -> list[float]:
    """Return the times from the start of a timer to the message at its expiry, in seconds, under a load of scans.

    `folder` must not exist.
    """
    with middleware(nodes, folder) as processes:
        processes.start("node", one_process(nodes, PACKAGE))
        out = folder / "measured.json"
        command = [nodes.ros.python, HERE / "expiry_times.py", str(nodes.ros.version), out]
        world = processes.start("world", [*command, "--times", str(times), "--hz", str(hz)])
        processes.wait_until(lambda: world.poll() is not None, "all is measured", seconds=PATIENCE * (1 + times))
        assert world.returncode == 0, processes.logs()
        found: list[float] = json.loads(out.read_text())
        return found
