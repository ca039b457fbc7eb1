"""A base with a lift, the server that executes its goals, and the world that sends orders and receives lift calls."""

from __future__ import annotations

import json
import os
import signal
import time
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.model.semantics.naming import below_layer
from tests.ros.faults.partners import LEASE, Peer
from tests.ros.reactions import one_process
from tests.ros.running import Runner
from tests.ros.workspaces import Workspace, middleware

if TYPE_CHECKING:
    import subprocess
    from collections.abc import Callable, Iterator

    from tests.ros.processes import Processes

HERE = Path(__file__).parent
CARRIER, CARELESS = HERE / "carrier.rscd", HERE / "careless.rscd"
TOPICS, SERVICE, ACTION = ("/pressed", "/wanted"), "/raise", "/navigate"
PARTS = tuple(f"_action/{part}" for part in ("send_goal", "cancel_goal", "get_result", "feedback", "status"))
DIAGNOSTICS = "/diagnostics"
TRIGGER, CANCEL, FEEDBACK, CANCELED, RESPONSE, ERROR = (
    f"action_navigate.{event}"
    for event in ("c_trigger", "c_cancel", "u_feedback", "u_canceled", "u_response", "u_error")
)
#: Timeout of the node under test for the acceptance of a goal and for the answer to a cancel, in milliseconds.
WAIT_MS = 2000
LATE = f"/navigate: not accepted within {WAIT_MS} ms"
ATTEMPTS = 10
RAISE = "service_raise.c_trigger"


@dataclass
class Base:
    """A running base. Its node is a controller, or a layer before a controller without any safety conditions."""

    nodes: Workspace | Runner
    layer: bool
    processes: Processes
    folder: Path
    world: Peer = field(init=False)
    server: Peer = field(init=False)
    node: subprocess.Popen[bytes] = field(init=False)
    _peers: int = 0
    _nodes: int = 0
    _killed: float = -1e9

    def __post_init__(self) -> None:
        self.world = self._meet("world")
        self.world.do("listen", topic=f"/{self.name}/state", kind="std_msgs/String")
        self.world.do("listen", topic=DIAGNOSTICS, kind="diagnostic_msgs/DiagnosticArray")
        for topic in TOPICS:
            self.world.do("advertise", topic=topic, kind="std_msgs/Bool")
        self.world.do("answer_at_once", fields={"success": True})
        self.world.do("serve", name=SERVICE, kind="std_srvs/SetBool")
        self.serve()
        self.start()

    @property
    def version(self) -> int:
        return self.nodes.ros.version

    @property
    def name(self) -> str:
        """Return the name of the node under test."""
        return "carrier_layer" if self.layer else "carrier_controller"

    def _meet(self, name: str) -> Peer:
        self._peers += 1
        return Peer(self.processes, self.nodes.ros.python, self.version, name)

    # The node

    def start(self) -> None:
        """Start the node, and the controller behind a layer; wait until the base is at rest."""
        self._nodes += 1
        self.node = self.processes.start(f"node{self._nodes}", self._command())
        if self.layer and self._nodes == 1:
            self.processes.start("careless", self._careless())
        self.until(lambda: all(self.world.do("listeners", topic=topic) for topic in TOPICS), "the node listens")
        self.rest()

    def _command(self) -> list[str | Path]:
        settings, parameters = (
            HERE / "controller-config.json",
            [f"event_log:={self.log}", f"action_timeout_ms:={WAIT_MS}"],
        )
        if isinstance(self.nodes, Runner):
            return [*self.nodes.command(CARRIER, *parameters, layer=self.layer, configuration=settings)]
        return one_process(self.nodes, self.name, *parameters)

    def _careless(self) -> list[str | Path]:
        """Return the command of the controller behind the layer: compiled or run from its model, like the layer."""
        names = [*TOPICS, SERVICE, *(f"{ACTION}/{part}" for part in PARTS)]
        remappings = [f"{name}:=/{self.name}/{below_layer(name)}" for name in names]
        if isinstance(self.nodes, Workspace):
            return [*self.nodes.node("careless_controller"), *(word for name in remappings for word in ("-r", name))]
        settings = HERE / "controller-config.json"
        return [*self.nodes.command(CARELESS, configuration=settings, remappings=remappings)]

    @property
    def log(self) -> Path:
        """Return the path of the event log."""
        return self.folder / f"events{self._nodes}.jsonl"

    @property
    def output(self) -> str:
        """Return the output of the node."""
        return (self.folder / f"node{self._nodes}.log").read_text(errors="replace")

    def events(self, since: int = 0) -> list[str]:
        """Return the events of the action and of the lift, from a line of the log on."""
        text = self.log.read_text() if self.log.exists() else ""
        entries = [json.loads(line) for line in text[: text.rfind("\n") + 1].splitlines()[since:]]
        happened = [entry["event"] for entry in entries if entry["direction"] != "blocked"]
        return [event for event in happened if event.startswith(("action", "service")) and "reset" not in event]

    def lines(self) -> int:
        """Return the number of lines in the log."""
        return self.log.read_text().count("\n") if self.log.exists() else 0

    def state(self, component: str) -> str:
        """Return the state of a component in the last report."""
        reports = [entry for entry in self.world.said if entry.get("heard") == f"/{self.name}/state"]
        return json.loads(reports[-1]["data"]["data"])["components"][component]["state"] if reports else ""

    def warns(self, text: str) -> bool:
        """Whether the last diagnostics contain a warning with this text."""
        reports = [entry["data"]["status"] for entry in self.world.said if entry.get("heard") == DIAGNOSTICS]
        own = [status for status in (reports[-1] if reports else ()) if status["name"].startswith(f"{self.name}: ")]
        return any(status["level"] == 1 and text in status["message"] for status in own)

    # The world

    def send(self, topic: str, value: bool) -> None:
        """Publish a message."""
        self.world.do("publish", topic=topic, fields={"data": value})

    def rest(self) -> None:
        """Withdraw all orders; wait until the base stands and its lift is down."""

        def at_rest() -> bool:
            for topic in ("/wanted", "/pressed"):
                self.send(topic, value=False)
            return self.state("Navigation") == "still" and self.state("Lift") == "down"

        self.server.do("on_cancel", answer="grant")
        self.server.do("accept_at_once", accept=True)
        self.until(at_rest, "the base is at rest")

    def lifted(self, since: int) -> bool:
        """Whether the node called the lift."""
        return bool(self.world.all("called", since))

    def until(self, condition: Callable[[], object], what: str) -> None:
        """Wait for a condition."""
        self.processes.wait_until(lambda: bool(condition()), what)

    def until_event(self, name: str, since: int) -> None:
        """Wait until an event is in the log."""
        self.until(lambda: name in self.events(since), f"{name} happens")

    # The server

    def serve(self) -> None:
        """Start the server; the test decides about each goal."""
        self.server = self._meet("server")
        self.server.do("act", name=ACTION, kind="nav2_msgs/NavigateToPose")

    def kill_server(self) -> None:
        """End the server like a crash."""
        self.server.process.kill()
        self.server.process.wait()
        self._killed = time.monotonic()

    def outlive_server(self) -> None:
        """Wait until the ROS graph contains nothing of a killed server."""
        if self.version == 2:
            time.sleep(max(0.0, self._killed + LEASE - time.monotonic()))

    def pause_server(self) -> None:
        """Stop the server process; the node gets no notice."""
        os.kill(self.server.process.pid, signal.SIGSTOP)

    def resume_server(self) -> None:
        """Resume the server process."""
        os.kill(self.server.process.pid, signal.SIGCONT)


@contextmanager
def under_way(nodes: Workspace | Runner, folder: Path, *, layer: bool) -> Iterator[Base]:
    """Run a base, its world and its server, each in a process of its own."""
    with middleware(nodes, folder) as processes:
        base = Base(nodes, layer, processes, folder)
        try:
            yield base
        finally:
            base.resume_server()
            for peer in (base.world, base.server):
                peer.process.kill()  # the peers need no orderly end


@dataclass
class Drive:
    """A goal under way: its number at the server, and the lengths of all records at its start."""

    base: Base
    number: int
    lines: int
    world: int
    server: int

    @classmethod
    def begin(cls, base: Base, accept: bool = True) -> Drive:
        """Set off and wait until the node has its goal accepted, in several attempts on a busy machine."""
        for _ in range(ATTEMPTS):
            base.server.do("on_cancel", answer="ignore")
            base.server.do("accept_at_once", accept=accept)
            drive = cls(base, -1, base.lines(), len(base.world.said), len(base.server.said))
            late = base.output.count(LATE)
            base.until(drive.ordered, "there is a goal")
            if not drive.goals:
                base.rest()
                continue
            drive.number = drive.goals[0]
            if not accept:
                return drive
            base.server.do("progress", number=drive.number, fields={})
            base.until(lambda drive=drive: {FEEDBACK, ERROR} & set(drive.events), "the goal is accepted")
            if ERROR not in drive.events and base.output.count(LATE) == late:
                return drive
            drive.end("aborted")
            base.rest()
        raise AssertionError(f"no goal in time in {ATTEMPTS} attempts")

    def ordered(self) -> bool:
        """Order the base to set off. The order is repeated because the node may not be connected yet."""
        self.base.send("/wanted", value=True)
        return bool(self.goals) or ERROR in self.events

    @property
    def goals(self) -> list[int]:
        """Return the numbers of the goals that the server received during this drive."""
        return [entry["goal"] for entry in self.base.server.all("goal", self.server)]

    @property
    def events(self) -> list[str]:
        """Return the events of the action and of the lift during this drive."""
        return self.base.events(self.lines)

    def press(self) -> None:
        """Press the button and wait until the node cancels the goal."""
        self.base.send("/pressed", value=True)
        self.until(CANCEL)

    def until(self, event: str) -> None:
        """Wait for an event of this drive."""
        self.base.until_event(event, self.lines)

    def until_asked(self, count: int = 1) -> None:
        """Wait until the server received a number of requests to cancel the goal."""
        self.base.until(lambda: self.asked >= count, f"the server is asked {count} times to cancel the goal")

    @property
    def asked(self) -> int:
        """Return the number of requests to cancel the goal that the server received."""
        return len([entry for entry in self.base.server.all("cancel", self.server) if entry["cancel"] == self.number])

    def rolls(self, seconds: float) -> None:
        """Let the wheels turn for some seconds; check that the lift stays down and the goal counts as running."""
        time.sleep(seconds)
        assert not self.base.lifted(self.world)
        assert self.base.state("Navigation") in ("driving", "stopping")
        assert not {CANCELED, RESPONSE, ERROR, RAISE} & set(self.events)

    def end(self, how: str) -> None:
        """End the goal: the wheels have stopped."""
        self.base.server.do("end", number=self.number, how=how)

    def until_lifted(self, end: str) -> None:
        """Wait until the node calls the lift, and check that the call follows the end of the goal."""
        self.base.until(lambda: self.base.lifted(self.world), "the lift is called")
        self.until(RAISE)
        events = self.events
        assert events.index(end) < events.index(RAISE)

    def never_lifted(self, seconds: float = 1.0) -> None:
        """Check that the node never calls the lift after a lost goal, because the wheels may still turn."""
        self.base.until(lambda: self.base.state("Navigation") == "lost", "the base is lost")
        time.sleep(seconds)
        assert not self.base.lifted(self.world)
        assert RAISE not in self.events
