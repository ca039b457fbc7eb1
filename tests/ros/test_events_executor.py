"""Compiled nodes in the executors of ROS 2. An events executor queues the callbacks of expired timers."""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING

import pytest

from tests.ros.faults.partners import Peer
from tests.ros.workspaces import middleware

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.workspaces import Workspace


#: Number of rounds of loading and unloading.
ROUNDS = os.environ.get("ROBOSC_ROUNDS", "10")
COMPONENTS = ("managed_carrier", "managed_watch", "carrier_controller", "carrier_layer")


def test_a_countdown_that_was_started_again_or_stopped_is_not_up(ros2_workspace: Workspace, tmp_path: Path) -> None:
    """Its restarts do not delay other timers."""
    folder = tmp_path / "run"
    with middleware(ros2_workspace, folder) as processes:
        program = ros2_workspace.folder / "install/events_executor/lib/events_executor/countdowns"
        countdowns = processes.start("countdowns", [program])
        processes.wait_until(lambda: countdowns.poll() is not None, "all countdowns are over")
        assert countdowns.returncode == 0, processes.logs()
    assert re.fullmatch(r"early 0, in time [1-5], stopped 0, ticks 20\n", (folder / "countdowns.log").read_text())


def test_a_component_stops_its_robot_and_ends_in_order(ros2_workspace: Workspace, tmp_path: Path) -> None:
    install = ros2_workspace.folder / "install"
    host = install / "events_executor/lib/events_executor/host"
    library = install / "latch_controller/lib/liblatch_controller_component.so"
    with middleware(ros2_workspace, tmp_path / "run") as processes:
        world = Peer(processes, ros2_workspace.ros.python, 2, "world")
        world.do("listen", topic="/cmd_vel", kind="geometry_msgs/Twist")
        world.do("advertise", topic="/estop", kind="std_msgs/Bool", latched=True)
        world.do("publish", topic="/estop", fields={"data": False})

        def speeds() -> list[float]:
            return [entry["data"]["linear"]["x"] for entry in world.all("heard", since)]

        for number in range(6):
            since = len(world.said)
            node = processes.start(f"host{number}", [host, library])
            processes.wait_until(lambda: 0.5 in speeds(), "the robot drives")
            assert processes.stop(node) == 0, processes.logs()
            processes.wait_until(lambda: speeds()[-1:] == [0.0], "the robot stops")


@pytest.mark.parametrize("executor", ["single", "multi", "events", "events-cbg-single"])
def test_components_come_and_go_while_their_services_are_called(
    ros2_workspace: Workspace, tmp_path: Path, executor: str
) -> None:
    install = ros2_workspace.folder / "install"
    libraries = [install / name / f"lib/lib{name}_component.so" for name in COMPONENTS]
    with middleware(ros2_workspace, tmp_path / "run") as processes:
        program = install / "events_executor/lib/events_executor/churn"
        churn = processes.start("churn", [program, executor, ROUNDS, *libraries])
        if churn.wait(600) == 2:
            pytest.skip(f"this ROS 2 has no executor `{executor}`")
        assert churn.returncode == 0, processes.logs()
    output = (tmp_path / "run" / "churn.log").read_text()
    assert f"unloaded {int(ROUNDS) * len(COMPONENTS)}, answered yes\n" in output
