"""An obstacle stops the line follower at once, and not at the control loop's next tick.

The clock stands still while it is measured: a node that waited for a tick would never stop. How busy the machine is
matters to an echo as well, and it is measured in between.
"""

from __future__ import annotations

from statistics import median
from typing import TYPE_CHECKING

from tests.ros.reactions import reactions_without_ticks

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.running import Runner
    from tests.ros.workspaces import Workspace

TRIALS = 20


def test_an_obstacle_halts_without_a_tick(nodes: Workspace | Runner, tmp_path: Path) -> None:
    reactions, echoes = reactions_without_ticks(nodes, tmp_path / "run", TRIALS)
    assert len(reactions) == len(echoes) == TRIALS
    assert median(reactions) < 3 * median(echoes) + 0.05
