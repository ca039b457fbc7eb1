"""The robot of docs/tutorial.md drives over ROS 2 as the page describes, in the room of that page."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.docs.pages import ROOT, blocks
from tests.docs.running import Desk, commands, matches
from tests.ros.running import Runner, run_ros2
from tests.ros.workspaces import middleware

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["run_ros2"]

pytestmark = pytest.mark.ros

BLOCKS = blocks(ROOT / "docs" / "tutorial.md")


def test_it_drives_and_touches_nothing(run_ros2: Runner, tmp_path: Path) -> None:
    desk = Desk(tmp_path)
    for block in BLOCKS:
        if "file" in block.marks and "desk" not in block.marks["file"]:
            desk.write(block)
    folder = desk.root / "wanderer"
    (started,) = [block for block in BLOCKS if block.text.startswith("robosc run ")]
    (driven,) = [block for block in BLOCKS if block.marks.get("tested by", "").endswith("test_tutorial.py")]
    assert started.text == "robosc run wanderer.rscd --ros2\n"
    ((command, shown),) = commands(driven)
    assert command == "python room.py"
    with middleware(run_ros2, tmp_path / "run") as processes:
        node = processes.start("node", run_ros2.command(folder / "wanderer.rscd"))
        room = processes.start("room", [run_ros2.ros.python, "-u", folder / "room.py"])
        processes.wait_until(lambda: room.poll() is not None or node.poll() is not None, "the room ends", seconds=300)
        assert room.poll() == 0, processes.logs()
        told = (tmp_path / "run" / "room.log").read_text(encoding="utf-8")
        assert shown is not None
        assert matches(told, shown), told
        assert told.count("a wall ahead") >= 2
        assert processes.stop(node) == 0, processes.logs()
