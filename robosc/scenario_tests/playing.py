"""Scenarios played against the controller in Python, without ROS, in time that is set; and against the generated C."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

from robosc.analysis.explain import NamingError, event_named
from robosc.analysis.wording import called, words
from robosc.engine import Blocked
from robosc.metamodel import rosgraph, sct
from robosc.node_tests.drive import Drive, DrivenController
from robosc.node_tests.messages import Record, leaf_values
from robosc.node_tests.trace_player import Incoming as Reader
from robosc.node_tests.trace_player import Line as TraceLine
from robosc.node_tests.trace_player import TraceError, same
from robosc.node_tests.trace_test import described
from robosc.runtime.core.event_log import nested
from robosc.runtime.core.json_text import json_text
from robosc.runtime.core.port import Outcome
from robosc.scenario_tests.reading import Allowed, Holds, Incoming, Sent, Wait
from robosc.semantics.evaluation import evaluate
from robosc.semantics.messages import holds_objects
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from robosc.configuration import Configuration
    from robosc.diagnostics import Diagnostic
    from robosc.metamodel import expression as ex
    from robosc.ros_types import RosDistribution
    from robosc.runtime.core.json_text import Json
    from robosc.scenario_tests.operations import Operations
    from robosc.scenario_tests.reading import Line, Scenario


class _Controller(DrivenController):
    """A controller that can be asked what it would do."""

    @property
    def engine(self) -> Any:
        """What runs the supervised system."""
        return self._control.engine

    def note(self, operations: Operations) -> None:
        """Notes from now on what is asked of the control loop."""
        self._operations = operations
        operations.attach(self._control)

    def keep_messages(self, lines_so_far: Callable[[], int]) -> None:
        """Keep the messages that are sent from now on in `messages`, by the position of their line in the log."""
        self._lines_so_far = lines_so_far
        self.messages: dict[int, Any] = {}

    def _act(self, event: sct.Event) -> tuple[str, Mapping[str, Json] | None] | None:
        acted = super()._act(event)
        if event in self._senders:
            self.messages[self._lines_so_far()] = self._senders[event].message
        return acted

    def _before(self, name: str) -> bool:
        may_happen = super()._before(name)
        if not may_happen:
            self._operations.withheld(name)
        return may_happen


#: The kinds of events that a step may name.
_FROM_THE_ROBOT = (sct.EventKind.response, sct.EventKind.error, sct.EventKind.feedback, sct.EventKind.canceled)


def unknown_events(model: sct.SupervisoryControlModel, scenarios: Iterable[Scenario]) -> Iterator[Diagnostic]:
    """A finding for each line that names an event which the model does not have.

    Also for each that lets something come from the robot which the robot does not send.
    """
    for line in (line for scenario in scenarios for line in scenario.steps):
        if not isinstance(line, (Incoming, Allowed, Sent)):
            continue
        try:
            event = event_named(model, line.event)
        except NamingError as error:
            yield line.fault(error.message, error.hint or None)
            continue
        if isinstance(line, Incoming) and event.kind not in _FROM_THE_ROBOT:
            hint = "a step names a message, an answer or an error; time goes by with `wait`"
            yield line.fault(f"the {words(event)} does not come from the robot", hint)


class Player(Drive):
    """Plays scenarios of one robot, each from its start.

    `conditions` are what their `expect` lines ask for, as the sct model has them. Of the last scenario played `trace`
    is the event log, and `operations` what was asked of the control loop.
    """

    _controller: _Controller

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        configuration: Configuration,
        distribution: RosDistribution,
        conditions: Mapping[Holds, ex.Expression],
    ) -> None:
        super().__init__(graph, configuration, distribution)
        self._conditions = conditions
        self._sources: list[Line] = []
        self._acts: dict[sct.Event, tuple[sct.Event, Callable[[Any, bool], None]]] = {}
        for topic in graph.subscriptions:
            for reception in topic.receptions:
                self._acts[reception.event] = (reception.event, self._published(topic))
        for service in graph.serviceClients:
            self._acts[service.response.event] = (service.response.event, self._answered(service))
            self._acts[service.error.event] = (service.response.event, self._failed(service))
        for action in graph.actionClients:
            self._acts[action.feedback.event] = (action.feedback.event, self._fed_back(action))
            self._acts[action.response.event] = (action.response.event, self._ended(action, Outcome.SUCCEEDED))
            self._acts[action.error.event] = (action.response.event, self._ended(action, Outcome.ABORTED))
            self._acts[action.canceled.event] = (action.response.event, self._ended(action, Outcome.CANCELED))

    @property
    def trace(self) -> list[str]:
        """The lines of the event log."""
        return self._lines.kept

    @property
    def sources(self) -> list[Line]:
        """Of each line of the event log the line of the scenario that brought it about."""
        return self._sources

    def play(self, scenario: Scenario, operations: Operations) -> list[Diagnostic]:
        """Plays a scenario and returns a finding for each expectation that fails.

        It stops at the first step that can't be played, with a finding. `operations` records the calls of the control
        loop, by line.
        """
        self._controller = self._begin(_Controller)
        self._controller.note(operations)
        self._controller.keep_messages(lambda: len(self._lines.kept))
        self._controller.start()
        findings: list[Diagnostic] = []
        self._since = 0
        self._sources = []
        try:
            self._pass_period()
            self._attribute(scenario.line)
            for line in scenario.steps:
                operations.line = line
                fault = self._played(line)
                self._attribute(line)
                if fault is not None:
                    findings.append(fault)
                    if isinstance(line, (Incoming, Wait)):
                        break
        finally:
            self._controller.close()
        return findings

    def _attribute(self, line: Line) -> None:
        self._sources += [line] * (len(self._lines.kept) - len(self._sources))

    def _played(self, line: Line) -> Diagnostic | None:
        try:
            match line:
                case Wait(seconds=seconds):
                    self._since = len(self._lines.kept)
                    for _ in range(math.ceil(round(seconds / self._period, 6))):
                        self._pass_period()
                case Incoming():
                    self._since = len(self._lines.kept)
                    self._come_in(line)
                case Holds(text=text):
                    if not evaluate(self._conditions[line], self._controller.engine.read):
                        return line.fault(f"`{text}` does not hold", self._state())
                case Allowed():
                    return self._verdict(line, event_named(self._graph.model, line.event))
                case Sent():
                    return self._sent(line, event_named(self._graph.model, line.event))
        except NamingError as error:
            return line.fault(error.message, error.hint or None)
        except TraceError as error:
            return line.fault(str(error).partition(": ")[2] or str(error))
        return None

    # Steps

    def _come_in(self, line: Incoming) -> None:
        event = event_named(self._graph.model, line.event)
        source, act = self._acts[event]
        if not self._controller.engine.enabled(event_name(event)):
            raise NamingError(f"the {words(event)} can't come now: nothing that it ends is under way", "")
        kind = self.incoming[source]
        described_kind = Reader(described(kind))
        data = {"value": line.data} if line.data is not None and not line.is_message else None
        given = dict(line.data) if line.is_message else None
        fields = described_kind.message([TraceLine(line.span.line, 0.0, "in", event_name(source), data, given)])
        values = leaf_values(fields)
        defaults = kind.defaults(values)

        def come_in() -> dict[str, Any] | None:
            act(kind.message(values), line.data is not None)
            return nested({**values, **defaults}) if defaults else fields

        self._let_in(come_in)

    def _published(self, topic: rosgraph.Subscription) -> Callable[[Any, bool], None]:
        return lambda data, _: self._controller.receive(topic, data)

    def _answered(self, service: rosgraph.ServiceClient) -> Callable[[Any, bool], None]:
        return lambda data, _: self._robot.calls.pop(service)[1].answered(data)

    def _failed(self, service: rosgraph.ServiceClient) -> Callable[[Any, bool], None]:
        def fail(data: Any, is_given: bool) -> None:
            _, handlers = self._robot.calls.pop(service)
            if is_given:
                handlers.answered(data)
            else:
                handlers.failed("")

        return fail

    def _fed_back(self, action: rosgraph.ActionClient) -> Callable[[Any, bool], None]:
        return lambda data, _: self._robot.goals[action].handlers.feedback(data)

    def _ended(self, action: rosgraph.ActionClient, outcome: Outcome) -> Callable[[Any, bool], None]:
        return lambda data, _: self._robot.goals.pop(action).handlers.ended(outcome, data, "")

    # Expectations

    def _verdict(self, line: Allowed, event: sct.Event) -> Diagnostic | None:
        engine = self._controller.engine
        by, told = engine.blocked_by(event_name(event)), words(event)
        failing = engine.failing(event_name(event))
        if not line.forbidden:
            if by is None:
                return None
            why = f"{called(failing)} forbids it" if failing else _WHY[by]
            return line.fault(f"the {told} is not allowed: {why}", self._state())
        if by in (None, Blocked.PLANT):
            why = "it is allowed" if by is None else _WHY[Blocked.PLANT]
            return line.fault(f"the {told} is not forbidden: {why}", self._state())
        if line.by is None or any(
            line.by in (requirement.name, requirement.text) or line.by in (requirement.text or "")
            for requirement in failing
        ):
            return None
        others = called(failing) if failing else "synthesis"
        return line.fault(f"the {told} is not forbidden by `{line.by}`, but by {others}", self._state())

    def _sent(self, line: Sent, event: sct.Event) -> Diagnostic | None:
        lines = enumerate(map(json.loads, self._lines.kept[self._since :]), self._since)
        found = [(number, entry) for number, entry in lines if entry["event"] == event_name(event)]
        told = words(event)
        if not line.expected:
            return line.fault(f"the {told} was sent") if found else None
        if not found:
            return line.fault(f"the {told} was not sent since the last step", self._state())
        # The log does not show what is handed on as it came.
        sent = [_with_handed_on(entry, self._controller.messages.get(number)) for number, entry in found]
        if line.data is None or any(_agrees(line.data, data) for data in sent):
            return None
        unknown = _first_unknown(line.data, sent[-1], self._handed_on(event))
        if unknown:
            message = f"`{unknown}` of the {told} can't be compared: it is handed on as it came"
            return line.fault(message, "leave it out: times and fields of unknown definitions are not compared")
        return line.fault(f"the {told} was sent with other data", f"sent was {json_text(sent[-1])}")

    def _handed_on(self, event: sct.Event) -> list[Sequence[str]]:
        """The paths in a command at which data is handed on as it came."""
        sendings = [sending for publisher in self._graph.publishers for sending in publisher.sendings]
        sendings += [service.request for service in self._graph.serviceClients]
        sendings += [action.request for action in self._graph.actionClients]
        return [
            tuple(field.path)
            for sending in sendings
            if sending.event == event
            for data in sending.alternatives
            for field in data.fields
            if isinstance(field.value, rosgraph.WireAccess) and holds_objects(field.type)
        ]

    def _state(self) -> str:
        engine = self._controller.engine
        plants = [plant for plant in self._graph.model.plants if plant.kind == sct.PlantKind.behaviour]
        told = [f"{plant.origin}.{plant.locations[engine.location(plant)].name}" for plant in plants]
        told += [
            f"{plant.origin}.{variable.name} = {engine.value(variable)}"
            for plant in plants
            for variable in plant.variables
        ]
        return f"the robot is in {', '.join(told)}" if told else ""


_WHY = {
    Blocked.PLANT: "the robot is not ready for it",
    Blocked.REQUIREMENT: "its requirements forbid it",
    Blocked.SYNTHESIS: "synthesis forbids it",
}


def _agrees(expected: Any, found: Any) -> bool:
    """Whether data has what is expected of it; fields that are not named may be anything."""
    if isinstance(expected, dict) and isinstance(found, dict):
        return all(name in found and _agrees(value, found[name]) for name, value in expected.items())
    if isinstance(expected, list) and isinstance(found, list):
        return len(expected) == len(found) and all(map(_agrees, expected, found))
    return same(expected, found)


def _with_handed_on(entry: Mapping[str, Any], message: Any) -> Any:
    """The data of a line of the log, with the known fields of what the message hands on as it came."""
    logged = entry.get("data", {}).get("value")
    return _plain(message) if isinstance(logged, dict) else logged


def _plain(value: Any) -> Any:
    """Data of ROS as JSON has it."""
    if isinstance(value, Record):
        return {name: _plain(inner) for name, inner in vars(value).items() if name != "wire_types"}
    return [_plain(inner) for inner in value] if isinstance(value, list) else value


def _first_unknown(expected: Any, found: Any, handed_on: Sequence[Sequence[str]], path: tuple[str, ...] = ()) -> str:
    """The first field that is expected and not found in what is handed on, as `pose.position`; empty: there is none."""
    if isinstance(expected, dict) and isinstance(found, dict):
        for name, value in expected.items():
            inside = (*path, name)
            if name in found:
                unknown = _first_unknown(value, found[name], handed_on, inside)
            else:
                unknown = ".".join(inside) if any(inside[: len(way)] == way for way in handed_on) else ""
            if unknown:
                return unknown
    return ""
