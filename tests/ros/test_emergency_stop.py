"""The library's emergency stop over ROS 2: a killed and restarted node does not remember the button."""

from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING

from tests.ros.faults.partners import Peer
from tests.ros.workspaces import middleware

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.running import Runner

#: Long timeouts, so that a busy machine does not count as a silent button.
ROVER = """
robot Rover {
  component EmergencyStop from EmergencyStopLibrary import PeriodicEmergencyStop(patience: 5000)
  component Platform from TurtlebotLibrary import TurtlebotPlatform

  requirement move needs EmergencyStop.in_service
  requirement halt needs EmergencyStop.stopped

  provide move with { linear: { x: 0.2 } }
  provide halt with { linear: { x: 0.0 } }
}
"""
BUTTON, CONTINUE = "/emergency_stop", "/continue"


def test_a_node_that_is_restarted_while_the_button_is_pressed_does_not_move(run_ros2: Runner, tmp_path: Path) -> None:
    path = tmp_path / "rover.rscd"
    path.write_text(ROVER)
    with middleware(run_ros2, tmp_path / "run") as processes:
        world = Peer(processes, run_ros2.ros.python, run_ros2.ros.version, "world")
        world.do("listen", topic="/cmd_vel", kind="geometry_msgs/Twist")
        world.do("advertise", topic=BUTTON, kind="std_msgs/Bool")
        world.do("advertise", topic=CONTINUE, kind="std_msgs/Empty")

        def speeds(since: int = 0) -> list[float]:
            return [entry["data"]["linear"]["x"] for entry in world.all("heard")[since:]]

        def is_set_going() -> bool:
            world.do("publish", topic=CONTINUE, fields={})
            return speeds()[-1:] == [0.2]

        node = processes.start("node", run_ros2.command(path))
        processes.wait_until(lambda: len(speeds()) > 5, "the node sends")
        assert {*speeds()} == {0.0}, "it begins stopped"
        world.do("repeat", topic=BUTTON, fields={"data": False}, hz=20)
        processes.wait_until(is_set_going, "the robot drives")

        world.do("repeat", topic=BUTTON, fields={"data": True}, hz=20)
        processes.wait_until(lambda: speeds()[-1] == 0.0, "the button stops the robot")
        os.killpg(node.pid, signal.SIGKILL)
        node.wait()
        before = len(speeds())
        node = processes.start("restarted", run_ros2.command(path))
        processes.wait_until(
            lambda: is_set_going() or len(speeds(before)) > 20, "the restarted node sends, whoever wants it to go on"
        )
        # Commands from before this point have arrived when the button is released.
        sent = len(speeds())
        processes.wait_until(lambda: len(speeds(sent)) > 20, "the node goes on sending")
        world.do("repeat", topic=BUTTON, fields={"data": False}, hz=20)
        released = len(speeds())
        processes.wait_until(lambda: len(speeds(released)) > 20, "the node goes on sending")
        assert {*speeds(before)} == {0.0}, "neither the restart nor the released button sets it going"
        processes.wait_until(is_set_going, "a new acknowledgement does")

        world.do("silence", topic=BUTTON)
        processes.wait_until(lambda: speeds()[-1] == 0.0, "the button has fallen silent")
        assert processes.stop(node) == 0
