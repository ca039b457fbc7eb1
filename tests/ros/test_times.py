"""Times over a real ROS. How late they are depends on the machine: `benchmarks/expiry.py` measures it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.ros.expiries import DURATION, expiries

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.running import Runner
    from tests.ros.workspaces import Workspace

TRIALS = 10


def test_a_time_is_never_up_early(nodes: Workspace | Runner, tmp_path: Path) -> None:
    """`after 200 ms`: from before the message that starts it to after what is sent then, no less goes by."""
    found = expiries(nodes, tmp_path / "run", TRIALS, 30)
    assert len(found) == TRIALS
    assert min(found) >= DURATION
