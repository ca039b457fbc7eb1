"""The test's ends of what it steers: peers, and the node that they meet."""

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
#: What the world hears of the node, and what it sends: all but /bumper.
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
#: What the node sends in each tick of the control loop where nothing keeps it.
MOVE = "message_move.c_trigger"
PACE = 0.25
#: The way is clear; the second ray gives the pace.
CLEAR = {"ranges": [1.0, PACE]}
#: Seconds for what should happen at once, on a machine that is busy.
PATIENCE = 120.0
#: Seconds for which ROS 2 takes a server that was killed to be there.
LEASE = 21.0


class Peer:
    """A program `peer.py` under way: a node on the robot's side. All that it says is in `said`."""

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
        """Has the peer do something; what it answers."""
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps({"do": command, **arguments}).encode() + b"\n")
        self.process.stdin.flush()
        return self._reply(command)

    def all(self, kind: str, since: int = 0) -> list[dict[str, Any]]:
        """What the peer said with a certain key, such as `heard` or `goal`."""
        return [entry for entry in self.said[since:] if kind in entry]

    def wait(self, kind: str, since: int = 0, value: Any = None, seconds: float = PATIENCE) -> dict[str, Any]:
        """The first thing that the peer says with a certain key, and a certain value where one is given."""

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
    """How much there was of everything at one time."""

    events: int
    output: int
    world: int


@dataclass
class Scout:
    """A node of `scout.rscd` under way, with the world around it and the server that it calls.

    `world` publishes the topics and hears the commands and reports; `server`, where there is one, offers service and
    action. `start` starts a node with a name for its output, `meet` a peer.
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
        """Starts the node, a new process with an output of its own."""
        self.starts += 1
        self.process = self.start(f"node{self.starts}")

    def ready(self) -> Scout:
        """Waits until the node is connected, then gives it all that it needs to drive, and waits until it does."""
        self.until(lambda: all(self.world.do("listeners", topic=topic) for topic in SENT), "the node listens")
        since = self.now()
        self.world.do("repeat", topic="/scan", fields=CLEAR, hz=20)
        self.until(lambda: self.states(since), "the node reports")
        self.rest()
        return self

    def rest(self) -> None:
        """Ends all that was ordered, and what hinders the robot."""
        self.world.do("repeat", topic="/scan", fields=CLEAR, hz=20)
        for topic in ("/light", "/travel_order", "/survey_order", "/tour_order"):
            self.send(topic, data=False)
        self.send("/continue")
        at_rest = {"Lamp": "dark", "Navigator": "home", "Surveyor": "ready", "EmergencyStop": "in_service"}
        self.until(lambda: all(self.state(name) == state for name, state in at_rest.items()), "the node is at rest")
        since = self.now()
        self.until(lambda: PACE in self.speeds(since), "the robot drives")

    def serve(self, succeed: bool = False) -> Peer:
        """The server, started where there is none; all waits for what the test decides, but for goals that succeed."""
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
        """Ends the server in order; afterwards there is none, nor what is left of one that was killed."""
        if self.server is not None:
            assert self.server.process.stdin is not None
            self.server.process.stdin.close()
            self.server.process.wait(PATIENCE)
            self.server = None
        if self.version == 2:
            self.nothing(max(0.0, self._killed + LEASE - time.monotonic()))

    def kill_server(self) -> None:
        """Ends the server as a crash does."""
        if self.server is not None:
            self.server.process.kill()
            self.server.process.wait()
            self.server = None
            self._killed = time.monotonic()

    def now(self) -> Moment:
        """Where everything stands."""
        return Moment(len(self.log()), len(self.output()), len(self.world.said))

    def log(self, since: Moment | None = None) -> list[dict[str, Any]]:
        """The event log."""
        if self.event_log.exists():
            with self.event_log.open("rb") as file:
                file.seek(self._read)
                text = file.read()
            complete = text[: text.rfind(b"\n") + 1]
            self._read += len(complete)
            self._events += map(json.loads, complete.splitlines())
        return self._events[since.events if since else 0 :]

    def events(self, since: Moment, name: str) -> list[dict[str, Any]]:
        """The events of a certain name."""
        return [entry for entry in self.log(since) if entry["event"] == name]

    def output(self, since: Moment | None = None) -> str:
        """What the node printed."""
        text = (self.folder / f"node{self.starts}.log").read_text(errors="replace")
        return text[since.output if since else 0 :]

    def commands(self, since: Moment) -> list[dict[str, Any]]:
        """What the world received on /cmd_vel."""
        return [entry for entry in self.world.all("heard", since.world) if entry["heard"] == "/cmd_vel"]

    def speeds(self, since: Moment) -> list[float]:
        """The forward speeds that the world received."""
        return [command["data"]["linear"]["x"] for command in self.commands(since)]

    def ticked_between(self, since: Moment, first: str, last: str) -> bool:
        """Whether the node drove on between an event and another one, each where it happened first."""
        names = [entry["event"] for entry in self.log(since)]
        return MOVE in names[names.index(first) : names.index(last)]

    def states(self, since: Moment) -> list[dict[str, Any]]:
        """What the node reported of its state."""
        heard = self.world.all("heard", since.world)
        return [json.loads(entry["data"]["data"]) for entry in heard if entry["heard"] == STATE]

    def until_reported(self) -> None:
        """Waits for a report on all that has happened until now; what comes first may have been on its way already."""
        last = self.log()[-1]["time"]
        self.until(lambda: self._last_report()["time"] >= last, "the state is reported")

    def state(self, component: str) -> Any:
        """The state of a component, as last reported."""
        return self._last_report()["components"][component]["state"]

    def variable(self, component: str, name: str) -> Any:
        """The value of a variable, as last reported."""
        return self._last_report()["components"][component]["variables"][name]

    def _last_report(self) -> Any:
        last = next(entry for entry in reversed(self.world.said) if entry.get("heard") == STATE)
        return json.loads(last["data"]["data"])

    def until_diagnosed(self, component: str, message: str, **values: str) -> None:
        """Waits until a monitor of robots is told this of a component; `request_to_x` stands for `request to x`."""
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
        """Lets time pass in which something must not happen."""
        time.sleep(seconds)

    def until(self, condition: Callable[[], object], what: str, seconds: float = PATIENCE) -> None:
        """Waits for a condition."""
        self.processes.wait_until(lambda: bool(condition()), what, seconds)

    def until_event(self, since: Moment, name: str, count: int = 1, seconds: float = PATIENCE) -> dict[str, Any]:
        """Waits until an event has happened so many times; its last entry in the log."""
        self.until(lambda: len(self.events(since, name)) >= count, f"{count} times {name}", seconds)
        return self.events(since, name)[count - 1]

    def until_state(self, component: str, state: str, seconds: float = PATIENCE) -> None:
        """Waits until a component is reported to be in a state."""
        self.until(lambda: self.state(component) == state, f"{component} is {state}", seconds)

    def until_says(self, since: Moment | None, text: str, seconds: float = PATIENCE) -> None:
        """Waits until the node has printed what the documentation quotes."""
        self.until(lambda: self.says(since, text), f"the node says {text!r}", seconds)

    def says(self, since: Moment | None, text: str) -> int:
        """How often the node printed what the documentation quotes; `…` there stands for any part of a line."""
        assert f"`{text}`" in DOCUMENTATION.read_text(), f"{DOCUMENTATION.name} does not quote {text!r}"
        return len(re.findall(".*?".join(map(re.escape, text.split("…"))), self.output(since)))

    def memory(self) -> float:
        """What the node holds of the machine's memory, in MB."""
        found = re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{self.process.pid}/status").read_text())
        assert found
        return int(found[1]) / 1024

    def send(self, topic: str, **fields: Any) -> None:
        """Publishes a message of the world's."""
        self.world.do("publish", topic=topic, fields=fields)
