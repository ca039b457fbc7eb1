"""A gate in this process: its node without ROS runs in a thread, and the test's clients call its tools."""

from __future__ import annotations

import json
import threading
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcp import Client

import robosc
from robosc.base.ros_types import RosTypes
from robosc.language.configuration import read as read_configuration
from robosc.language.configuration.parameters import layer_parameters
from robosc.m2t.models import Models
from robosc.model.semantics.messages import find_message
from robosc.run.runtime.core.event_log import EventLog
from robosc.run.runtime.core.gate import GatedLayer
from robosc.run.runtime.core.settings import SafeMessages, Settings
from robosc.tools.gate.admission import Limits
from robosc.tools.gate.commands import commands
from robosc.tools.gate.dry import DryNode, robot_events
from robosc.tools.gate.gate import Gate
from robosc.tools.gate.server import server

if TYPE_CHECKING:
    from collections.abc import Iterator

HERE = Path(__file__).parent
PORTER = HERE / "porter.rscd"
CONFIGURATION = HERE / "controller-config.json"


@cache
def models(path: Path = PORTER) -> Models:
    """Return the models of a robot with its supervisor."""
    robot = robosc.load(path)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return Models(model, robosc.to_rosgraph(robot), robot, RosTypes())


class Bench:
    """A gate of the porter, its log of calls, and what its robot has received."""

    def __init__(self, folder: Path, limits: Limits) -> None:
        self.models = models()
        graph = self.models.rosgraph
        assert graph is not None
        types = self.models.ros_types
        assert types is not None
        configuration = read_configuration(CONFIGURATION)
        self.said: list[str] = []
        self.node = DryNode("porter_layer", graph, types, self.said.append)
        values = {each.name: each.default for each in layer_parameters(graph, configuration, "")}
        settings = Settings(values | {"action_timeout_ms": 500, "service_timeout_ms": 500}, configuration)
        instead = [sending for name in configuration.on_blocked if (sending := find_message(graph, name)) is not None]
        safe = SafeMessages(on_blocked=instead)
        self.layer = GatedLayer(graph, settings, self.node, self.node.event_loop, safe)
        self.node.connect(self.layer, settings)
        self.path = folder / "calls.jsonl"
        self._log = EventLog(str(self.path))
        events = robot_events(self.node, graph, types)
        known, frames = commands(self.models), configuration.frame_id
        self.gate = Gate(self.models.sct, known, self.node, self.layer, self._log, limits, frames, events)

    def received(self) -> list[tuple[str, Any]]:
        """Return the commands that the robot has received, with their data."""
        return [(name, self.gate._messages.plain(message)) for name, message in self.node.robot.received]

    def state(self) -> Any:
        """Return the state of the supervisor."""
        return self.layer._control.engine.saved

    def calls(self) -> list[dict[str, Any]]:
        """Return the log of calls."""
        self._log.flush()
        return [json.loads(line) for line in self.path.read_text(encoding="utf-8").splitlines()]


@contextmanager
def gate(folder: Path, **limits: float) -> Iterator[Bench]:
    """Run a gate; by default with so many calls a second that no test is refused."""
    bench = Bench(folder, Limits(**{"rate": 1e6, "total": 1e6, **limits}))  # type: ignore[arg-type]
    over = threading.Event()

    def run() -> None:
        bench.layer.start()
        while not over.is_set():
            bench.node._spin_once()

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield bench
    finally:
        over.set()
        bench.node.wake()
        thread.join()
        bench.layer.close()
        bench._log.close()


def connect(bench: Bench) -> Client:
    """Return a client of a gate in this process."""
    return Client(server(bench.gate))


async def call(client: Client, tool: str, **data: Any) -> dict[str, Any]:
    """Call a tool; return its answer, which is an error as its verdict is."""
    result = await client.call_tool(tool, data)
    answer: dict[str, Any] = result.structured_content
    assert result.is_error == (answer["verdict"] in ("refused", "failed"))
    assert json.loads(result.content[0].text) == answer  # type: ignore[union-attr]
    return answer
