"""Scenarios played against the controller in Python, without ROS, in simulated time, and against the generated C."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.analysis.explain import NamingError, find_event
from robosc.analysis.wording import join_with_and, name, quote_requirements, words
from robosc.engine import Blocked, Engine
from robosc.model import rosgraph, sct
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.failures import brings_data, possible_reasons
from robosc.model.semantics.messages import holds_objects
from robosc.model.semantics.naming import output_name
from robosc.model.semantics.roles import event_name, plant_of
from robosc.run.node_tests.drive import Drive, DrivenController
from robosc.run.node_tests.messages import Record, leaf_values
from robosc.run.node_tests.trace_player import Incoming as Reader
from robosc.run.node_tests.trace_player import Line as TraceLine
from robosc.run.node_tests.trace_player import TraceError, merged, same, with_nan
from robosc.run.node_tests.trace_test import describe_incoming
from robosc.run.runtime.core.event_log import nest
from robosc.run.runtime.core.json_text import json_text
from robosc.run.runtime.core.port import CancelAnswer, Failure, GoalOutcome
from robosc.run.scenario_tests.reading import Holds, IncomingEvent, Permission, Refusal, SentCommand, Wait
from robosc.run.simulation.data import DataError, EventData

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.base.ros_types import RosDistribution, RosTypes
    from robosc.language.configuration import Configuration
    from robosc.model import expression as ex
    from robosc.run.node_tests.robot import RunningGoal
    from robosc.run.node_tests.samples import LoggedValue
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.port import Client
    from robosc.run.scenario_tests.operations import Operations
    from robosc.run.scenario_tests.reading import Line, Scenario


class _Controller(DrivenController):
    """Controller with access to its engine, calls and messages."""

    @property
    def engine(self) -> Any:
        """The engine of the supervised system."""
        return self._control.engine

    def note(self, operations: Operations) -> None:
        """Record the calls of the control loop from now on."""
        self._operations = operations
        operations.attach(self._control)

    def keep_messages(self, lines_so_far: Callable[[], int]) -> None:
        """Keep the messages sent from now on in `messages`, by the position of their line in the log."""
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


#: Maximum number of periods of one wait, which take about a minute.
_MOST_PERIODS = 1_000_000
#: Kinds of events that a step may name.
_FROM_THE_ROBOT = (sct.EventKind.response, sct.EventKind.error, sct.EventKind.feedback, sct.EventKind.canceled)


def unknown_events(model: sct.SupervisoryControlModel, scenarios: Iterable[Scenario]) -> Iterator[Diagnostic]:
    """Yield a finding for each line that names an event which the model does not have.

    Also for each line with an event that the robot does not send.
    """
    for line in (line for scenario in scenarios for line in scenario.steps):
        if not isinstance(line, (IncomingEvent, Refusal, Permission, SentCommand)):
            continue
        try:
            event = find_event(model, line.event)
        except NamingError as error:
            yield line.fault(error.message, error.hint or None)
            continue
        if isinstance(line, IncomingEvent):
            yield from _impossible(line, event)
        elif isinstance(line, SentCommand) and not event.controllable:
            yield line.fault(f"the {words(event)} comes from the robot, not from the controller")


def unfit_data(graph: rosgraph.RosGraph, types: RosTypes, scenarios: Iterable[Scenario]) -> Iterator[Diagnostic]:
    """Yield a finding for each line whose data does not fit its event. Precondition: each event and reason is known."""
    checked = EventData(Engine(graph.model), graph, types)
    for line in (line for scenario in scenarios for line in scenario.steps):
        if isinstance(line, IncomingEvent) and line.data is not None:
            data = {"value": line.data} if line.reason is None else {"value": line.data, "reason": line.reason}
            try:
                checked.check(event_name(find_event(graph.model, line.event)), data, is_message=line.is_message)
            except DataError as error:
                yield line.fault(str(error), error.hint)


def _impossible(line: IncomingEvent, event: sct.Event) -> Iterator[Diagnostic]:
    """Yield findings if the robot does not send an event, or not with the line's reason or data."""
    possible = possible_reasons(event)
    if event.kind not in _FROM_THE_ROBOT:
        hint = "a step is a message, an answer or an error; time passes with `wait`"
        yield line.fault(f"the {words(event)} does not come from the robot", hint)
    elif line.reason is not None and not possible:
        yield line.fault("only the error of a service or an action has a reason", f"leave out `because {line.reason}`")
    elif line.reason is not None and line.reason not in possible:
        hint = f"expected {join_with_and([f'`{reason}`' for reason in sorted(possible)])}"
        yield line.fault(f"the {words(event)} cannot have the reason `{line.reason}`", hint)
    elif possible and line.data is not None and not brings_data(event, line.reason):
        yield line.fault(f"an error with the reason `{line.reason}` has no data", "leave out `with …`")


class Player(Drive):
    """Player of scenarios of one robot, each from its start.

    `conditions` are the conditions of `expect` lines as expressions of the sct model. `trace` is the event log of the
    last scenario played.
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
        #: Handlers of incoming events that are no errors, called with their data.
        self._acts: dict[sct.Event, Callable[[Any], None]] = {}
        self._clients: dict[sct.Event, rosgraph.ServiceClient | rosgraph.ActionClient] = {}
        for topic in graph.subscriptions:
            for reception in topic.receptions:
                self._acts[reception.event] = partial(self._publish, topic)
        for service in graph.serviceClients:
            self._clients[service.error.event] = service
            self._acts[service.response.event] = partial(self._answer, service)
        for action in graph.actionClients:
            self._clients |= dict.fromkeys([action.error.event, action.canceled.event], action)
            self._acts[action.feedback.event] = partial(self._feed_back, action)
            self._acts[action.response.event] = partial(self._end, action, GoalOutcome.SUCCEEDED)
            self._acts[action.canceled.event] = partial(self._end, action, GoalOutcome.CANCELED)

    @property
    def trace(self) -> list[str]:
        """The lines of the event log."""
        return self._lines.lines

    @property
    def sources(self) -> list[Line]:
        """The line of the scenario that caused each line of the event log."""
        return self._sources

    def play(self, scenario: Scenario, operations: Operations) -> list[Diagnostic]:
        """Play a scenario and return a finding for each expectation that fails.

        It stops with a finding at the first step that can't be played. `operations` records the calls of the control
        loop, by line.
        """
        self._controller = self._begin(_Controller)
        self._controller.note(operations)
        self._controller.keep_messages(lambda: len(self._lines.lines))
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
                    if isinstance(line, (IncomingEvent, Refusal, Wait)):
                        findings.append(fault)
                        break
                    findings.append(self._with_canceling(fault))
        finally:
            self._controller.close()
        return findings

    def _attribute(self, line: Line) -> None:
        self._sources += [line] * (len(self._lines.lines) - len(self._sources))

    def _played(self, line: Line) -> Diagnostic | None:
        try:
            match line:
                case Wait() | IncomingEvent() | Refusal():
                    self._since = len(self._lines.lines)
                    self._step(line)
                case Holds(text=text):
                    if not evaluate(self._conditions[line], self._controller.engine.read):
                        return line.fault(f"`{text}` does not hold", self._state())
                case Permission():
                    return self._verdict(line, find_event(self._graph.model, line.event))
                case SentCommand():
                    return self._sent(line, find_event(self._graph.model, line.event))
        except NamingError as error:
            return line.fault(error.message, error.hint or None)
        except TraceError as error:
            return line.fault(str(error).partition(": ")[2] or str(error))
        return None

    # Steps

    def _step(self, line: Wait | IncomingEvent | Refusal) -> None:
        if isinstance(line, IncomingEvent):
            self._come_in(line)
        elif isinstance(line, Refusal):
            self._refuse(find_event(self._graph.model, line.event))
        else:
            periods = math.ceil(round(line.seconds / self._period, 6))
            if periods > _MOST_PERIODS:
                hint = "wait for less, or play with a longer `controlLoop.periodMs`"
                raise NamingError(f"the wait has {periods:,} ticks of the control loop, at most a million", hint)
            for _ in range(periods):
                self._pass_period()

    def _come_in(self, line: IncomingEvent) -> None:
        event = find_event(self._graph.model, line.event)
        if not self._controller.engine.enabled(event_name(event)):
            if event.kind == sct.EventKind.canceled and self._clients[event] in self._robot.goals:
                hint = f"write `error from {self._called(event)} because canceled`"
                raise NamingError("the controller has not canceled this goal", hint)
            raise NamingError(f"the {words(event)} cannot come now: it ends no running call or goal", "")
        if event.kind == sct.EventKind.error:
            self._fail(event, line)
        elif line.data is None and event.kind == sct.EventKind.canceled:
            self._let_in(lambda: self._acts[event](None))
        else:
            self._bring(event, line, self._acts[event])

    def _bring(self, source: sct.Event, line: IncomingEvent, act: Callable[[Any], None]) -> None:
        """Handle incoming data that has the shape of the event `source`."""
        data, fields = self._message(source, line)

        def come_in() -> dict[str, Any]:
            act(data)
            return fields

        self._let_in(come_in)

    def _message(self, source: sct.Event, line: IncomingEvent, *others: sct.Event) -> tuple[Any, dict[str, Any]]:
        """Return a message with the data of a line, and its fields that are set or differ from zero.

        `others` are further events that read it.
        """
        fields: dict[str, Any] = {}
        for event in (*others, source):
            kind = self.incoming[event]
            reads = [logged.path for _, shown in kind.events for logged in shown]
            data = None
            is_message = line.is_message or _is_raw([logged for _, shown in kind.events for logged in shown], line.data)
            if line.data is not None and not is_message and reads:
                data = {"value": _by_index(line.data, reads)}
            whole = with_nan(dict(line.data)) if is_message else None
            played = TraceLine(line.span.line, 0.0, "in", event_name(event), data, whole)
            fields = merged(fields, Reader(describe_incoming(kind)).message([played]))
        values = leaf_values(fields)
        defaults = kind.defaults(values)
        return kind.message(values), nest({**values, **defaults}) if defaults else fields

    def _publish(self, topic: rosgraph.Subscription, data: Any) -> None:
        self._controller.receive(topic, data)

    def _answer(self, service: rosgraph.ServiceClient, data: Any) -> None:
        self._robot.calls.pop(service)[1].answered(data)

    def _feed_back(self, action: rosgraph.ActionClient, data: Any) -> None:
        self._note_accepted(action)
        self._robot.goals[action].handlers.feedback(data)

    def _note_accepted(self, action: rosgraph.ActionClient) -> None:
        """Record that the robot has accepted the present goal."""
        goal = self._robot.goals[action]
        goal.accepted = self._now if goal.accepted is None else goal.accepted

    def _end(self, action: rosgraph.ActionClient, outcome: GoalOutcome, data: Any) -> None:
        self._robot.goals.pop(action).handlers.ended(outcome, data, "")

    # Failures

    def _fail(self, event: sct.Event, line: IncomingEvent) -> None:
        client = self._clients[event]
        reason = Failure(line.reason or possible_reasons(event)[0])
        is_answer = line.reason is None and line.data is not None and isinstance(client, rosgraph.ServiceClient)
        if is_answer or reason is Failure.UNREADABLE:
            self._answer_unreadably(client, line)
        elif isinstance(client, rosgraph.ServiceClient):
            self._fail_call(client, reason)
        else:
            self._fail_goal(client, reason, line)

    def _answer_unreadably(self, client: Client, line: IncomingEvent) -> None:
        """Answer with data that the node can't read: that of a line, or a message without elements of arrays."""
        event, others = client.response.event, [client.error.event] if isinstance(client, rosgraph.ActionClient) else []
        blank = self.incoming[event].message({})
        data, fields = (blank, {}) if line.data is None else self._message(event, line, *others)
        is_read = self._controller.reads([client.response], data)
        if is_read and line.data is not None:
            raise NamingError(f"the node can read this data: write it at the {words(event)}", "")

        def come_in() -> dict[str, Any] | None:
            if is_read and line.data is None:  # it may be unreadable for another cause
                self._forget(client)
                self._give_up(client, Failure.UNREADABLE)
                return None
            self._acts[event](data)
            return fields

        self._let_in(come_in)

    def _fail_call(self, client: rosgraph.ServiceClient, reason: Failure) -> None:
        """Let a call fail; without a server or an answer it fails when its time is over."""
        since, handlers = self._robot.calls.pop(client)
        if reason is Failure.FAILED:
            self._let_in(lambda: handlers.failed(""))
            return
        caller = self._controller.caller(client)
        self._pass_until(since + self.parameters["service_timeout_ms"] / 1000, client.error.event)
        if reason is Failure.UNAVAILABLE:
            self._let_in(lambda: self._give_up(client, reason))
        while not self._has_happened(client.error.event) and caller.waiting:
            self._pass_period()

    def _pass_until(self, over: float, end: sct.Event) -> None:
        """Let time pass up to the last period before a time in seconds, or until an event has happened."""
        while not self._has_happened(end) and self._now + self._period < over:
            self._pass_period()

    def _fail_goal(self, client: rosgraph.ActionClient, reason: Failure, line: IncomingEvent) -> None:
        if reason is Failure.CANCELED and self._controller.engine.enabled(event_name(client.canceled.event)):
            hint = f"write `canceled from {self._called(client.canceled.event)}`"
            raise NamingError("the controller cancels this goal itself", hint)
        goal = self._robot.goals[client]
        self._check_not_accepted(goal, reason)
        if reason in {Failure.UNAVAILABLE, Failure.TIMEOUT}:
            self._pass_until(self._in_time(goal), client.error.event)
        if reason is Failure.UNAVAILABLE and goal.is_asked:
            hint = f"write `canceled from {self._called(client.canceled.event)}`"
            raise NamingError("a goal that is canceled without a server ends as canceled", hint)

        def end(result: Any) -> None:
            self._forget(client)
            match reason:
                case Failure.ABORTED | Failure.CANCELED | Failure.LOST:
                    goal.handlers.ended(GoalOutcome(reason), result, "")
                case Failure.REJECTED:
                    goal.handlers.rejected()
                case _:
                    self._give_up(client, reason, result)

        if line.data is None:
            self._let_in(lambda: end(None))
        else:
            self._bring(client.error.event, line, end)

    def _check_not_accepted(self, goal: RunningGoal, reason: Failure) -> None:
        """Raise NamingError if the reason excludes that the robot has accepted the goal, or the present time."""
        is_early = reason in {Failure.REJECTED, Failure.UNAVAILABLE}
        is_late = reason is Failure.TIMEOUT
        if goal.accepted is not None and (is_early or (is_late and goal.accepted < self._in_time(goal))):
            hint = "an accepted goal fails with `aborted`, `canceled`, `lost` or `unreadable`"
            raise NamingError(f"the goal has been accepted: it cannot fail with `{reason}`", hint)
        if is_early and self._now > self._in_time(goal):
            hint = "after `actions.timeoutMs` a goal that was not accepted fails with `timeout`"
            raise NamingError(f"the goal was sent too long ago to fail with `{reason}`", hint)

    def _in_time(self, goal: RunningGoal) -> float:
        """Return the time in seconds up to which a goal has to be accepted."""
        return goal.sent + self.parameters["action_timeout_ms"] / 1000

    def _give_up(self, client: Client, reason: Failure, result: Any = None) -> None:
        """Report a failure from the node's client of a service or action."""
        why = f"failed because {reason}"
        if isinstance(client, rosgraph.ServiceClient):
            self._controller.caller(client).fail(reason, why)
        else:
            self._controller.starter(client).fail(reason, why, result)

    def _forget(self, client: Client) -> None:
        """Remove the call or goal from the robot: nothing more comes of it."""
        if isinstance(client, rosgraph.ServiceClient):
            del self._robot.calls[client]
        else:
            del self._robot.goals[client]

    def _has_happened(self, event: sct.Event) -> bool:
        return any(json.loads(line)["event"] == event_name(event) for line in self._lines.lines[self._since :])

    def _refuse(self, event: sct.Event) -> None:
        """Refuse to cancel the goal that would end with an event."""
        client = self._clients[event]
        assert isinstance(client, rosgraph.ActionClient)
        goal = self._robot.goals.get(client)
        called = self._called(event)
        if goal is None or not self._controller.engine.enabled(event_name(event)):
            raise NamingError(f"`{called}` is not being canceled", "")
        if not goal.is_asked:
            again = "the node asks again after a pause: write `wait` before this line"
            raise NamingError(f"no request to cancel `{called}` waits for an answer", again)
        goal.is_asked = False
        self._note_accepted(client)
        self._let_in(lambda: goal.handlers.cancel_answered(CancelAnswer.REFUSED))

    def _called(self, event: sct.Event) -> str:
        """Return the shortest name of the action of an event in scenarios."""
        whole = name(plant_of(event))
        short = whole.rpartition(".")[2]
        same_end = [plant for plant in self._graph.model.plants if name(plant).rpartition(".")[2] == short]
        return short if len(same_end) == 1 else whole

    def _with_canceling(self, fault: Diagnostic) -> Diagnostic:
        """Return a finding with a hint at the goals that are being canceled and have not ended."""
        engine = self._controller.engine
        ends = [action.canceled.event for action in self._graph.actionClients]
        names = [self._called(event) for event in ends if engine.enabled(event_name(event))]
        hints = [f"`{name}` is being canceled and has not ended: write `canceled from {name}`" for name in names]
        return replace(fault, hint="; ".join(filter(None, [fault.hint, *hints])) or None)

    # Expectations

    def _verdict(self, line: Permission, event: sct.Event) -> Diagnostic | None:
        engine = self._controller.engine
        by, phrase = engine.blocked_by(event_name(event)), words(event)
        failing = engine.failing_requirements(event_name(event))
        if not line.forbidden:
            if by is None:
                return None
            why = f"{quote_requirements(failing)} forbids it" if failing else _WHY[by]
            return line.fault(f"the {phrase} is not allowed: {why}", self._state())
        if by in (None, Blocked.PLANT):
            why = "it is allowed" if by is None else _WHY[Blocked.PLANT]
            return line.fault(f"the {phrase} is not forbidden: {why}", self._state())
        named = "" if line.by is None else output_name(line.by)
        if line.by is None or any(
            requirement.name in (named, line.by) or line.by in (requirement.text or "") for requirement in failing
        ):
            return None
        others = quote_requirements(failing) if failing else "synthesis"
        return line.fault(f"the {phrase} is not forbidden by `{line.by}`, but by {others}", self._state())

    def _sent(self, line: SentCommand, event: sct.Event) -> Diagnostic | None:
        lines = enumerate(map(json.loads, self._lines.lines[self._since :]), self._since)
        sent_lines = [(number, entry) for number, entry in lines if entry["event"] == event_name(event)]
        phrase = words(event)
        if not line.expected:
            return line.fault(f"the {phrase} was sent") if sent_lines else None
        if not sent_lines:
            return line.fault(f"the {phrase} was not sent since the last step", self._state())
        # The log does not show objects that are forwarded unchanged.
        sent = [_with_handed_on(entry, self._controller.messages.get(number)) for number, entry in sent_lines]
        if line.data is None or any(_agrees(line.data, data) for data in sent):
            return None
        unknown = _first_unknown(line.data, sent[-1], self._handed_on(event))
        if unknown:
            message = f"`{unknown}` of the {phrase} cannot be compared: the node forwards it unchanged"
            return line.fault(message, "leave it out: times and fields of unknown definitions are not compared")
        return line.fault(f"the {phrase} was sent with other data", f"the sent data is {json_text(sent[-1])}")

    def _handed_on(self, event: sct.Event) -> list[Sequence[str]]:
        """Return the paths in a command at which data is forwarded unchanged."""
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
        parts = [f"{plant.origin}.{plant.locations[engine.location(plant)].name}" for plant in plants]
        parts += [
            f"{plant.origin}.{variable.name} = {engine.value(variable)}"
            for plant in plants
            for variable in plant.variables
        ]
        return f"the robot is in {', '.join(parts)}" if parts else ""


_WHY = {
    Blocked.PLANT: "the robot is not ready for it",
    Blocked.REQUIREMENT: "its requirements forbid it",
    Blocked.SYNTHESIS: "synthesis forbids it",
}


def _is_raw(reads: Sequence[LoggedValue], data: Any) -> bool:
    """Return whether data has the fields of the ROS message, not what the event log has in their place.

    The event log has literals for enums, and lists for arrays that the model reads as a whole. Raises NamingError for
    data with both, and for a lone value in the place of a literal.
    """
    values = [(message_read, _value_at(data, message_read.path)) for message_read in reads]
    raw = [
        value
        for message_read, value in values
        if value is not None
        and (
            not isinstance(value, str)
            if message_read.conversion is not None
            else isinstance(value, dict) and bool(value) and all(name.isdigit() for name in value)
        )
    ]
    has_literals = any(message_read.conversion is not None and isinstance(value, str) for message_read, value in values)
    if raw and (has_literals or not isinstance(data, dict)):
        raise NamingError(
            f"{json.dumps(raw[0])} is ROS data instead of a literal", "write `with message {…}` with all fields"
        )
    return bool(raw)


def _value_at(data: Any, path: Sequence[str]) -> Any:
    """Return the value at a path of fields and indices; None if there is none. A lone value has every path."""
    for step in path:
        if isinstance(data, list):
            data = data[int(step)] if step.isdigit() and int(step) < len(data) else None
        elif isinstance(data, dict):
            data = data.get(step)
    return data


def _by_index(value: Any, reads: Sequence[Sequence[str]]) -> Any:
    """Return data in which objects from index to element replace lists whose elements are read one by one."""
    if isinstance(value, list) and any(path and path[0].isdigit() for path in reads):
        value = {str(index): element for index, element in enumerate(value)}
    if not isinstance(value, dict):
        return value
    below = {name: [path[1:] for path in reads if path and path[0] == name] for name in value}
    return {name: _by_index(inner, below[name]) for name, inner in value.items()}


def _agrees(expected: Any, actual: Any) -> bool:
    """Return whether data has the expected values; fields that are not named may have any value."""
    if isinstance(expected, dict) and isinstance(actual, dict):
        return all(name in actual and _agrees(value, actual[name]) for name, value in expected.items())
    if isinstance(expected, list) and isinstance(actual, list):
        return len(expected) == len(actual) and all(map(_agrees, expected, actual))
    return same(expected, actual)


def _with_handed_on(entry: Mapping[str, Any], message: Any) -> Any:
    """Return the data of a line of the log, with the known fields of forwarded objects in the message."""
    logged = entry.get("data", {}).get("value")
    return _plain(message) if isinstance(logged, dict) else logged


def _plain(value: Any) -> Any:
    """Return data of ROS as JSON."""
    if isinstance(value, Record):
        return {name: _plain(inner) for name, inner in vars(value).items() if name != "wire_types"}
    return [_plain(inner) for inner in value] if isinstance(value, list) else value


def _first_unknown(expected: Any, actual: Any, handed_on: Sequence[Sequence[str]], path: tuple[str, ...] = ()) -> str:
    """Return the first expected field that is missing in forwarded data, as `pose.position`; empty if there is none."""
    if isinstance(expected, dict) and isinstance(actual, dict):
        for name, value in expected.items():
            inside = (*path, name)
            if name in actual:
                unknown = _first_unknown(value, actual[name], handed_on, inside)
            else:
                unknown = ".".join(inside) if any(inside[: len(way)] == way for way in handed_on) else ""
            if unknown:
                return unknown
    return ""
