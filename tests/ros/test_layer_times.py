"""Times of a supervisory layer in a running ROS graph: commands that they permit, and commands that they block."""

from __future__ import annotations

import itertools
import json
from typing import TYPE_CHECKING, Any

from tests.ros.faults.partners import Peer
from tests.ros.running import Runner
from tests.ros.workspaces import HERE, middleware

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.workspaces import Workspace

LAYER, GUARD = "guard_layer", HERE.parent / "run" / "runtime" / "guard.rscd"
SCAN, BLIND, ROTATING = "message_scan.u_response", "component_Base.u_after1", "component_Base.u_after2"
MOVE = "message_move.c_trigger"


def test_times_let_pass_and_block(layers: Workspace | Runner, tmp_path: Path) -> None:
    """`after 1.0 s goto rotating` permits moves, `after 500 ms without scan goto blind` blocks them."""
    folder, log = tmp_path / "run", tmp_path / "events.jsonl"
    parameter = f"event_log:={log}"
    with middleware(layers, folder) as processes:
        layer = processes.start(
            "layer",
            layers.command(GUARD, parameter, layer=True)
            if isinstance(layers, Runner)
            else layers.node(LAYER, parameter),
        )
        sides = [Peer(processes, layers.ros.python, layers.ros.version, name) for name in ("robot", "controller")]
        robot, controller = sides
        moves = f"/{LAYER}/controller/move"
        for peer, topic in ((robot, "/scan"), (controller, moves)):
            peer.do("advertise", topic=topic, kind="std_msgs/Empty")
        robot.do("listen", topic="/move", kind="std_msgs/Empty")
        controller.do("repeat", topic=moves, fields={}, hz=50)
        processes.wait_until(lambda: last(lines(log), BLIND) >= 0, "no scan comes")
        processes.wait_until(lambda: any(entry["direction"] == "blocked" for entry in lines(log)), "a move is blocked")
        robot.do("repeat", topic="/scan", fields={}, hz=50)
        robot.wait("heard", value="/move")
        robot.do("silence", topic="/scan")
        processes.wait_until(lambda: ended(lines(log)), "moves are blocked again")
        assert processes.stop(layer) == 0
    entries = lines(log)
    passed = next(at for at, entry in enumerate(entries) if (entry["direction"], entry["event"]) == ("out", MOVE))
    blind, rotating = (last(entries[:passed], event) for event in (BLIND, ROTATING))
    began = next(at for at, entry in enumerate(entries) if at > blind and entry["event"] == SCAN)
    assert blind < began < rotating
    assert entries[rotating]["time"] - entries[began]["time"] >= 1.0
    blind = last(entries, BLIND)
    silent = last(entries[:blind], SCAN)
    assert passed < blind
    assert entries[blind]["time"] - entries[silent]["time"] >= 0.5
    after = itertools.takewhile(lambda entry: entry["event"] != SCAN, entries[blind:])
    assert {entry["direction"] for entry in after if entry["event"] == MOVE} == {"blocked"}
    assert {entry["direction"] for entry in entries if entry["event"] in {BLIND, ROTATING}} == {"internal"}


def lines(log: Path) -> list[dict[str, Any]]:
    """Return the entries of an event log without an incomplete last line."""
    if not log.exists():
        return []
    return [json.loads(line) for line in log.read_text().splitlines(keepends=True) if line.endswith("\n")]


def ended(entries: list[dict[str, Any]]) -> bool:
    """Whether the layer has forwarded moves, and now blocks them because no scan arrives."""
    moves = [entry["direction"] for entry in entries if entry["event"] == MOVE]
    silent, blind = (last(entries, event) for event in (SCAN, BLIND))
    return silent < blind and "out" in moves and any(entry["event"] == MOVE for entry in entries[blind:])


def last(entries: list[dict[str, Any]], event: str) -> int:
    """Return the index of the last entry of an event, or -1."""
    return max((at for at, entry in enumerate(entries) if entry["event"] == event), default=-1)
