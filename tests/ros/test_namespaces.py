"""Names below the namespace of a node: two robots of one model in one ROS graph."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tests.ros.faults.partners import Peer
from tests.ros.workspaces import middleware

if TYPE_CHECKING:
    from tests.ros.running import Runner

HERE = Path(__file__).parent / "namespaces"
MODEL = HERE / "lamp.rscd"


def test_two_robots_of_one_model_have_topics_of_their_own(run_ros2: Runner, tmp_path: Path) -> None:
    with middleware(run_ros2, tmp_path / "run") as processes:
        for side in ("left", "right"):
            command = run_ros2.command(
                MODEL, configuration=HERE / "controller-config.json", remappings=[f"__ns:=/{side}"]
            )
            processes.start(side, command)
        world = Peer(processes, run_ros2.ros.python, run_ros2.ros.version, "world")
        for side in ("left", "right"):
            world.do("listen", topic=f"/{side}/shine", kind="std_msgs/Float32")
            world.do("advertise", topic=f"/{side}/pressed", kind="std_msgs/Bool")
        for side in ("left", "right"):
            pressed = f"/{side}/pressed"
            processes.wait_until(lambda: world.do("listeners", topic=pressed), f"the {side} robot hears")  # noqa: B023

        def shining() -> list[str]:
            return [entry["heard"] for entry in world.all("heard")]

        world.do("publish", topic="/left/pressed", fields={"data": True})
        processes.wait_until(lambda: len(shining()) > 3, "the left robot acts more than once")
        assert set(shining()) == {"/left/shine"}
        world.do("publish", topic="/right/pressed", fields={"data": True})
        processes.wait_until(lambda: "/right/shine" in shining(), "the right robot acts")
        assert "does not apply" not in processes.logs()


def test_a_node_in_a_namespace_warns_of_absolute_names(run_ros2: Runner, tmp_path: Path) -> None:
    (tmp_path / "controller-config.json").write_text('{"onShutdown": []}', encoding="utf-8")
    with middleware(run_ros2, tmp_path / "run") as processes:
        settings = tmp_path / "controller-config.json"
        remappings = ["__ns:=/left", "/pressed:=pressed"]
        processes.start("node", run_ros2.command(MODEL, configuration=settings, remappings=remappings))
        processes.wait_until(lambda: "lamp_controller runs" in processes.logs(), "the node runs")
        assert "the namespace /left does not apply to /shine: see" in processes.logs()
