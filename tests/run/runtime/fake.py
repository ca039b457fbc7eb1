"""A port without middleware, and a clock that only a test moves."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import robosc
from robosc.language.configuration import Configuration
from robosc.language.configuration.parameters import controller_parameters, layer_parameters
from robosc.model.semantics.messages import find_message
from robosc.run.runtime.core.controller import Controller
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.node_data import BLANK
from robosc.run.runtime.core.settings import SafeMessages, Settings

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from robosc.model import rosgraph
    from robosc.run.runtime.core.port import CallHandlers, ComponentStatus, Endpoint, GoalHandlers


class Record:
    """ROS data with every field that a reader requests."""

    def __init__(self, **fields: Any) -> None:
        vars(self).update(fields)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return vars(self).setdefault(name, Record())

    def plain(self) -> dict[str, Any]:
        """Return the set fields as nested dicts."""
        return {name: value.plain() if isinstance(value, Record) else value for name, value in vars(self).items()}


class FieldTypes(dict[str, str]):
    """The types of a message's fields; undeclared fields get a type when they are set."""

    def __init__(self, declared: dict[str, str]) -> None:
        super().__init__()
        self._declared = declared

    def __missing__(self, name: str) -> str:
        return self._declared.get(name, "float64")


@dataclass
class FakeGoal:
    """An active goal; the test answers for the server."""

    handlers: GoalHandlers
    data: Record | None = None
    cancels: int = 0
    #: Whether the server reports that it is canceling the goal.
    canceling: bool = False
    served: Callable[[], bool] = lambda: True

    def cancel(self) -> None:
        self.cancels += 1

    def is_canceling(self) -> bool:
        return self.canceling

    def is_gone(self) -> bool:
        return not self.served()


@dataclass
class FakePort:
    """A port that records its calls. `types` maps fields to types; the default is double."""

    time: float = 100.0
    types: dict[str, str] = field(default_factory=dict)
    served: bool = True
    sent: list[tuple[str, dict[str, Any]]] = field(default_factory=list)
    calls: list[CallHandlers] = field(default_factory=list)
    goals: list[FakeGoal] = field(default_factory=list)
    told: list[tuple[str, str]] = field(default_factory=list)
    statuses: list[list[ComponentStatus]] = field(default_factory=list)
    said: list[str] = field(default_factory=list)
    others: dict[Any, list[Endpoint]] = field(default_factory=dict)
    #: Nodes and types, of each service and action.
    servers: list[tuple[str, str]] = field(default_factory=list)
    #: Other nodes that call each service and action.
    callers: list[str] = field(default_factory=list)
    hearing: int = 1
    #: Messages that have arrived and are not handled yet.
    arrived: list[Callable[[], None]] = field(default_factory=list)

    def now(self) -> float:
        return self.time

    def hear(self) -> None:
        while self.arrived:
            self.arrived.pop(0)()

    def create(self, interface: rosgraph.Interface, part: str) -> Record:
        return Record()

    def unset(self, interface: rosgraph.Interface, part: object, path: object) -> Any:
        return BLANK

    def stamp(self, message: Record, frame: str) -> None:
        pass

    def type_name(self, interface: rosgraph.Interface) -> str:
        return f"{interface.package}/{interface.type}"

    def wire_types(self, message: Record) -> dict[str, str]:
        types = FieldTypes(self.types)
        for name, value in vars(message).items():
            types[name] = self.types.get(name, "fake_msgs/Object" if isinstance(value, Record) else "float64")
        return types

    def publish(self, publisher: rosgraph.Publisher, message: Record) -> None:
        self.sent.append((publisher.topic, message.plain()))

    def is_served(self, client: object) -> bool:
        return self.served

    def call(self, client: object, request: Record, handlers: CallHandlers) -> None:
        self.calls.append(handlers)

    def send_goal(self, client: object, goal: Record, handlers: GoalHandlers) -> FakeGoal:
        self.goals.append(FakeGoal(handlers, goal, served=lambda: self.served))
        return self.goals[-1]

    def publish_report(self, name: str, text: str) -> None:
        self.told.append((name, text))

    def report_listeners(self, name: str) -> int:
        return self.hearing

    def publish_statuses(self, statuses: Sequence[ComponentStatus]) -> None:
        self.statuses.append(list(statuses))

    def status_listeners(self) -> int:
        return self.hearing

    def serving_nodes(self, client: object) -> list[tuple[str, str]]:
        return self.servers

    def calling_nodes(self, client: object) -> list[str]:
        return self.callers

    def endpoints(self) -> dict[Any, list[Endpoint]]:
        return self.others

    def info(self, text: str) -> None:
        self.said.append(text)

    warn = error = info


class World:
    """A controller on a fake port. Only `wait` advances time."""

    def __init__(self, model: Path, log: Path, configuration: Configuration | None = None, **parameters: Any) -> None:
        self.graph = supervised(model)
        self.port = FakePort()
        self.event_loop = EventLoop(lambda: self.port.time)
        self.log = log
        chosen = configuration or Configuration()
        values = {
            parameter.name: parameter.default for parameter in controller_parameters(self.graph, chosen, str(log))
        }
        sendings = {sending.name: sending for topic in self.graph.publishers for sending in topic.sendings}
        safe = SafeMessages(*([sendings[name] for name in names] for names in (chosen.on_shutdown, chosen.on_withheld)))
        self.controller = Controller(
            self.graph, Settings(values | parameters, chosen), self.port, self.event_loop, safe
        )

    def start(self) -> World:
        self.controller.start()
        return self

    def wait(self, seconds: float) -> None:
        """Advance time, stopping at each planned call."""
        until = self.port.time + seconds
        while True:
            left = self.event_loop.run_pending()
            if left is None or self.port.time + left > until:
                break
            self.port.time += left
        self.port.time = until
        self.event_loop.run_pending()

    def hear(self, topic: str, **fields: Any) -> None:
        subscription = next(known for known in self.graph.subscriptions if known.topic.removeprefix("/") == topic)
        self.controller.receive(subscription, Record(**fields))


_GRAPHS: dict[Path, rosgraph.RosGraph] = {}


class LayerBench:
    """A layer of a model; the messages named are sent instead of what it blocks."""

    def __init__(self, model: Path, *on_blocked: str, log: Path | str = "") -> None:
        self.graph = supervised(model)
        self.port = FakePort()
        configuration = Configuration()
        values = {each.name: each.default for each in layer_parameters(self.graph, configuration, str(log))}
        instead = [sending for name in on_blocked if (sending := find_message(self.graph, name)) is not None]
        settings = Settings(values, configuration)
        loop = EventLoop(lambda: self.port.time)
        self.layer = Layer(self.graph, settings, self.port, loop, SafeMessages(on_blocked=instead))
        self.layer.start()

    def hear(self, topic: str, **fields: Any) -> None:
        self.layer.receive(next(each for each in self.graph.subscriptions if each.topic == topic), Record(**fields))

    def forwarded(self, name: str, message: Record) -> dict[str, Any] | None:
        """Return the data that the layer forwards for a message of the controller, None if it blocks it."""
        sending = find_message(self.graph, name)
        assert sending is not None
        passed = self.layer.forwarded(sending, message)
        return None if passed is None else passed.plain()

    def passes(self, name: str, message: Record) -> bool:
        return self.forwarded(name, message) is not None

    def blocked(self) -> dict[str, Any]:
        """Return the last report of a blocked command."""
        report: dict[str, Any] = json.loads([text for name, text in self.port.told if name == "blocked"][-1])
        return report


def supervised(model: Path) -> rosgraph.RosGraph:
    """Return the graph of a robot whose model has its supervisor."""
    if model not in _GRAPHS:
        robot = robosc.load(model)
        robosc.synthesize(robosc.to_sct(robot))
        _GRAPHS[model] = robosc.to_rosgraph(robot)
    return _GRAPHS[model]
