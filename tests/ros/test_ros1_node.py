"""Features of ROS 1 nodes: arguments of the launch file, parameters of any type, and kinds of shutdown."""

from __future__ import annotations

import os
import signal
import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pytest

from tests.ros.faults.partners import Peer
from tests.ros.processes import PATIENCE
from tests.ros.workspaces import Workspace, middleware

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.ros.processes import Processes

PACKAGE = "porter_controller"


@dataclass(frozen=True)
class Graph:
    """A workspace with a master, and a peer `world` that listens to `/cmd_vel`."""

    workspace: Workspace
    processes: Processes
    folder: Path
    world: Peer

    @property
    def executable(self) -> Path:
        return self.workspace.folder / f"devel/lib/{PACKAGE}/{PACKAGE}"

    def python(self, code: str) -> str:
        """Return the output of a piece of code that may use `master` and `param`."""
        begin = "import rosgraph; master = rosgraph.Master('/test'); param = master.getParam\n"
        command = [self.workspace.ros.python, "-c", begin + code]
        done = subprocess.run(
            command, env=self.processes.environment, capture_output=True, text=True, check=True, timeout=PATIENCE
        )
        return done.stdout.strip()

    def ask(self, node: str, *request: str) -> str:
        """Return a node's answer to a request of the ROS 1 slave API."""
        method, *arguments = request
        values = ", ".join(map(repr, ["/test", *arguments]))
        return self.python(
            "from xmlrpc.client import ServerProxy\n"
            f"print(ServerProxy(master.lookupNode('/{node}')).{method}({values}))"
        )

    def connections(self, kind: int, topic: str) -> str:
        """Return the nodes that publish (0) or subscribe to (1) a topic, or offer a service (2)."""
        return self.python(f"print(*dict(master.getSystemState()[{kind}]).get({topic!r}, []))")

    def wait_for(self, kind: int, topic: str, node: str) -> None:
        def there() -> bool:
            return node in self.connections(kind, topic).split()

        self.processes.wait_until(there, f"{node} is on {topic}")

    def output(self, name: str) -> str:
        return (self.folder / f"{name}.log").read_text(errors="replace")


@pytest.fixture(scope="module")
def graph(ros1_workspace: Workspace, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Graph]:
    folder = tmp_path_factory.mktemp("node") / "run"
    with middleware(ros1_workspace, folder) as processes:
        world = Peer(processes, ros1_workspace.ros.python, 1, "world")
        world.do("listen", topic="/cmd_vel", kind="geometry_msgs/Twist")
        yield Graph(ros1_workspace, processes, folder, world)


def test_arguments_of_the_launch_file(graph: Graph) -> None:
    settings = graph.folder / "settings.yaml"
    settings.write_text("period_ms: 40\nretry_ms: 700\nwatchdog_ms: {order: 300}\n")
    arguments = ["name:=carrier", "ns:=hall", "log_level:=debug", f"parameters:={settings}", "period_ms:=30"]
    renamed = ["cmd_vel_topic:=/wheels", "order_topic:=orders", "travel_action:=/drive", "grip_service:=/hand/close"]
    command = graph.workspace.node(PACKAGE, *arguments, *renamed)
    node = graph.processes.start("launched", command)
    graph.wait_for(0, "/wheels", "/hall/carrier")
    graph.wait_for(1, "/hall/orders", "/hall/carrier")
    for end in ("/goal", "/cancel"):
        graph.wait_for(0, f"/drive{end}", "/hall/carrier")
    for end in ("/status", "/feedback", "/result"):
        graph.wait_for(1, f"/drive{end}", "/hall/carrier")
    graph.wait_for(0, "/hall/carrier/state", "/hall/carrier")
    assert graph.connections(0, "/travel/goal") == ""
    assert graph.connections(1, "/hall/order") == ""
    names = ("period_ms", "retry_ms", "watchdog_ms/order")
    assert [graph.python(f"print(param('/hall/carrier/{name}'))") for name in names] == ["30", "700", "300"]
    graph.processes.wait_until(lambda: "order: silent for 300 ms" in graph.output("launched"), "the watchdog reports")
    graph.processes.stop(node)
    assert "DEBUG" in graph.output("launched")
    graph.processes.wait_until(lambda: graph.connections(0, "/wheels") == "", "the node is gone")


def test_a_renaming_around_the_launch_file_holds(graph: Graph) -> None:
    around = graph.folder / "around.launch"
    include = f'<include file="$(find {PACKAGE})/launch/{PACKAGE}.launch"/>'
    around.write_text(f'<launch><group ns="hall"><remap from="cmd_vel" to="wheels"/>{include}</group></launch>')
    node = graph.processes.start("around", ["roslaunch", "--wait", str(around)])
    graph.wait_for(0, "/hall/wheels", f"/hall/{PACKAGE}")
    graph.processes.stop(node)


@pytest.mark.parametrize(
    ("parameter", "complaint"),
    [
        ("_period_ms:=0", "period_ms is 0, not between 1 and 86400000"),
        ("_period_ms:=quick", "period_ms must be a whole number"),
        ("_react_immediately:=3", "react_immediately must be true or false"),
        ("_events_per_tick:=65536", "events_per_tick is 65536, not between 0 and 65535"),
        ("_service_timeout_ms:=-1", "service_timeout_ms is -1, not between 1 and 86400000"),
        ("_watchdog_ms/stop:=-1", "watchdog_ms/stop is -1, not between 0 and 86400000"),
        ("_log_level:=loud", "log_level is loud, not debug, info, warn, error or fatal"),
        ("_event_log:=/no/such/folder/log", "the event log /no/such/folder/log cannot be written"),
    ],
)
def test_a_wrong_parameter_keeps_the_node_from_starting(graph: Graph, parameter: str, complaint: str) -> None:
    node = graph.processes.start("refused", [graph.executable, "__name:=refused", parameter])
    assert node.wait(PATIENCE) == 1
    assert complaint in graph.output("refused")
    graph.python("master.deleteParam('/refused')")


def started(graph: Graph, name: str) -> subprocess.Popen[bytes]:
    """Start a node and wait until it is connected and at rest: later messages on /cmd_vel are those of its end."""
    events = graph.folder / f"{name}.jsonl"
    parameters = ["_watchdog_stops:=false", "_period_ms:=3600000", f"_event_log:={events}"]
    node = graph.processes.start(name, [graph.executable, f"__name:={name}", *parameters])
    graph.wait_for(0, "/cmd_vel", f"/{name}")
    graph.processes.wait_until(lambda: "/cmd_vel" in graph.ask(name, "getBusInfo"), "they are connected")
    return node


@pytest.mark.parametrize("end", ["SIGINT", "SIGTERM", "SIGHUP", "SIGTERM SIGINT", "rosnode", "takeover"])
def test_last_messages_go_out_however_the_node_ends(graph: Graph, end: str) -> None:
    name = f"ends_by_{end.lower().replace(' ', '_')}"
    node = started(graph, name)
    heard = len(graph.world.said)
    if end == "rosnode":
        graph.ask(name, "shutdown", "enough")
    elif end == "takeover":
        graph.processes.start("successor", [graph.executable, f"__name:={name}", "_period_ms:=3600000"])
    else:
        for number in end.split():
            os.kill(node.pid, getattr(signal, number))
    assert graph.world.wait("heard", heard)["data"]["linear"]["x"] == 0.0
    assert node.wait(PATIENCE) == 0
    last = (graph.folder / f"{name}.jsonl").read_text().splitlines()[-1]
    assert '"direction":"outside","event":"message_halt.c_trigger"' in last


def test_outlives_a_hangup_where_it_was_started_so(graph: Graph) -> None:
    node = graph.processes.start("steady", ["nohup", graph.executable, "__name:=steady"])
    graph.wait_for(0, "/cmd_vel", "/steady")
    os.kill(node.pid, signal.SIGHUP)
    with pytest.raises(subprocess.TimeoutExpired):
        node.wait(1.5)
    assert graph.processes.stop(node) == 0


def test_waits_for_a_master_and_can_be_ended(graph: Graph) -> None:
    command = [graph.executable, "__master:=http://127.0.0.1:9"]
    node = graph.processes.start("lonely", command)
    said = "waiting for a master at http://127.0.0.1:9"
    graph.processes.wait_until(lambda: said in graph.output("lonely"), "it says that there is none")
    assert node.poll() is None
    assert graph.processes.stop(node) == 0


def test_waits_for_simulated_time_and_can_be_ended(ros1_workspace: Workspace, tmp_path: Path) -> None:
    with middleware(ros1_workspace, tmp_path / "run", simulated=True) as processes:
        executable = ros1_workspace.folder / f"devel/lib/{PACKAGE}/{PACKAGE}"
        node = processes.start("timeless", [executable])
        log = tmp_path / "run" / "timeless.log"
        processes.wait_until(
            lambda: "waiting for /clock" in log.read_text(errors="replace"), "it says that time stands"
        )
        assert node.poll() is None
        assert processes.stop(node) == 0
