"""The partners of a test: peers, and the node under test among them."""

from __future__ import annotations

import json
import math
import re
import threading
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import subprocess
    from collections.abc import Callable

    from tests.ros.processes import Processes

HERE = Path(__file__).parent
DOCUMENTATION = HERE.parents[2] / "docs" / "faults.md"
STATE = "/scout_controller/state"
#: Topics of the world: `HEARD` it receives from the node, `SENT` it publishes, all but /bumper.
DIAGNOSTICS = "/diagnostics"
HEARD = {
    "/cmd_vel": "geometry_msgs/Twist",
    STATE: "std_msgs/String",
    DIAGNOSTICS: "diagnostic_msgs/DiagnosticArray",
}
SENT = {
    "/light": "std_msgs/Bool",
    "/travel_order": "std_msgs/Bool",
    "/survey_order": "std_msgs/Bool",
    "/tour_order": "std_msgs/Bool",
    "/scan": "sensor_msgs/LaserScan",
    "/charge": "std_msgs/Int16",
    "/pulse": "std_msgs/Int32",
    "/stop": "std_msgs/Empty",
    "/continue": "std_msgs/Empty",
}
#: The command that the node sends in each tick of the control loop if no condition prevents it.
MOVE = "message_move.c_trigger"
PACE = 0.25
#: A scan with a clear way; the second ray sets the pace.
CLEAR = {"ranges": [1.0, PACE]}
#: Seconds for an immediate effect on a busy machine.
PATIENCE = 120.0
#: Seconds for which ROS 2 still lists a killed server.
LEASE = 21.0


class Peer:
    """A running program `peer.py`: a node on the robot's side. `said` contains all its lines."""

    def __init__(self, processes: Processes, python: str, version: int, name: str) -> None:
        self.name = name
        self.said: list[dict[str, Any]] = []
        self._said_something = threading.Condition()
        self._replies: list[dict[str, Any]] = []
        self._processes = processes
        command = [python, HERE / "peer.py", str(version), name]
        self.process = processes.start(name, command, steered=True)
        threading.Thread(target=self._read, daemon=True).start()
        self._reply("start")

    def do(self, command: str, **arguments: Any) -> Any:
        """Execute a command in the peer and return its result."""
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps({"do": command, **arguments}).encode() + b"\n")
        self.process.stdin.flush()
        return self._reply(command)

    def all(self, kind: str, since: int = 0) -> list[dict[str, Any]]:
        """Return the lines of the peer with a certain key, such as `heard` or `goal`."""
        return [entry for entry in self.said[since:] if kind in entry]

    def wait(self, kind: str, since: int = 0, value: Any = None, seconds: float = PATIENCE) -> dict[str, Any]:
        """Wait for a line with a certain key, and with a certain value if there is one; return the first."""

        def found() -> list[dict[str, Any]]:
            return [entry for entry in self.all(kind, since) if value is None or entry[kind] == value]

        with self._said_something:
            if not self._said_something.wait_for(found, seconds):
                wanted = kind if value is None else f"{kind} {value}"
                raise AssertionError(f"{self.name}: no {wanted} within {seconds} s\n{self._processes.logs()}")
        return found()[0]

    def _reply(self, command: str) -> Any:
        with self._said_something:
            if not self._said_something.wait_for(lambda: self._replies, PATIENCE):
                raise AssertionError(f"{self.name}: {command} takes too long\n{self._processes.logs()}")
            reply = self._replies.pop()
        assert "failed" not in reply, reply["failed"]
        return reply["result"]

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            with self._said_something, suppress(json.JSONDecodeError):
                what = json.loads(line)
                (self._replies if "did" in what else self.said).append(what)
                self._said_something.notify_all()


@dataclass
class Moment:
    """Lengths of all records at one time."""

    events: int
    output: int
    world: int


@dataclass
class Scout:
    """A running node of `scout.rscd`, the world around it, and the server that it calls.

    `world` publishes the topics and receives the commands and reports. `server`, if any, offers services and actions.
    `start` starts a node with a name for its output; `meet` starts a peer.
    """

    version: int
    processes: Processes
    start: Callable[[str], subprocess.Popen[bytes]]
    meet: Callable[[str], Peer]
    folder: Path
    event_log: Path
    starts: int = 0
    process: subprocess.Popen[bytes] = field(init=False)
    world: Peer = field(init=False)
    server: Peer | None = None
    _events: list[dict[str, Any]] = field(default_factory=list)
    _read: int = 0
    _killed: float = -math.inf

    def __post_init__(self) -> None:
        self.world = self.meet("world")
        for topic, kind in HEARD.items():
            self.world.do("listen", topic=topic, kind=kind)
        for topic, kind in SENT.items():
            depth = {"depth": 50000} if topic == "/pulse" else {}
            self.world.do("advertise", topic=topic, kind=kind, **depth)
        self.restart()

    def restart(self) -> None:
        """Start the node as a new process with a log file of its own."""
        self.starts += 1
        self.process = self.start(f"node{self.starts}")

    def ready(self) -> Scout:
        """Wait until the node is connected, publish everything that it needs to drive, and wait until it drives."""
        self.until(lambda: all(self.world.do("listeners", topic=topic) for topic in SENT), "the node listens")
        since = self.now()
        self.world.do("repeat", topic="/scan", fields=CLEAR, hz=20)
        self.until(lambda: self.states(since), "the node reports")
        self.rest()
        return self

    def rest(self) -> None:
        """Withdraw all orders and remove all obstacles; wait until the robot drives."""
        self.world.do("repeat", topic="/scan", fields=CLEAR, hz=20)
        for topic in ("/light", "/travel_order", "/survey_order", "/tour_order"):
            self.send(topic, data=False)
        self.send("/continue")
        at_rest = {"Lamp": "dark", "Navigator": "home", "Surveyor": "ready", "EmergencyStop": "in_service"}
        self.until(lambda: all(self.state(name) == state for name, state in at_rest.items()), "the node is at rest")
        since = self.now()
        self.until(lambda: PACE in self.speeds(since), "the robot drives")

    def serve(self, succeed: bool = False) -> Peer:
        """Start the server if necessary. It waits for decisions of the test; with `succeed`, all goals succeed."""
        server = self.server or self.meet("server")
        server.do("answer_at_once", fields=None)
        server.do("accept_at_once", accept=succeed, succeed=succeed)
        server.do("on_cancel", answer="grant")
        if self.server is None:
            server.do("serve", name="/lamp", kind="std_srvs/SetBool")
            server.do("act", name="/travel", kind="nav2_msgs/NavigateToPose")
            server.do("serve", name="/survey", kind="nav2_msgs/GetCosts")
            server.do("act", name="/tour", kind="nav2_msgs/FollowWaypoints")
        self.server = server
        return server

    def dismiss_server(self) -> None:
        """End the server in order, and wait until the ROS graph contains nothing of a killed server."""
        if self.server is not None:
            assert self.server.process.stdin is not None
            self.server.process.stdin.close()
            self.server.process.wait(PATIENCE)
            self.server = None
        if self.version == 2:
            self.nothing(max(0.0, self._killed + LEASE - time.monotonic()))

    def kill_server(self) -> None:
        """End the server like a crash."""
        if self.server is not None:
            self.server.process.kill()
            self.server.process.wait()
            self.server = None
            self._killed = time.monotonic()

    def now(self) -> Moment:
        """Return the current lengths of all records."""
        return Moment(len(self.log()), len(self.output()), len(self.world.said))

    def log(self, since: Moment | None = None) -> list[dict[str, Any]]:
        """Return the entries of the event log."""
        if self.event_log.exists():
            with self.event_log.open("rb") as file:
                file.seek(self._read)
                text = file.read()
            complete = text[: text.rfind(b"\n") + 1]
            self._read += len(complete)
            self._events += map(json.loads, complete.splitlines())
        return self._events[since.events if since else 0 :]

    def events(self, since: Moment, name: str) -> list[dict[str, Any]]:
        """Return the entries of one event."""
        return [entry for entry in self.log(since) if entry["event"] == name]

    def output(self, since: Moment | None = None) -> str:
        """Return the output of the node."""
        text = (self.folder / f"node{self.starts}.log").read_text(errors="replace")
        return text[since.output if since else 0 :]

    def commands(self, since: Moment) -> list[dict[str, Any]]:
        """Return the messages that the world received on /cmd_vel."""
        return [entry for entry in self.world.all("heard", since.world) if entry["heard"] == "/cmd_vel"]

    def speeds(self, since: Moment) -> list[float]:
        """Return the forward speeds that the world received."""
        return [command["data"]["linear"]["x"] for command in self.commands(since)]

    def ticked_between(self, since: Moment, first: str, last: str) -> bool:
        """Whether the node drove between the first occurrences of two events."""
        names = [entry["event"] for entry in self.log(since)]
        return MOVE in names[names.index(first) : names.index(last)]

    def states(self, since: Moment) -> list[dict[str, Any]]:
        """Return the state reports of the node."""
        heard = self.world.all("heard", since.world)
        return [json.loads(entry["data"]["data"]) for entry in heard if entry["heard"] == STATE]

    def until_reported(self) -> None:
        """Wait for a report that covers all events until now; reports may be outdated on arrival."""
        last = self.log()[-1]["time"]
        self.until(lambda: self._last_report()["time"] >= last, "the state is reported")

    def state(self, component: str) -> Any:
        """Return the state of a component in the last report."""
        return self._last_report()["components"][component]["state"]

    def variable(self, component: str, name: str) -> Any:
        """Return the value of a variable in the last report."""
        return self._last_report()["components"][component]["variables"][name]

    def _last_report(self) -> Any:
        last = next(entry for entry in reversed(self.world.said) if entry.get("heard") == STATE)
        return json.loads(last["data"]["data"])

    def until_diagnosed(self, component: str, message: str, **values: str) -> None:
        """Wait until the diagnostics contain this status of a component; `request_to_x` stands for `request to x`."""
        expected = {name.replace("_to_", " to "): value for name, value in values.items()}

        def told() -> bool:
            heard = [entry["data"]["status"] for entry in self.world.said if entry.get("heard") == DIAGNOSTICS]
            name = f"scout_controller: {component}"
            for status in heard[-1] if heard else ():
                if status["name"] == name and status["message"] == message:
                    assert status["level"] == (";" in message)
                    found = {value["key"]: value["value"] for value in status["values"]}
                    return expected.items() <= found.items()
            return False

        self.until(told, f"{component} is diagnosed: {message} {expected}")

    @staticmethod
    def nothing(seconds: float) -> None:
        """Let time pass in which something must not happen."""
        time.sleep(seconds)

    def until(self, condition: Callable[[], object], what: str, seconds: float = PATIENCE) -> None:
        """Wait for a condition."""
        self.processes.wait_until(lambda: bool(condition()), what, seconds)

    def until_event(self, since: Moment, name: str, count: int = 1, seconds: float = PATIENCE) -> dict[str, Any]:
        """Wait until an event has occurred `count` times; return that entry of the log."""
        self.until(lambda: len(self.events(since, name)) >= count, f"{count} times {name}", seconds)
        return self.events(since, name)[count - 1]

    def until_state(self, component: str, state: str, seconds: float = PATIENCE) -> None:
        """Wait until the node reports a component in a state."""
        self.until(lambda: self.state(component) == state, f"{component} is {state}", seconds)

    def until_says(self, since: Moment | None, text: str, seconds: float = PATIENCE) -> None:
        """Wait until the node prints a message that the documentation quotes."""
        self.until(lambda: self.says(since, text), f"the node says {text!r}", seconds)

    def says(self, since: Moment | None, text: str) -> int:
        """Count the occurrences of a quoted message in the output; `…` in it matches any part of a line."""
        assert f"`{text}`" in DOCUMENTATION.read_text(), f"{DOCUMENTATION.name} does not quote {text!r}"
        return len(re.findall(".*?".join(map(re.escape, text.split("…"))), self.output(since)))

    def memory(self) -> float:
        """Return the resident memory of the node, in MB."""
        found = re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{self.process.pid}/status").read_text())
        assert found
        return int(found[1]) / 1024

    def send(self, topic: str, **fields: Any) -> None:
        """Publish a message of the world."""
        self.world.do("publish", topic=topic, fields=fields)
