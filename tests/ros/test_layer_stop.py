"""The robot stops even if the layer blocks the stop of its controller."""

from __future__ import annotations

import json
import time
from typing import TYPE_CHECKING

from tests.ros.faults.partners import Peer
from tests.ros.running import Runner
from tests.ros.workspaces import BLOCKED, Workspace, middleware

if TYPE_CHECKING:
    from pathlib import Path

INSIDE = "/hoist_layer/controller"


def test_the_robot_hears_one_stop_in_the_place_of_those_that_are_blocked(
    layers: Workspace | Runner, tmp_path: Path
) -> None:
    folder, log = tmp_path / "run", tmp_path / "events.jsonl"
    with middleware(layers, folder) as processes:
        if isinstance(layers, Runner):
            settings = BLOCKED / "controller-config.json"
            command = layers.command(BLOCKED / "hoist.rscd", f"event_log:={log}", layer=True, configuration=settings)
            layer = processes.start("layer", command)
        else:
            layer = processes.start("layer", layers.node("hoist_layer", f"event_log:={log}"))
        world = Peer(processes, layers.ros.python, layers.ros.version, "world")

        def speeds() -> list[float]:
            heard = [entry for entry in world.all("heard") if entry["heard"] == "/cmd_vel"]
            return [entry["data"]["linear"]["x"] for entry in heard]

        def bump(pressed: bool) -> None:
            since = len(world.said)
            world.do("publish", topic="/bumper", fields={"data": pressed})
            world.wait("heard", since, f"{INSIDE}/bumper")

        def drive(speed: float) -> None:
            world.do("publish", topic=f"{INSIDE}/cmd_vel", fields={"linear": {"x": speed}})

        for topic, kind in {"/cmd_vel": "geometry_msgs/Twist", f"{INSIDE}/bumper": "std_msgs/Bool"}.items():
            world.do("listen", topic=topic, kind=kind)
        for topic, kind in {"/bumper": "std_msgs/Bool", f"{INSIDE}/cmd_vel": "geometry_msgs/Twist"}.items():
            world.do("advertise", topic=topic, kind=kind)
            processes.wait_until(lambda topic=topic: world.do("listeners", topic=topic), f"the layer hears {topic}")
        bump(False)
        expected: list[float] = []
        for speed in (0.5, 0.25):
            drive(speed)
            processes.wait_until(lambda: speeds()[-1:] == [speed], "the robot drives")  # noqa: B023
            bump(True)
            for _ in range(10):
                drive(0.0)
            processes.wait_until(lambda: speeds()[-1:] == [0.0], "the robot stops")
            time.sleep(0.5)
            bump(False)
            expected += [speed, 0.0]
        assert speeds() == expected
        assert processes.stop(layer) == 0
    lines = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]
    assert [line["event"] for line in lines if line["direction"] == "outside"] == ["message_velocity.c_trigger"] * 2
    assert [line["direction"] for line in lines].count("blocked") == 20
    assert (folder / "layer.log").read_text().count("Base.velocity is blocked") == 1, "throttled"
