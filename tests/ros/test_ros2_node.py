"""Features of ROS 2 nodes: components, managed nodes, and descriptions of parameters."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.ros.faults.partners import Peer
from tests.ros.processes import PATIENCE
from tests.ros.workspaces import Workspace, middleware

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.ros.processes import Processes

HERE = Path(__file__).parent
#: Transitions of managed nodes, with the numbers of lifecycle_msgs.
CONFIGURE, CLEAN_UP, ACTIVATE, DEACTIVATE = 1, 2, 3, 4
#: Replacement for rclcpp's part of a transition (activate, deactivate), which fails.
FAILING = "unsigned char _ZN16rclcpp_lifecycle13LifecycleNode{}on_{}ERKNS_5StateE(void) {{ return 99; }}"
#: Number of rounds of loading and unloading. An unguarded component in a multi-threaded container fails within ten.
ROUNDS = os.environ.get("ROBOSC_ROUNDS", "20")
HALT = ("outside", "message_halt.c_trigger")
#: Events of `managed/watch.rscd`.
ORDER, UP = "message_order.u_response", "component_Base.u_after1"
SPEED, BEEP = "message_speed.c_trigger", "message_beep.c_trigger"


@dataclass(frozen=True)
class Graph:
    """A workspace, a peer `world` that receives commands, and a manager of nodes."""

    workspace: Workspace
    processes: Processes
    folder: Path
    world: Peer
    nodes: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def manage(self, *command: str | Path | int) -> Any:
        """Return the answer of `manage_ros2.py`."""
        done = subprocess.run(
            [self.workspace.ros.python, HERE / "manage_ros2.py", *map(str, command)],
            env=self.processes.environment,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, done.stderr + self.processes.logs()
        return json.loads(done.stdout)

    def start(
        self, package: str, name: str, *parameters: str, preloaded: Path | str = ""
    ) -> tuple[subprocess.Popen[bytes], Path]:
        """Start a node in a process of its own; return the process and the event log."""
        log = self.folder / f"{name}.jsonl"
        command = ["env", f"LD_PRELOAD={preloaded}", *self.workspace.node(package, f"event_log:={log}", *parameters)]
        self.nodes.append(self.processes.start(name, [*command, "-r", f"__node:={name}"]))
        return self.nodes[-1], log

    def change(self, node: str, *transitions: int) -> list[Any]:
        """Request transitions of a managed node in turn; return whether each succeeded."""
        return [self.manage("change", node, transition) for transition in transitions]

    def commands(self, topic: str) -> int:
        """Return the number of commands that the world received."""
        return sum(entry["heard"] == topic for entry in self.world.all("heard"))

    def until_commanded(self, topic: str) -> None:
        heard = self.commands(topic)
        self.processes.wait_until(lambda: self.commands(topic) > heard + 2, f"there are commands on {topic}", 60)


@pytest.fixture(scope="module")
def world(ros2_workspace: Workspace, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Graph]:
    folder = tmp_path_factory.mktemp("ros2-node") / "run"
    with middleware(ros2_workspace, folder) as processes:
        peer = Peer(processes, ros2_workspace.ros.python, 2, "world")
        for topic in ("/cmd_vel", "/left/cmd_vel", "/right/cmd_vel"):
            peer.do("listen", topic=topic, kind="geometry_msgs/Twist")
        yield Graph(ros2_workspace, processes, folder, peer)


@pytest.fixture
def graph(world: Graph) -> Iterator[Graph]:
    """The world; after a test, it stops the nodes of that test."""
    yield world
    while world.nodes:
        node = world.nodes.pop()
        if node.poll() is None:
            world.processes.stop(node)


def last(log: Path) -> tuple[str, str]:
    """Return direction and event of the last line of an event log."""
    entry = json.loads(log.read_text().splitlines()[-1])
    return entry["direction"], entry["event"]


def log_of(log: Path, event: str) -> list[dict[str, Any]]:
    """Return the entries of an event in a log."""
    entries = (json.loads(line) for line in log.read_text().splitlines())
    return [entry for entry in entries if entry["event"] == event]


def start_container(graph: Graph, program: str) -> subprocess.Popen[bytes]:
    prefixes = map(Path, graph.processes.environment["AMENT_PREFIX_PATH"].split(":"))
    containers = [prefix / "lib/rclcpp_components" / program for prefix in prefixes]
    # The container is built without the sanitizer of its components, so the sanitizer may need a preload.
    preloaded = f"LD_PRELOAD={os.environ.get('ROBOSC_PRELOAD', '')}"
    return graph.processes.start(program, ["env", preloaded, next(path for path in containers if path.exists())])


def test_two_components_in_one_container(graph: Graph) -> None:
    container = start_container(graph, "component_container")
    logs = {side: graph.folder / f"{side}.jsonl" for side in ("left", "right")}
    loaded = {side: graph.manage("load", "scout_controller", f"/{side}", log) for side, log in logs.items()}
    assert [answer["error"] for answer in loaded.values()] == ["", ""]
    assert loaded["left"]["name"] == "/left/scout_controller"
    for log in logs.values():
        graph.processes.wait_until(lambda log=log: log.exists() and log.stat().st_size > 0, "events happen")
    assert graph.manage("unload", loaded["left"]["number"])
    # The component stops its robot while the other one continues.
    assert last(logs["left"]) == HALT
    size = logs["right"].stat().st_size
    graph.processes.wait_until(lambda: logs["right"].stat().st_size > size, "the other component goes on")
    assert graph.processes.stop(container) == 0
    assert last(logs["right"]) == HALT


@pytest.mark.parametrize("program", ["component_container", "component_container_mt"])
def test_components_come_and_go_under_load(graph: Graph, program: str) -> None:
    container = start_container(graph, program)
    churning = [graph.workspace.ros.python, HERE / "churn_ros2.py", ROUNDS]
    done = subprocess.run(
        churning, env=graph.processes.environment, capture_output=True, text=True, check=False, timeout=3600
    )
    assert (done.returncode, done.stdout) == (0, str(4 * int(ROUNDS))), done.stderr + graph.processes.logs()
    assert container.poll() is None
    assert graph.processes.stop(container) == 0


def test_a_hangup_stops_the_robot(graph: Graph) -> None:
    node, log = graph.start("scout_controller", "hung_up")
    graph.processes.wait_until(lambda: log.exists() and log.stat().st_size > 0, "events happen")
    os.kill(node.pid, signal.SIGHUP)
    assert node.wait(PATIENCE) == 0
    assert last(log) == HALT


def test_a_managed_node_acts_while_it_is_active(graph: Graph) -> None:
    before = graph.commands("/cmd_vel")
    node, log = graph.start("managed_porter", "porter")
    change = partial(graph.change, "/porter")
    assert change(CONFIGURE) == [True]
    silent = graph.commands("/cmd_vel") - before
    assert change(ACTIVATE) == [True]
    graph.until_commanded("/cmd_vel")
    assert silent == 0
    assert change(DEACTIVATE) == [True]
    assert last(log) == HALT
    # The request takes so long that pending messages have arrived; an active node would send ten commands a second.
    assert change(CLEAN_UP) == [True]
    heard = graph.commands("/cmd_vel")
    assert change(CONFIGURE) == [True]
    assert graph.commands("/cmd_vel") == heard
    assert change(ACTIVATE) == [True]
    graph.until_commanded("/cmd_vel")
    assert graph.processes.stop(node) == 0
    assert last(log) == HALT


@pytest.mark.parametrize("transition", ["activate", "deactivate"])
def test_a_managed_node_that_fails_is_still_and_can_be_configured_again(graph: Graph, transition: str) -> None:
    library = graph.folder / f"{transition}.so"
    code = FAILING.format(len(f"on_{transition}"), transition)
    subprocess.run(["gcc", "-shared", "-fPIC", "-x", "c", "-", "-o", library], input=code, text=True, check=True)
    node, log = graph.start("managed_porter", "failing", preloaded=library)
    change = partial(graph.change, "/failing")
    graph.world.do("advertise", topic="/order", kind="std_msgs/Float64")
    if transition == "activate":
        assert change(CONFIGURE, ACTIVATE) == [True, False]
        assert "outside" not in log.read_text(), "it never acted"
    else:
        assert change(CONFIGURE, ACTIVATE) == [True, True]
        graph.until_commanded("/cmd_vel")
        assert change(DEACTIVATE) == [False]
        assert last(log) == HALT
    graph.processes.wait_until(lambda: graph.world.do("listeners", topic="/order") == 0, "nobody listens")
    assert change(CONFIGURE) == [True]
    assert graph.processes.stop(node) == 0


def test_a_managed_node_is_not_activated_while_a_goal_of_its_own_has_not_ended(graph: Graph) -> None:
    """The node is not cleaned up either, because it would forget the goal."""
    server = Peer(graph.processes, graph.workspace.ros.python, 2, "server")
    server.do("accept_at_once", accept=True)
    server.do("on_cancel", answer="refuse")
    server.do("act", name="/navigate", kind="nav2_msgs/NavigateToPose")
    graph.world.do("advertise", topic="/wanted", kind="std_msgs/Bool")
    node, log = graph.start("managed_carrier", "carrier")
    change = partial(graph.change, "/carrier")
    assert change(CONFIGURE, ACTIVATE) == [True, True]
    graph.processes.wait_until(lambda: graph.world.do("listeners", topic="/wanted") > 0, "the node listens")
    graph.world.do("publish", topic="/wanted", fields={"data": True})
    number = server.wait("goal")["goal"]
    server.do("progress", number=number, fields={})
    graph.processes.wait_until(lambda: bool(log_of(log, "action_navigate.u_feedback")), "the goal is accepted")
    assert change(DEACTIVATE) == [True]
    server.wait("cancel", value=number)
    assert change(ACTIVATE, CLEAN_UP) == [False, False]
    output = (graph.folder / "carrier.log").read_text()
    assert "not activated: a goal of this node has not ended" in output
    assert "not cleaned up: a goal of this node has not ended" in output
    server.do("end", number=number, how="succeeded")
    graph.processes.wait_until(lambda: bool(log_of(log, "action_navigate.u_response")), "the goal has ended")
    assert change(ACTIVATE) == [True]
    assert graph.processes.stop(node) == 0


def test_a_managed_node_that_is_not_active_ends_without_a_word(graph: Graph) -> None:
    node, log = graph.start("managed_porter", "porter_at_rest")
    assert graph.manage("change", "/porter_at_rest", CONFIGURE)
    heard = graph.commands("/cmd_vel")
    assert graph.processes.stop(node) == 0
    assert graph.commands("/cmd_vel") == heard
    assert "outside" not in log.read_text()


def test_an_active_managed_node_has_a_bond_with_its_manager(graph: Graph) -> None:
    """A bond that one end breaks is answered. Heartbeats need no simulated clock."""
    world, name = graph.world, "bonded"

    def beats(*, active: bool) -> int:
        heard = (entry["data"] for entry in world.all("heard") if entry["heard"] == "/bond")
        return sum(data["id"] == name and data["active"] == active for data in heard)

    world.do("listen", topic="/bond", kind="bond/Status")
    world.do("advertise", topic="/bond", kind="bond/Status")
    node, _ = graph.start("managed_watch", name, "use_sim_time:=true")
    change = partial(graph.change, f"/{name}")
    assert change(CONFIGURE) == [True]
    assert beats(active=True) == beats(active=False) == 0
    assert change(ACTIVATE) == [True]
    graph.processes.wait_until(lambda: beats(active=True) > 3, "the node sends heartbeats")
    assert beats(active=False) == 0
    assert change(DEACTIVATE) == [True]
    graph.processes.wait_until(lambda: beats(active=False) == 1, "the node breaks the bond")
    assert change(ACTIVATE) == [True]
    graph.processes.wait_until(lambda: graph.world.do("listeners", topic="/bond") > 1, "the node listens")
    world.do("publish", topic="/bond", fields={"id": name, "instance_id": "manager", "active": False})
    graph.processes.wait_until(lambda: beats(active=False) == 2, "the node answers")
    heard = beats(active=True)
    assert change(DEACTIVATE, ACTIVATE) == [True, True]
    graph.processes.wait_until(lambda: beats(active=True) > heard + 3, "there is a new bond")
    broken = beats(active=False)
    assert graph.processes.stop(node) == 0
    graph.processes.wait_until(lambda: beats(active=False) > broken, "the end of the node breaks the bond")


def test_a_managed_node_takes_its_last_transition(graph: Graph) -> None:
    graph.world.do("listen", topic="/last/transition_event", kind="lifecycle_msgs/TransitionEvent")
    node, _ = graph.start("managed_watch", "last")
    assert graph.change("/last", CONFIGURE, ACTIVATE) == [True, True]
    assert graph.processes.stop(node) == 0

    def goals() -> list[str]:
        heard = (entry for entry in graph.world.all("heard") if entry["heard"] == "/last/transition_event")
        return [entry["data"]["goal_state"]["label"] for entry in heard]

    graph.processes.wait_until(lambda: goals()[-2:] == ["shuttingdown", "finalized"], "the node is finalized")


@dataclass(frozen=True)
class Watch:
    """The node of `managed/watch.rscd`, with operations on it."""

    graph: Graph
    node: subprocess.Popen[bytes]
    log: Path

    def change(self, *transitions: int) -> None:
        assert self.graph.change("/watch", *transitions) == [True] * len(transitions)

    def give(self, name: str, value: float) -> None:
        assert self.graph.manage("give", "/watch", name, str(value))

    def times(self, event: str) -> int:
        return len(log_of(self.log, event))

    def order(self, *numbers: float) -> None:
        """Publish an order, and wait until the node receives it."""
        before, world = self.times(ORDER), self.graph.world
        self.graph.processes.wait_until(lambda: world.do("listeners", topic="/errand") == 1, "the node listens")
        world.do("publish", topic="/errand", fields={"data": numbers})
        self.until(ORDER, before + 1)

    def until(self, event: str, times: int) -> None:
        self.graph.processes.wait_until(lambda: self.times(event) == times, f"{event} happened {times} times")

    @property
    def speeds(self) -> list[float]:
        """Return the speeds that the node sent."""
        return [entry["data"]["value"] for entry in log_of(self.log, SPEED)]

    def until_last(self, speed: float) -> None:
        self.graph.processes.wait_until(lambda: self.speeds[-1:] == [speed], f"{speed} is sent last")


@pytest.fixture
def watch(graph: Graph) -> Watch:
    """The node, configured but not active yet."""
    (graph.folder / "watch.jsonl").unlink(missing_ok=True)
    graph.world.do("advertise", topic="/errand", kind="std_msgs/Float64MultiArray")
    watch = Watch(graph, *graph.start("managed_watch", "watch", "pause:=0.02"))
    watch.change(CONFIGURE)
    return watch


def test_no_time_is_up_while_a_managed_node_is_not_active(watch: Watch) -> None:
    watch.order(0.5)
    time.sleep(0.5)
    assert (watch.times(UP), watch.times(BEEP)) == (0, 0)
    before = time.time()
    watch.change(ACTIVATE)
    watch.until(BEEP, 1)
    (up,) = log_of(watch.log, UP)
    assert up["time"] >= before + 0.02
    watch.order(0.5)
    watch.until(BEEP, 2)


def test_times_of_a_managed_node_start_anew_where_it_is_activated(watch: Watch) -> None:
    """A restarted timer uses the current value of the parameter; a running one keeps its duration."""
    watch.change(ACTIVATE)
    watch.give("pause", 600.0)
    watch.order(0.5)
    watch.change(DEACTIVATE)
    watch.give("pause", 0.02)
    time.sleep(0.5)
    assert watch.times(UP) == 0
    watch.change(ACTIVATE)
    watch.until(BEEP, 1)
    assert watch.times(UP) == 1


def test_a_managed_node_keeps_its_data_until_it_is_cleaned_up(watch: Watch) -> None:
    """After activation the node sends values that differ from the last ones sent; after cleanup, every value."""
    watch.change(ACTIVATE)
    watch.until_last(0.0)
    watch.order(0.5, 2.0)
    watch.until_last(2.0)
    watch.give("gain", 2.0)
    watch.until_last(4.0)
    watch.change(DEACTIVATE)
    watch.give("gain", 3.0)
    watch.order(1.0)
    assert watch.speeds == [0.0, 2.0, 4.0]
    watch.change(ACTIVATE)
    watch.until_last(3.0)
    watch.change(DEACTIVATE, ACTIVATE)
    watch.order(0.0)
    watch.until_last(0.0)
    assert watch.speeds == [0.0, 2.0, 4.0, 3.0, 0.0]
    watch.change(DEACTIVATE, CLEAN_UP)
    watch.give("gain", 5.0)
    log = watch.log.rename(watch.log.with_suffix(".first"))
    watch.change(CONFIGURE, ACTIVATE)
    watch.until_last(0.0)
    watch.order(1.0)
    watch.until_last(5.0)
    assert watch.speeds == [0.0, 5.0]
    assert len(log_of(log, SPEED)) == 5


@pytest.mark.parametrize("parameter", ["period_ms:=0", "watchdog_ms.stop:=-1", "watchdog_stops:=3"])
def test_a_managed_node_that_can_not_be_configured_is_connected_to_nothing(graph: Graph, parameter: str) -> None:
    graph.world.do("advertise", topic="/order", kind="std_msgs/Float64")
    node, _ = graph.start("managed_porter", "unfit", parameter)
    assert not graph.manage("change", "/unfit", CONFIGURE)
    assert "not configured: " in (graph.folder / "unfit.log").read_text()
    graph.processes.wait_until(lambda: graph.world.do("listeners", topic="/order") == 0, "nobody listens")
    # An unconfigured node accepts another attempt.
    assert not graph.manage("change", "/unfit", CONFIGURE)
    assert graph.processes.stop(node) == 0


def test_parameters_say_what_they_mean(graph: Graph) -> None:
    node, _ = graph.start("porter_controller", "described", "qos_overrides./stop.subscription.depth:=3")
    names = ["period_ms", "service_timeout_ms", "watchdog_ms.stop", "watchdog_stops"]
    overrides = ["qos_overrides./cmd_vel.publisher.reliability", "qos_overrides./stop.subscription.depth"]
    described = graph.manage("describe", "/described", *names, *overrides)
    assert set(described) == {*names, *overrides}
    assert described["period_ms"] == ["Period of ticks.", [[1, 86400000]]]
    assert described["watchdog_ms.stop"] == ["Longest silence of /stop; 0: no limit.", [[0, 86400000]]]
    assert all(meaning for meaning, _ in described.values())
    assert graph.processes.stop(node) == 0


@pytest.mark.parametrize(
    "parameter", ["period_ms:=0", "retry_ms:=quick", "watchdog_ms.stop:=-1", "event_log:=/no/dir/log"]
)
def test_a_wrong_parameter_keeps_the_node_from_starting(graph: Graph, parameter: str) -> None:
    name = parameter.partition(":=")[0]
    node = graph.processes.start("refused", graph.workspace.node("porter_controller", parameter))
    assert node.wait(PATIENCE) != 0
    assert name.replace("_", " ") in (graph.folder / "refused.log").read_text().replace("_", " ")


def test_a_watchdog_stops_the_robot_until_its_topic_speaks(graph: Graph) -> None:
    node, log = graph.start("porter_controller", "watched")
    output = graph.folder / "watched.log"
    graph.processes.wait_until(lambda: "/stop: silent for 400 ms" in output.read_text(), "the topic is silent")
    graph.processes.wait_until(lambda: last(log) == HALT, "the robot is stopped")
    size = log.stat().st_size
    graph.world.do("advertise", topic="/stop", kind="std_msgs/Empty")
    graph.processes.wait_until(lambda: graph.world.do("listeners", topic="/stop"), "the node listens")
    assert log.stat().st_size == size
    graph.world.do("repeat", topic="/stop", fields={}, hz=10)
    graph.until_commanded("/cmd_vel")
    assert "/stop: speaks again" in output.read_text()
    graph.world.do("silence", topic="/stop")
    assert graph.processes.stop(node) == 0
    assert last(log) == HALT
