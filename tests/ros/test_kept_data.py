"""Arrays and objects that a node stores, over a real ROS: whole and in parts, sent when they change."""

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
    """The node executes `do route := value.poses`, `provide go with { pose: Mission.route[0] }`, and `send: change`.

    It stores nothing of unreadable data. It withholds a value with a number that is not finite as a whole, and warns.
    The event log contains the whole stored data.
    """
    folder, log = tmp_path / "run", tmp_path / "events.jsonl"
    with middleware(nodes, folder) as processes:
        processes.start("node", one_process(nodes, "keeper_controller", f"event_log:={log}"))
        out = folder / "heard.json"
        world = processes.start("world", [nodes.ros.python, HERE / "keep_data.py", str(nodes.ros.version), out])
        processes.wait_until(lambda: world.poll() is not None, "all is heard", seconds=10 * PATIENCE)
        assert world.returncode == 0, processes.logs()
        heard = json.loads(out.read_text())
        assert "stamped is withheld: its pose would not be finite" in processes.logs()
    assert heard == {
        "/again": [
            [["ab", "b", "c"], [0.5, 1.5], [1.5, -2.0]],
            [["last", "", ""], [0.5, 0.25], [0.25, 0.25]],
        ],
        "/twist": [
            [7.0, -2.0, 0.0],
            [7.0, -2.0, 9.0],
            [3.0, -2.0, 9.0],
            [3.0, -2.0, 12.0],
            [3.0, 0.25, 12.0],
            [4.0, 0.25, 12.0],
            [5.0, 0.25, 12.0],
        ],
        "/stamped": [[7.0, 0.0], [1.6, 0.5], [2.0, 0.5], [2.5, 0.25]],
        "/text": ["ab", "last"],
        # An object in which nothing was stored.
        "/seated": [1.0],
        "/turn": [1.0],
    }
    shown = {}
    for line in map(json.loads, log.read_text(encoding="utf-8").splitlines()):
        shown[line["event"]] = line.get("data")
    assert shown["message_cloud.u_response"] == {"value": {"poses": [posed(2.5, 0.25), posed(5.0, 0.125)]}}
    assert shown["message_joints.u_response"] == {
        "value": {
            "header": {"frame_id": ""},
            "name": ["last", "", ""],
            "position": [0.25, 0.25],
            "velocity": [],
            "effort": [],
        }
    }


def posed(x: float, w: float) -> dict[str, dict[str, float]]:
    return {"position": {"x": x, "y": 0, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": w}}
