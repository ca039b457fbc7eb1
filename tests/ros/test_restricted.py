"""Assumptions, limits and conditions on the data of commands, in compiled nodes and in nodes run from their model."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tests.ros.faults.partners import Peer
from tests.ros.test_ros2_node import ACTIVATE, CONFIGURE, DEACTIVATE, Graph
from tests.ros.workspaces import RESTRICTED, Workspace, middleware

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.processes import Processes
    from tests.ros.running import Runner

VELOCITY, HALT = "message_velocity.c_trigger", "message_halt.c_trigger"
LIFTED = "message_Side1_lifted.u_response"
MODEL = RESTRICTED / "hauler.rscd"
ASKED = 'assume Side1.asked "an arm reports only what is asked": Side1.lifted needs Side1.lifting'


@dataclass(frozen=True)
class Hauler:
    """The world around a node of the hauler. `inside` is the prefix of the topics of commands that a layer hears."""

    world: Peer
    processes: Processes
    name: str

    def listen(self, topics: dict[str, str]) -> None:
        for topic, kind in topics.items():
            self.world.do("listen", topic=topic, kind=kind)

    def advertise(self, topics: dict[str, str]) -> None:
        """Publish topics, and wait until the node hears them."""
        for topic, kind in topics.items():
            self.world.do("advertise", topic=topic, kind=kind)
            self.processes.wait_until(
                lambda topic=topic: self.world.do("listeners", topic=topic), f"the node hears {topic}"
            )

    def send(self, topic: str, **fields: Any) -> None:
        self.world.do("publish", topic=topic, fields=fields)

    def heard(self, topic: str) -> list[dict[str, Any]]:
        return [entry["data"] for entry in self.world.all("heard") if entry["heard"] == topic]

    def speeds(self) -> list[tuple[float, float]]:
        """Return the linear and angular speeds that the robot received."""
        return [(data["linear"]["x"], data["angular"]["z"]) for data in self.heard("/velocity")]

    def blocked(self, name: str = "Base.velocity") -> list[tuple[str, list[str]]]:
        """Return the reasons why a command was blocked, with the texts that name them."""
        reports = [json.loads(data["data"]) for data in self.heard(f"/{self.name}/blocked")]
        return [(report["reason"], report["because"]) for report in reports if report["name"] == name]

    def until_driven(self, speed: tuple[float, float]) -> None:
        self.processes.wait_until(lambda: self.speeds()[-1:] == [speed], f"the robot drives at {speed}")


def events_of(log: Path, direction: str) -> list[str]:
    """Return the events of a direction in an event log."""
    if not log.exists():
        return []
    entries = (json.loads(line) for line in log.read_text(encoding="utf-8").splitlines())
    return [entry["event"] for entry in entries if entry["direction"] == direction]


COMMANDS = {"/velocity": "geometry_msgs/Twist"}
SENSORS = {"/seen": "std_msgs/Bool", "/side1/lifted": "std_msgs/Bool"}


def test_a_controller_reports_once_that_data_forbid_its_command(layers: Workspace | Runner, tmp_path: Path) -> None:
    """A controller with `onViolation: report`: a violation stops nothing."""
    folder, log, name = tmp_path / "run", tmp_path / "events.jsonl", "hauler_controller"
    with middleware(layers, folder) as processes:
        world = Peer(processes, layers.ros.python, layers.ros.version, "world")
        robot = Hauler(world, processes, name)
        robot.listen(COMMANDS | {f"/{name}/blocked": "std_msgs/String", f"/{name}/state": "std_msgs/String"})
        node = processes.start("node", _node(layers, name, "controller-config.json", log))
        robot.advertise(SENSORS | {"/speed": "std_msgs/Float32"})
        robot.until_driven((0.1, 1.0))
        robot.send("/speed", data=1.0)
        robot.until_driven((1.0, 1.0))
        assert robot.blocked() == []
        robot.send("/seen", data=True)
        processes.wait_until(lambda: robot.blocked() != [], "the velocity is blocked")
        robot.send("/side1/lifted", data=True)
        processes.wait_until(lambda: LIFTED in events_of(log, "violated"), "the assumption is violated")
        silent = len(robot.speeds())
        robot.send("/speed", data=0.25)
        robot.until_driven((0.25, 0.5))
        assert {speed for speed, _ in robot.speeds()[silent:]} == {0.25}
        robot.send("/speed", data=0.75)
        processes.wait_until(lambda: len(robot.blocked()) == 2, "the velocity is blocked again")
        robot.send("/seen", data=False)
        robot.until_driven((0.75, 1.0))
        states = [json.loads(data["data"]) for data in robot.heard(f"/{name}/state")]
        assert [state["violated"] for state in states if "violated" in state][-1] == ["Side1.asked"]
        assert processes.stop(node) == 0
        reason = "requirement R1: velocity needs Person.away or value.linear.x <= slow"
        assert robot.blocked() == [("requirement", [reason])] * 2


def test_a_layer_limits_and_judges_what_the_controller_sent(layers: Workspace | Runner, tmp_path: Path) -> None:
    folder, log, name = tmp_path / "run", tmp_path / "events.jsonl", "hauler_layer"
    with middleware(layers, folder) as processes:
        world = Peer(processes, layers.ros.python, layers.ros.version, "world")
        robot, inside = Hauler(world, processes, name), f"/{name}/controller"
        forwarded = f"{inside}/seen"
        robot.listen(COMMANDS | {f"/{name}/blocked": "std_msgs/String"})
        robot.listen({forwarded: "std_msgs/Bool", f"{inside}/side1/lifted": "std_msgs/Bool"})
        node = processes.start("node", _node(layers, name, "layer-config.json", log, layer=True))
        robot.advertise(SENSORS | {f"{inside}{topic}": kind for topic, kind in COMMANDS.items()})

        def drive(linear: float, angular: float) -> None:
            robot.send(f"{inside}/velocity", linear={"x": linear}, angular={"z": angular})

        drive(2.0, 3.0)
        robot.until_driven((2.0, 1.0))
        robot.send("/seen", data=True)
        processes.wait_until(lambda: robot.heard(forwarded) != [], "the layer forwards the message")
        drive(0.25, 3.0)
        robot.until_driven((0.25, 0.5))
        # The layer sends its own velocity: that of `provide`, limited.
        drive(0.5, 3.0)
        processes.wait_until(lambda: len(robot.blocked()) == 1, "the fast velocity is blocked")
        robot.until_driven((0.1, 0.5))
        drive(0.125, 0.0)
        robot.until_driven((0.125, 0.0))
        drive(math.nan, 0.0)
        processes.wait_until(lambda: len(robot.blocked()) == 2, "the velocity without a number is blocked")
        robot.until_driven((0.1, 0.5))
        drive(0.0, 0.0)
        robot.until_driven((0.0, 0.0))
        robot.send("/side1/lifted", data=True)
        processes.wait_until(lambda: robot.heard(f"{inside}/side1/lifted") != [], "the layer forwards the violation")
        robot.until_driven((0.1, 0.5))
        drive(0.125, 0.0)
        processes.wait_until(lambda: len(robot.blocked()) == 3, "every velocity is blocked")
        assert processes.stop(node) == 0
        (slow, not_finite, violated) = robot.blocked()
    assert slow == ("requirement", ["requirement R1: velocity needs Person.away or value.linear.x <= slow"])
    assert (not_finite[0], "linear.x" in not_finite[1][0]) == ("data", True)
    assert violated == ("assumption", [ASKED])
    assert events_of(log, "violated") == [LIFTED]
    assert events_of(log, "outside") == [VELOCITY] * 3


def test_a_blocked_request_leaves_the_data_of_a_layer(layers: Workspace | Runner, tmp_path: Path) -> None:
    """The layer counts the requests that it sends; a limit shows the count."""
    name, kind = "hauler_layer", "std_srvs/SetBool"
    with middleware(layers, tmp_path / "run") as processes:
        world = Peer(processes, layers.ros.python, layers.ros.version, "world")
        robot, inside = Hauler(world, processes, name), f"/{name}/controller"
        world.do("serve", name="/tare", kind=kind)
        world.do("answer_at_once", fields={"success": True})
        robot.listen(COMMANDS | {f"/{name}/blocked": "std_msgs/String"})
        processes.start("node", _node(layers, name, "layer-config.json", tmp_path / "events.jsonl", layer=True))
        robot.advertise({f"{inside}/velocity": COMMANDS["/velocity"]})
        for speed, permitted in enumerate((False, True, False)):
            number = world.do("call", name=f"{inside}/tare", kind=kind, fields={"data": permitted})
            assert world.wait("answered", value=number)["data"]["success"] is permitted
            robot.send(f"{inside}/velocity", linear={"x": float(speed)})
            robot.until_driven((float(speed), 0.0))
        processes.wait_until(lambda: len(robot.blocked("Base.tare")) == 2, "two requests are blocked")
        assert robot.blocked("Base.tare") == [("requirement", ["requirement tare needs value.data"])] * 2
        assert [data["linear"]["z"] for data in robot.heard("/velocity")] == [0.0, 0.25, 0.25]
        assert len(world.all("called")) == 1


def test_a_violation_while_a_managed_node_is_inactive(ros2_workspace: Workspace, tmp_path: Path) -> None:
    with middleware(ros2_workspace, tmp_path / "run") as processes:
        world = Peer(processes, ros2_workspace.ros.python, 2, "world")
        robot = Hauler(world, processes, "hauler")
        robot.listen(COMMANDS | {"/halt": "std_msgs/Empty"})
        graph = Graph(ros2_workspace, processes, tmp_path, world)
        node, log = graph.start("managed_hauler", "hauler")
        assert graph.change("/hauler", CONFIGURE) == [True]
        robot.advertise(SENSORS)
        robot.send("/side1/lifted", data=True)
        processes.wait_until(lambda: LIFTED in events_of(log, "violated"), "the assumption is violated")
        assert HALT not in events_of(log, "outside")
        assert graph.change("/hauler", ACTIVATE) == [True]
        processes.wait_until(lambda: HALT in events_of(log, "outside"), "the node stops the robot")
        assert graph.change("/hauler", DEACTIVATE) == [True]
        assert robot.speeds() == []
        assert graph.change("/hauler", ACTIVATE) == [True]
        robot.until_driven((0.1, 1.0))
        halts = len(robot.heard("/halt"))
        robot.send("/side1/lifted", data=True)
        processes.wait_until(lambda: len(robot.heard("/halt")) > halts, "the node stops the robot again")
        assert processes.stop(node) == 0


def _node(
    nodes: Workspace | Runner, name: str, configuration: str, log: Path, *, layer: bool = False
) -> list[str | Path]:
    """Return the command that starts a node of the hauler."""
    if isinstance(nodes, Workspace):
        return nodes.node(name, f"event_log:={log}")
    return [*nodes.command(MODEL, f"event_log:={log}", layer=layer, configuration=RESTRICTED / configuration)]
