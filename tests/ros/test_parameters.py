"""Parameters of a model over a real ROS: set at the start, and in ROS 2 while the node runs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.ros.processes import PATIENCE
from tests.ros.reactions import one_process
from tests.ros.workspaces import middleware

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.ros.running import Runner
    from tests.ros.workspaces import Workspace

HERE = Path(__file__).parent


def test_they_are_set_at_the_start(nodes: Workspace | Runner, tmp_path: Path) -> None:
    """Data and times have the values of the parameters from the start, also in ROS 1."""
    dot = "/" if nodes.ros.version == 1 else "."
    given = ("speed:=0.5", f"Base{dot}factor:=1.0", f"Lamp{dot}pause:=0.02")
    assert heard(nodes, tmp_path / "run", given) == {"lit": True}


def heard(nodes: Workspace | Runner, folder: Path, given: Sequence[str], *options: str) -> Any:
    """Run a node with these parameters; return the result of `set_parameters.py`."""
    with middleware(nodes, folder) as processes:
        processes.start("node", one_process(nodes, "cruise_controller", *given))
        out = folder / "heard.json"
        script = [nodes.ros.python, HERE / "set_parameters.py", str(nodes.ros.version), out, *options]
        world = processes.start("world", script)
        processes.wait_until(lambda: world.poll() is not None, "all is set", seconds=10 * PATIENCE)
        assert world.returncode == 0, processes.logs()
        return json.loads(out.read_text())


def test_they_change_while_the_node_runs(nodes: Workspace | Runner, tmp_path: Path) -> None:
    """The node declares ranges and descriptions, applies changes between batches, and rejects unfit values."""
    if nodes.ros.version == 1:
        pytest.skip("ROS 1 reads parameters at the start")
    found = heard(nodes, tmp_path / "run", (), "--running")
    assert found["told"] == {
        "speed": {
            "description": "How fast the robot drives, in metres per second.",
            "read_only": False,
            "bounds": [[0.05, 1.0]],
        },
        "least": {"description": "", "read_only": False, "bounds": [[1, 5]]},
        "reach": {"description": "", "read_only": False, "bounds": []},
        "Base.factor": {"description": "", "read_only": False, "bounds": [[-2.0, 2.0]]},
        "Lamp.pause": {
            "description": "How long no range has come when the lamp goes on.",
            "read_only": False,
            "bounds": [[0.02, 60.0]],
        },
    }
    assert all(found["refused"]), found["refused"]
    assert found["taken"] == [None, None, None, None]
    assert found["silent"] == []
    assert found["lit"] == [False, True]
