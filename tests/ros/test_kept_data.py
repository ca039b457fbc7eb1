"""Arrays and objects that a node keeps, over a real ROS: stored whole and in parts, handed on when they change."""

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


def test_what_came_in_is_kept_and_handed_on(nodes: Workspace | Runner, tmp_path: Path) -> None:
    """`do route := value.poses`, `provide go with { pose: Mission.route[0] }`, `send: change`; of what can't be read
    nothing is stored."""
    folder = tmp_path / "run"
    with middleware(nodes, folder) as processes:
        processes.start("node", one_process(nodes, "keeper_controller"))
        out = folder / "heard.json"
        world = processes.start("world", [nodes.ros.python, HERE / "keep_data.py", str(nodes.ros.version), out])
        processes.wait_until(lambda: world.poll() is not None, "all is heard", seconds=10 * PATIENCE)
        assert world.returncode == 0, processes.logs()
        heard = json.loads(out.read_text())
    assert heard == {
        "/again": [
            [["ab", "b", "c"], [0.5, 1.5], [1.5, -2.0]],
            [["last", "", ""], [0.5, 0.25], [0.25, 0.25]],
        ],
        "/twist": [[7.0, -2.0, 0.0], [7.0, -2.0, 9.0], [3.0, -2.0, 9.0], [3.0, -2.0, 12.0], [3.0, 0.25, 12.0]],
        "/stamped": [[7.0, 0.0], [1.6, 0.5]],
        "/text": ["ab", "last"],
    }
