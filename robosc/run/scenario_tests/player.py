"""Scenarios played against the controller in Python, without ROS, in simulated time, and against the generated C."""

from __future__ import annotations

import json
import math
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.analysis.explain import NamingError, find_event
from robosc.analysis.wording import name, quote_requirements, words
from robosc.base.ros_types.wire import NestedType
from robosc.engine import Blocked
from robosc.model import rosgraph, sct
from robosc.model.semantics.evaluation import evaluate
from robosc.model.semantics.failures import possible_reasons
from robosc.model.semantics.messages import fields_set, holds_objects, sent_messages
from robosc.model.semantics.naming import output_name
from robosc.model.semantics.roles import event_name, plant_of
from robosc.run.node_tests.drive import LATENESS, Drive
from robosc.run.node_tests.messages import leaf_values
from robosc.run.node_tests.trace_player import Incoming as Reader
from robosc.run.node_tests.trace_player import Line as TraceLine
from robosc.run.node_tests.trace_player import TraceError, merged, with_nan
from robosc.run.node_tests.trace_test import describe_incoming
from robosc.run.runtime.core.event_log import nest
from robosc.run.runtime.core.json_text import json_text
from robosc.run.runtime.core.port import CancelAnswer, Failure, GoalOutcome
from robosc.run.scenario_tests.controller import ScenarioController
from robosc.run.scenario_tests.event_data import (
    agrees,
    by_index,
    first_unknown,
    is_raw,
    plain,
    sent_data,
    with_defaults,
    with_expected_defaults,
)
from robosc.run.scenario_tests.reading import (
    Acceptance,
    Every,
    Expectation,
    Holds,
    IncomingEvent,
    Line,
    Permission,
    Refusal,
    Repeat,
    SentCommand,
    Stop,
    Violation,
    Wait,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.base.ros_types import RosDistribution
    from robosc.language.configuration import Configuration
    from robosc.model import expression as ex
    from robosc.run.node_tests.robot import RunningGoal
    from robosc.run.runtime.core.port import Client, Server
    from robosc.run.scenario_tests.operations import Operations
    from robosc.run.scenario_tests.reading import Scenario


class _StepError(Exception):
    """Error of a step that cannot be played, with its finding."""

    def __init__(self, finding: Diagnostic) -> None:
        super().__init__(finding.message)
        self.finding = finding


class _Round(NamedTuple):
    """Round of a block."""

    number: int
    of: int


@dataclass
class _Repetition:
    """Step of `every` that is being repeated: periods that have passed since its start, and repetitions in them."""

    line: Every
    periods: int = 0
    count: int = 0


#: Maximum number of periods of one wait, which take about a minute.
_MOST_PERIODS = 1_000_000


class Player(Drive):
    """Player of scenarios of one robot, each from its start.

    `conditions` are the conditions of `expect` lines as expressions of the sct model. `trace` is the event log of the
    last scenario played.
    """

    _controller: ScenarioController

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
        self._served: dict[sct.Event, Server] = {}
        servers: list[Server] = [*graph.serviceServers, *graph.actionServers]
        for server in servers:
            self._served[server.request.event] = server
            self._acts[server.request.event] = partial(self._request, server)

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
        self._controller = self._begin(ScenarioController)
        self._operations = operations
        self._controller.note(operations)
        self._controller.keep_messages(lambda: len(self._lines.lines))
        self._controller.start()
        #: The first finding of each line of the scenario.
        self._findings: dict[Line, Diagnostic] = {}
        self._scenario = scenario
        self._since = self._violations_before = self._goals_before = 0
        #: The goals for the controller so far, by the event of each, and whether the controller accepted it.
        self._goals: list[tuple[sct.Event, bool]] = []
        self._sources = []
        self._rounds: list[_Round] = []
        self._repetitions: dict[sct.Event, _Repetition] = {}
        try:
            with self._causing(scenario.line):
                self._pass_period()
            self._play(scenario.steps)
        except _StepError as error:
            self._add(error.finding)
        finally:
            self._controller.close()
        return list(self._findings.values())

    @contextmanager
    def _causing(self, line: Line) -> Iterator[None]:
        """Attribute all that happens in a `with` block to a line, and its errors. Raises _StepError."""
        before = self._operations.line
        self._attribute()
        self._operations.line = line
        try:
            yield
        except NamingError as error:
            raise _StepError(line.fault(error.message, error.hint or None)) from error
        except TraceError as error:
            raise _StepError(line.fault(str(error).partition(": ")[2] or str(error))) from error
        finally:
            self._attribute()
            self._operations.line = before

    def _attribute(self) -> None:
        self._sources += [self._operations.line] * (len(self._lines.lines) - len(self._sources))

    def _add(self, finding: Diagnostic) -> None:
        """Add the finding of a line, with its round and scenario if the place does not show them."""
        rounds = [f"in round {one.number} of {one.of}" for one in self._rounds]
        is_shared = finding.span.line < self._scenario.line.span.line
        scenario = [f'in the scenario "{self._scenario.name}"'] if is_shared else []
        hint = "; ".join([*filter(None, [finding.hint]), *rounds, *scenario])
        self._findings.setdefault(Line(finding.file, finding.span), replace(finding, hint=hint or None))

    def _play(self, steps: Sequence[Line]) -> None:
        """Play lines; stop with _StepError at the first step that cannot be played."""
        for line in steps:
            if isinstance(line, Repeat):
                self._play_rounds(line)
                continue
            with self._causing(line):
                if isinstance(line, Expectation):
                    fault = self._expectation(line)
                    if fault is not None:
                        fault = self._with_canceling(fault)
                        self._add(fault if isinstance(line, Acceptance) else self._with_rejected(fault))
                else:
                    self._since = len(self._lines.lines)
                    self._violations_before = len(self._controller.violations)
                    self._goals_before = len(self._goals)
                    self._step(line)

    def _play_rounds(self, block: Repeat) -> None:
        since, violations_before = len(self._lines.lines), len(self._controller.violations)
        goals_before = len(self._goals)
        for number in range(1, block.rounds + 1):
            self._rounds.append(_Round(number, block.rounds))
            self._play(block.steps)
            self._rounds.pop()
        # For the expectations that follow, the block is one step.
        self._since, self._violations_before, self._goals_before = since, violations_before, goals_before

    # Steps

    def _step(self, line: Line) -> None:
        match line:
            case IncomingEvent():
                self._come_in(line)
            case Refusal():
                self._refuse(find_event(self._graph.model, line.event))
            case Wait():
                for _ in self._passing(line.seconds, math.prod(one.of for one in self._rounds)):
                    pass
            case Every():
                self._come_in(line.step)
                self._repetitions[find_event(self._graph.model, line.step.event)] = _Repetition(line)
            case Stop():
                self._repetitions.pop(find_event(self._graph.model, line.event), None)
            case _:
                raise TypeError(f"{type(line).__name__} is no step")

    def _passing(self, seconds: float, rounds: int = 1) -> Iterator[None]:
        """Let time pass in whole periods, and yield after each. The time passes in so many `rounds`.

        A timer that is up when the time is over expires: it is late by the resolution of the clock, once for each timer
        before it.
        """
        periods = math.ceil(round(seconds / self._period, 6))
        if periods * rounds > _MOST_PERIODS:
            hint = "write a shorter time, or play with a longer `controlLoop.periodMs`"
            ticks = f"{periods * rounds:,} ticks of the control loop{' in all rounds' if rounds > 1 else ''}"
            raise NamingError(f"this time has {ticks}, at most a million", hint)
        over, expiries = self._now + seconds, self._expiries - 1
        for _ in range(periods):
            self._pass_period()
            yield
        while self._pass_expiry(over + min((self._expiries - expiries) * LATENESS, self._period)):
            yield

    def _pass_period(self) -> None:
        super()._pass_period()
        for repetition in list(self._repetitions.values()):
            repetition.periods += 1
            due = math.floor(round(repetition.periods * self._period / repetition.line.seconds, 6))
            for _ in range(due - repetition.count):
                repetition.count += 1
                with self._causing(repetition.line):
                    self._come_in(repetition.line.step)

    def _come_in(self, line: IncomingEvent) -> None:
        event = find_event(self._graph.model, line.event)
        engine = self._controller.engine
        if event in self._served:
            self._bring(event, line, self._acts[event])
            return
        if event.kind == sct.EventKind.cancelRequest:
            self._let_in(lambda: self._ask_to_cancel(event))
            return
        if not engine.enabled(event_name(event)) and not engine.violated_assumptions(event_name(event)):
            if event.kind == sct.EventKind.canceled and self._clients[event] in self._robot.goals:
                hint = f"write `error from {self._called(event)} because canceled`"
                raise NamingError("the controller has not canceled this goal", hint)
            if event.kind == sct.EventKind.feedback:
                hint = f"write `stop feedback from {self._called(event)}` before the goal ends"
                hint = hint if event in self._repetitions else ""
                raise NamingError(f"the {words(event)} cannot come now: no goal runs", hint)
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
            is_message = line.is_message or is_raw([logged for _, shown in kind.events for logged in shown], line.data)
            if line.data is not None and not is_message and reads:
                data = {"value": by_index(line.data, reads)}
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

    def _request(self, server: Server, data: Any) -> None:
        """Let a client send a request or a goal. A goal may be rejected, and a request may wait."""
        if isinstance(server, rosgraph.ServiceServer):
            self._controller.request(server, data)
        else:
            self._goals.append((server.request.event, self._controller.request_goal(server, data)))

    def _ask_to_cancel(self, event: sct.Event) -> None:
        """Let a client ask to cancel the goal of an action that the controller serves."""
        [server] = [action for action in self._graph.actionServers if plant_of(action.request.event) is plant_of(event)]
        if not self._controller.request_cancel(server):
            message = f"`{self._called(event)}` has no goal to cancel"
            raise NamingError(message, "a client can cancel an accepted goal once")

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

    def _with_rejected(self, fault: Diagnostic) -> Diagnostic:
        """Return a finding with a hint at the goals of the last step that the controller rejected."""
        rejected = [event for event, is_accepted in self._goals[self._goals_before :] if not is_accepted]
        hints = [f"the controller rejected the goal of `{self._called(event)}`" for event in dict.fromkeys(rejected)]
        return replace(fault, hint="; ".join(filter(None, [fault.hint, *hints])) or None)

    # Expectations

    def _expectation(self, line: Expectation) -> Diagnostic | None:
        """Return a finding if an expectation is not met, now or in its time."""
        fault = self._unmet(line)
        if fault is None or line.within is None:
            return fault
        for _ in self._passing(line.within):
            fault = self._unmet(line)
            if fault is None:
                return None
        return replace(fault, message=f"after {line.within:g} s, {fault.message}")

    def _unmet(self, line: Expectation) -> Diagnostic | None:
        match line:
            case Holds(text=text):
                holds = evaluate(self._conditions[line], self._controller.engine.read)
                return None if holds else line.fault(f"`{text}` does not hold", self._state())
            case Permission():
                return self._verdict(line, find_event(self._graph.model, line.event))
            case Violation(assumption=assumption):
                violated = assumption in self._controller.violations[self._violations_before :]
                return None if violated else line.fault(f"the last step does not violate `{assumption}`", self._state())
            case Acceptance():
                return self._accepted(line, find_event(self._graph.model, line.event))
            case SentCommand():
                return self._sent(line, find_event(self._graph.model, line.event))
        raise TypeError(f"{type(line).__name__} is no expectation")

    def _accepted(self, line: Acceptance, event: sct.Event) -> Diagnostic | None:
        since = self._goals[self._goals_before :]
        answers = [is_accepted for goal, is_accepted in since if plant_of(goal) is plant_of(event)]
        if line.expected in answers:
            return None
        called = f"goal of `{self._called(event)}`"
        if not answers:
            return line.fault(f"the last step sends no {called}", f"write `request from {self._called(event)}` before")
        return line.fault(f"the controller {'rejected' if line.expected else 'accepted'} the {called}", self._state())

    def _verdict(self, line: Permission, event: sct.Event) -> Diagnostic | None:
        engine = self._controller.engine
        by, phrase = engine.blocked_by(event_name(event)), words(event)
        failing = engine.failing_requirements(event_name(event))
        if not line.forbidden:
            if by is None:
                return None
            why = f"{quote_requirements(failing)} forbids it" if failing else _WHY[by]
            return line.fault(f"the {phrase} is not allowed: {why}", self._state())
        if by in (None, Blocked.PLANT, Blocked.ASSUMPTION):
            why = "it is allowed" if by is None else _WHY[by]
            return line.fault(f"the {phrase} is not forbidden: {why}", self._state())
        named = "" if line.by is None else output_name(line.by)
        if line.by is None or any(
            requirement.name in (named, line.by) or line.by in (requirement.text or "") for requirement in failing
        ):
            return None
        others = quote_requirements(failing) if failing else "synthesis"
        return line.fault(f"the {phrase} is not forbidden by `{line.by}`, but by {others}", self._state())

    def _sent(self, line: SentCommand, event: sct.Event) -> Diagnostic | None:
        name, phrase = event_name(event), words(event)
        lines = enumerate(self._lines.lines[self._since :], self._since)
        entries = [(number, json.loads(text)) for number, text in lines if f'"{name}"' in text]
        entries = [(number, entry) for number, entry in entries if entry["event"] == name]
        if not line.expected:
            return line.fault(f"the {phrase} was sent") if entries else None
        if not entries:
            return line.fault(f"the {phrase} was not sent since the last step", self._state())
        if line.data is None:
            return _counted(line, phrase, len(entries))
        # The log does not show objects that are forwarded unchanged.
        messages = self._controller.messages
        sent = [sent_data(entry, messages.get(number)) for number, entry in entries]
        count = sum(
            agrees(line.data, data) or agrees(line.data, self._whole(event, messages.get(number)))
            for data, (number, _) in zip(sent, entries, strict=True)
        )
        if count:
            return _counted(line, f"{phrase} with this data", count)
        unknown = first_unknown(line.data, sent[-1], self._handed_on(event))
        if unknown:
            message = f"`{unknown}` of the {phrase} cannot be compared: the node forwards it unchanged"
            return line.fault(message, "leave it out: times and fields of unknown definitions are not compared")
        shown = with_expected_defaults(sent[-1], self._whole(event, messages.get(entries[-1][0])), line.data)
        return line.fault(f"the {phrase} was sent with other data", f"the sent data is {json_text(shown)}")

    def _whole(self, event: sct.Event, message: Any) -> Any:
        """Return all fields of a sent message."""
        interface, section = self._controller.type_of(event)
        kind = NestedType(interface.package, interface.type)
        value = {} if message is None else plain(message)
        return with_defaults(self._distribution, kind, section, value, self._handed_on(event))

    def _handed_on(self, event: sct.Event) -> list[Sequence[str]]:
        """Return the paths in a command at which data is forwarded unchanged."""
        return [
            tuple(field.path)
            for _, _, sending in sent_messages(self._graph)
            if sending.event == event
            for field in fields_set(sending)
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
    Blocked.ASSUMPTION: "an assumption excludes it",
    Blocked.REQUIREMENT: "its requirements forbid it",
    Blocked.SYNTHESIS: "synthesis forbids it",
}


def _counted(line: SentCommand, phrase: str, count: int) -> Diagnostic | None:
    """Return a finding if a command was sent in another number than expected."""
    if line.count in (None, count):
        return None
    times = f"{count} time{'s' * (count != 1)}"
    return line.fault(f"the {phrase} was sent {times} since the last step, not {line.count}")
