"""A latched stop button that publishes once, before the node starts. Commands wait until the node receives it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.ros.faults.partners import Peer
from tests.ros.running import Runner
from tests.ros.workspaces import LATCHED, Workspace, middleware

if TYPE_CHECKING:
    from pathlib import Path


def test_what_was_kept_is_heard_before_any_command(nodes: Workspace | Runner, tmp_path: Path) -> None:
    with middleware(nodes, tmp_path / "run") as processes:
        world = Peer(processes, nodes.ros.python, nodes.ros.version, "world")
        world.do("listen", topic="/cmd_vel", kind="geometry_msgs/Twist")
        if isinstance(nodes, Runner):
            settings = LATCHED / "controller-config.json"
            node = processes.start("node", nodes.command(LATCHED / "latch.rscd", configuration=settings))
        else:
            node = processes.start("node", nodes.node("latch_controller"))

        def speeds() -> list[float]:
            return [entry["data"]["linear"]["x"] for entry in world.all("heard")]

        log = tmp_path / "run" / "node.log"
        processes.wait_until(lambda: "nobody publishes it after 5 s" in log.read_text(), "the node runs")
        assert "commands wait for estop" in log.read_text()
        assert speeds() == []
        world.do("advertise", topic="/estop", kind="std_msgs/Bool", latched=True)
        world.do("publish", topic="/estop", fields={"data": True})
        processes.wait_until(lambda: speeds()[:1] == [0.0], "the node hears the button")
        # Another publisher of the button, whose messages are not latched.
        second = Peer(processes, nodes.ros.python, nodes.ros.version, "second")
        second.do("advertise", topic="/estop", kind="std_msgs/Bool")
        processes.wait_until(lambda: second.do("listeners", topic="/estop"), "the node hears both")
        second.do("publish", topic="/estop", fields={"data": False})
        # The limits of the model leave 0.5 of the speed that it provides.
        processes.wait_until(lambda: speeds()[-1:] == [0.5], "the button is released")
        assert world.all("heard")[-1]["data"]["linear"]["y"] == 0.25
        assert processes.stop(node) == 0


def test_what_was_kept_before_the_node_started_is_heard(nodes: Workspace | Runner, tmp_path: Path) -> None:
    with middleware(nodes, tmp_path / "run") as processes:
        world = Peer(processes, nodes.ros.python, nodes.ros.version, "world")
        world.do("listen", topic="/cmd_vel", kind="geometry_msgs/Twist")
        world.do("advertise", topic="/estop", kind="std_msgs/Bool", latched=True)
        world.do("publish", topic="/estop", fields={"data": True})
        if isinstance(nodes, Runner):
            settings = LATCHED / "controller-config.json"
            node = processes.start("node", nodes.command(LATCHED / "latch.rscd", configuration=settings))
        else:
            node = processes.start("node", nodes.node("latch_controller"))
        processes.wait_until(lambda: len(world.all("heard")) > 5, "the node sends")
        assert {entry["data"]["linear"]["x"] for entry in world.all("heard")} == {0.0}
        assert processes.stop(node) == 0
