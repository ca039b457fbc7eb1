"""Two controllers in one process are independent of each other."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.ros import workspaces
from tests.ros.faults.conftest import HERE, PACKAGE, Compiled
from tests.ros.faults.partners import CLEAR, PACE, Peer

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.ros.faults.conftest import Controller
    from tests.ros.processes import Processes

TWIST, STRING = "geometry_msgs/Twist", "std_msgs/String"


def test_two_in_one(controller: Controller, tmp_path: Path) -> None:
    if not isinstance(controller, Compiled):
        pytest.skip("a node that is run from its model is a process")
    with workspaces.middleware(controller.place, tmp_path / "run") as processes:
        {1: two_models, 2: two_components}[controller.place.ros.version](controller, processes)


def two_models(controller: Compiled, processes: Processes) -> None:
    """Run the scout and the courier in one program of ROS 1; both receive /scan."""
    ros = controller.place.ros
    process = processes.start("both", [controller.place.folder / "devel/lib/two_in_one/two_in_one"])
    world = Peer(processes, ros.python, ros.version, "world")
    for topic, kind in {"/cmd_vel": TWIST, "/sum": "std_msgs/UInt8", "/two_in_one/state": STRING}.items():
        world.do("listen", topic=topic, kind=kind)
    for topic, kind in {
        "/scan": "sensor_msgs/LaserScan",
        "/stop": "std_msgs/Empty",
        "/count": "std_msgs/Int16",
    }.items():
        world.do("advertise", topic=topic, kind=kind)
        processes.wait_until(lambda topic=topic: world.do("listeners", topic=topic) > 0, f"{topic} is heard")
    world.do("repeat", topic="/scan", fields=CLEAR, hz=20)
    processes.wait_until(lambda: heard(world, "/cmd_vel", speed)[-1:] == [PACE], "the scout drives")
    world.do("publish", topic="/count", fields={"data": 20})
    processes.wait_until(lambda: heard(world, "/sum", plain)[-1:] == [41], "the courier counts")
    world.do("publish", topic="/stop", fields={})
    processes.wait_until(lambda: heard(world, "/cmd_vel", speed)[-1:] == [0.0], "the scout halts")
    world.do("publish", topic="/count", fields={"data": 3})
    processes.wait_until(lambda: heard(world, "/sum", plain)[-1:] == [47], "the courier counts on")
    robots = {json.loads(report)["robot"] for report in heard(world, "/two_in_one/state", plain)}
    assert robots == {"Scout", "Courier"}
    assert processes.stop(process) == 0


def two_components(controller: Compiled, processes: Processes) -> None:
    """Run the scout twice in one container of ROS 2, the second one with other topics."""
    ros = controller.place.ros
    prefixes = ros.environment["AMENT_PREFIX_PATH"].split(os.pathsep)
    containers = (Path(prefix) / "lib/rclcpp_components/component_container" for prefix in prefixes)
    container = next((container for container in containers if container.exists()), None)
    if container is None:
        pytest.skip("there is no component_container")
    process = processes.start("container", [container])
    loading = processes.start("loading", [ros.python, HERE / "load_two.py", PACKAGE])
    processes.wait_until(lambda: loading.poll() is not None, "both are loaded")
    assert loading.returncode == 0, processes.logs()
    world = Peer(processes, ros.python, ros.version, "world")
    for prefix in ("", "/second"):
        world.do("listen", topic=f"{prefix}/cmd_vel", kind=TWIST)
        for topic, kind in {"/scan": "sensor_msgs/LaserScan", "/stop": "std_msgs/Empty"}.items():
            world.do("advertise", topic=prefix + topic, kind=kind)
            processes.wait_until(lambda name=prefix + topic: world.do("listeners", topic=name) > 0, f"{topic} is heard")
        world.do("repeat", topic=f"{prefix}/scan", fields=CLEAR, hz=20)
        drives = f"{prefix}/cmd_vel is {PACE}"
        processes.wait_until(lambda name=f"{prefix}/cmd_vel": heard(world, name, speed)[-1:] == [PACE], drives)
    world.do("publish", topic="/second/stop", fields={})
    processes.wait_until(lambda: heard(world, "/second/cmd_vel", speed)[-1:] == [0.0], "the second one halts")
    count = len(heard(world, "/cmd_vel", speed))
    processes.wait_until(lambda: len(heard(world, "/cmd_vel", speed)) > count + 5, "the first one drives on")
    assert set(heard(world, "/cmd_vel", speed)[count:]) == {PACE}
    assert processes.stop(process) == 0


def heard(world: Peer, topic: str, value: Callable[[Any], Any]) -> list[Any]:
    """Return the values that the world received on a topic."""
    return [value(entry["data"]) for entry in world.all("heard") if entry["heard"] == topic]


def speed(twist: Any) -> Any:
    """Return the forward speed."""
    return twist["linear"]["x"]


def plain(message: Any) -> Any:
    """Return the value of a std_msgs message."""
    return message["data"]
