"""A controller that serves while a silent sensor stops its robot, and beside another server. See `serving`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.ros.test_serving import RING, TOUR, serving

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.running import Runner
    from tests.ros.workspaces import Workspace


def test_a_stopped_robot_answers_nobody_and_rejects_goals(nodes: Workspace | Runner, tmp_path: Path) -> None:
    limit = f"watchdog_ms{'/' if nodes.ros.version == 1 else '.'}open:=1000"
    with serving(nodes, tmp_path / "run", limit, "watchdog_stops:=true") as clerk:
        says = lambda text: lambda: text in clerk.output()  # noqa: E731
        clerk.processes.wait_until(says("/open: silent for 1000 ms"), "the sensor is silent")
        call = clerk.world.do("call", name="/ring", kind=RING, fields={})
        clerk.until(0, "service_ring.u_request")
        assert not clerk.accepted(clerk.tour(1))
        assert "service_ring.c_response" not in clerk.events()
        clerk.world.do("repeat", topic="/open", fields={}, hz=20)
        assert clerk.answer(call) == {"success": False, "message": ""}
        clerk.processes.wait_until(says("/open: speaks again"), "the sensor speaks again")
        clerk.processes.wait_until(lambda: clerk.accepted(clerk.tour(1)), "it accepts a goal again")
        if clerk.version == 2:
            # In ROS 1, the new server replaces the node.
            clerk.world.do("serve", name="/ring", kind=RING)
            clerk.world.do("act", name="/tour", kind=TOUR)
            rivals = "/ring: /clerk_controller and /world serve it: only one answer counts"
            for text in (rivals, rivals.replace("/ring", "/tour")):
                clerk.processes.wait_until(says(text), text)
