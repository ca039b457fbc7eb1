"""An obstacle stops the line follower at once, not at the control loop's next tick.

The clock does not run meanwhile: a node that waits for a tick would never stop. The reaction time depends on the
machine; `benchmarks/reaction.py` measures it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.ros.reactions import reactions_without_ticks

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.running import Runner
    from tests.ros.workspaces import Workspace

TRIALS = 5


def test_an_obstacle_halts_without_a_tick(nodes: Workspace | Runner, tmp_path: Path) -> None:
    reactions, _ = reactions_without_ticks(nodes, tmp_path / "run", TRIALS)
    assert len(reactions) == TRIALS
