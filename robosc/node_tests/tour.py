"""Tours of a controller: what comes in is planned, so that all is seen that can be; what it does are the traces."""

from __future__ import annotations

import random
from collections import Counter
from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.engine import Settings as LoopSettings
from robosc.node_tests.coverage import Coverage, Watcher
from robosc.node_tests.messages import message
from robosc.node_tests.plan import WAIT, Place, Plan, Step, Stimulus
from robosc.node_tests.robot import Robot
from robosc.node_tests.samples import all_incoming
from robosc.node_tests.trace_player import START, Pace
from robosc.runtime.core.controller import Controller
from robosc.runtime.core.event_log import EventLog, nested
from robosc.runtime.core.event_loop import EventLoop
from robosc.runtime.core.json_text import json_text
from robosc.runtime.core.port import Outcome
from robosc.runtime.core.settings import Settings
from robosc.runtime.core.times import RESOLUTION_MS
from robosc.semantics.operators import UnreadableError
from robosc.semantics.parameters import Value, controller_parameters
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.configuration import Configuration
    from robosc.metamodel import rosgraph, sct
    from robosc.node_tests.coverage import Goal
    from robosc.node_tests.samples import Class, Incoming
    from robosc.ros_types import RosDistribution

    #: Lets something come in; the fields of what it is, None where it has none.
    Act = Callable[[], "dict[str, Any] | None"]

_SEED = 1
_DAY = 24 * 3600 * 1000
#: So many periods at most are waited for a time that is up, a failure or the pause after it.
_LONGEST = 600
#: A state that is never come back to can be left in one way only: others take other runs, at most so many.
_TRACES = 8
#: So many milliseconds after its time a timer has rung for sure.
_MARGIN = 1.01


def parameters(graph: rosgraph.RosGraph, configuration: Configuration) -> dict[str, bool | int]:
    """With what a node is started for a test: every deadline is a multiple of the period, so that it falls on no tick.

    A robot whose topics are silent between two lines of a trace is not stopped.
    """
    period = configuration.control_loop.period_ms
    declared = _defaults(graph, configuration)
    most = _DAY // period * period
    rounded: dict[str, bool | int] = {
        name: min(-(-int(value) // period) * period, most)
        for name, value in declared.items()
        if name in ("service_timeout_ms", "action_timeout_ms", "retry_ms")
    }
    return {"period_ms": period, **rounded, "watchdog_stops": False}


def _defaults(graph: rosgraph.RosGraph, configuration: Configuration) -> dict[str, Value]:
    return {parameter.name: parameter.default for parameter in controller_parameters(graph, configuration, "")}


class MeetingTimesError(Exception):
    """A time is up when a tick is due."""


class _Lines(EventLog):
    """Keeps the lines of a log."""

    active = True

    def __init__(self) -> None:
        super().__init__("")
        self.kept: list[str] = []

    def append(self, line: str) -> None:
        self.kept.append(line.removesuffix("\n"))


class _Controller(Controller):
    """A controller that is watched."""

    def watch(self, shown: set[Goal]) -> None:
        """Begins to note what there is to see."""
        self._shown = shown
        self._watcher = Watcher(self._control)

    def _before(self, name: str) -> bool:
        may_happen = super()._before(name)
        if may_happen:
            self._shown.update(self._watcher.happening(name))
        return may_happen

    def place(self, plan: Plan) -> Place:
        """Where it is, now that it has done what it can do at once."""
        self._shown |= self._watcher.at_rest()
        return plan.place(self._control.saved, pauses=self.pauses)

    @property
    def pauses(self) -> bool:
        """Whether it waits after a failure."""
        return any(failure.pause is not None for failure in self._failures.values())

    @property
    def up(self) -> int | None:
        """At how many milliseconds the next time is up; None where none runs."""
        timers = self._control.timers
        return None if timers.wait is None else timers.now + timers.wait

    def reads(self, receptions: Sequence[rosgraph.Reception], data: Any) -> bool:
        """Whether what the transitions of the present state need of a message can be read."""
        try:
            for reception in receptions:
                self._data.received(reception.event, reception.inputs, data)
        except UnreadableError:
            return False
        return True


class Tour:
    """Runs of one controller, each from its start: `traces` are the lines of each, `coverage` is what they show."""

    def __init__(self, graph: rosgraph.RosGraph, configuration: Configuration, distribution: RosDistribution) -> None:
        self._graph = graph
        self._distribution = distribution
        self._configuration = configuration
        self._choice = random.Random(_SEED)  # noqa: S311  # the same each time
        self._parameters = parameters(graph, configuration)
        self._period = self._parameters["period_ms"] / 1000
        self._used: Counter[object] = Counter()
        #: What each event that comes in shows, and the messages to choose from; the events of one topic share it.
        self.incoming: dict[sct.Event, Incoming] = all_incoming(graph, distribution)
        self._acts = self._all_acts()
        control = configuration.control_loop
        self.plan = Plan(
            graph.model,
            LoopSettings(control.events_per_tick, control.reactions_per_tick, control.react_immediately, RESOLUTION_MS),
            [*self._acts, WAIT],
            _LONGEST * self._parameters["period_ms"],
        )
        self._shown: set[Goal] = set()
        self._steps = 0
        self.traces: list[list[str]] = []
        self._run()
        while len(self.traces) < _TRACES and (left := self.plan.possible - self._shown):
            self._run()
            if left <= self.plan.possible - self._shown:
                self.traces.pop()
                break
        shown = frozenset(self._shown)
        impossible = frozenset(self.plan.goals) - self.plan.possible - shown
        self.coverage = Coverage(tuple(self.plan.goals), shown, impossible, self._steps)

    def _run(self) -> None:
        """Runs the controller from its start to where nothing new can be seen any more."""
        self._pace = Pace(self._period)
        self._now = START * self._period
        settings = Settings(_defaults(self._graph, self._configuration) | self._parameters, self._configuration)
        self._robot = Robot(self._graph, self._distribution, lambda: self._now)
        self._event_loop = EventLoop(lambda: self._now)
        self._lines = _Lines()
        self._controller = _Controller(self._graph, settings, self._robot, self._event_loop)
        self._controller.watch(self._shown)
        self._controller.log_to(self._lines)
        self._controller.start()
        try:
            self._pass_period()
            while any(self._stepped(step) for step in self._tour()):
                pass
        except MeetingTimesError:
            pass  # the trace ends here
        finally:
            self._controller.close()
        self.traces.append(self._lines.kept)

    def _tour(self) -> list[Step]:
        return self.plan.tour(self._controller.place(self.plan), self._shown)

    def _stepped(self, step: Step) -> bool:
        """Makes a step; says whether the controller has done something else than was planned."""
        self._steps += 1
        if step.stimulus.events:
            self._let_in(self._acts[step.stimulus])
        waits = self._waiting(step.stimulus)
        for _ in range(_LONGEST):
            self._pass_period()
            if not waits():
                break
        return self._controller.place(self.plan) != step.end

    def _let_in(self, act: Act) -> None:
        before = len(self._lines.kept)
        sent = act()
        _work(self._event_loop)
        if sent is not None and len(self._lines.kept) > before:
            line = self._lines.kept[before]
            self._lines.kept[before] = f'{line[:-1]},"message":{json_text(sent)}}}'

    def _waiting(self, stimulus: Stimulus) -> Callable[[], bool]:
        """Whether what the stimulus waits for is still to come."""
        if stimulus.fails:
            return lambda: not self._controller.pauses
        if stimulus.events:
            return lambda: False
        if self._controller.pauses:
            return lambda: self._controller.pauses
        up = self._controller.up
        return lambda: up is not None and self._now * 1000 < up

    # Time

    def _pass_period(self) -> None:
        """As the player lets it pass: where a time is up on the way, the clock stops there.

        Raises MeetingTimesError where that is when the node has its tick: which of them comes first, ROS does not say.
        """
        over = False
        while not over:
            self._robot.end_cancelled()
            _work(self._event_loop)
            up = self._controller.up
            stop = self._pace.next if up is None else self._pace.before((up + _MARGIN) / 1000)
            if stop is None:
                assert up is not None
                self._now = (up + _MARGIN) / 1000
            else:
                self._now = stop
                over = self._pace.advance()
                if not over and up is not None and up < stop * 1000:
                    raise MeetingTimesError
            _work(self._event_loop)

    # What comes in

    def _all_acts(self) -> dict[Stimulus, Act]:
        """What may come in, each with what lets it."""
        acts: dict[Stimulus, Act] = {}
        for topic in self._graph.subscriptions:
            acts |= self._classes(topic.topic, topic.receptions, partial(self._publish, topic))
        for service in self._graph.serviceClients:
            acts |= self._classes(service.identifier, [service.response], partial(self._answer, service))
            failure = Stimulus(f"{service.identifier} fails", ((event_name(service.error), ()),), fails=True)
            acts[failure] = partial(self._fail, service)
        for action in self._graph.actionClients:
            acts |= self._classes(action.identifier, [action.feedback], partial(self._feed_back, action))
            acts |= self._classes(action.identifier, [action.response], partial(self._succeed, action))
            failure = Stimulus(f"{action.identifier} fails", ((event_name(action.error), ()),), fails=True)
            acts[failure] = partial(self._abort, action)
        return acts

    def _classes(
        self, name: str, receptions: Sequence[rosgraph.Reception], send: Callable[[Incoming, Class], dict[str, Any]]
    ) -> dict[Stimulus, Act]:
        kind = self.incoming[receptions[0].event]
        return {
            Stimulus(f"{name} {number}", found.events): partial(send, kind, found)
            for number, found in enumerate(kind.classes)
        }

    def _publish(self, topic: rosgraph.Subscription, kind: Incoming, found: Class) -> dict[str, Any]:
        """Sends a message; the first one on a topic with several events lacks what one of them needs."""
        unreadable = [self._unreadable(reception) for reception in topic.receptions[1:]]
        short = next((message for message in unreadable if message is not None), None)
        data, fields = self._message(kind, found) if short is None else short
        self._controller.receive(topic, data)
        return fields

    def _answer(self, client: rosgraph.ServiceClient, kind: Incoming, found: Class) -> dict[str, Any]:
        _, handlers = self._robot.calls.pop(client)
        data, fields = self._message(kind, found)
        handlers.answered(data)
        return fields

    def _fail(self, client: rosgraph.ServiceClient) -> dict[str, Any] | None:
        """An answer that can't be read where there is one, else none: the time will be over."""
        _, handlers = self._robot.calls.pop(client)
        unreadable = self._unreadable(client.response)
        if unreadable is None:
            return None
        handlers.answered(unreadable[0])
        return unreadable[1]

    def _feed_back(self, client: rosgraph.ActionClient, kind: Incoming, found: Class) -> dict[str, Any]:
        data, fields = self._message(kind, found)
        self._robot.goals[client].handlers.feedback(data)
        return fields

    def _succeed(self, client: rosgraph.ActionClient, kind: Incoming, found: Class) -> dict[str, Any]:
        data, fields = self._message(kind, found)
        self._robot.goals.pop(client).handlers.ended(Outcome.SUCCEEDED, data, "")
        return fields

    def _abort(self, client: rosgraph.ActionClient) -> dict[str, Any] | None:
        """A result that can't be read where there is one, else none: the goal is aborted."""
        handlers = self._robot.goals.pop(client).handlers
        unreadable = self._unreadable(client.response)
        if unreadable is None:
            handlers.ended(Outcome.ABORTED, None, "")
            return None
        handlers.ended(Outcome.SUCCEEDED, unreadable[0], "")
        return unreadable[1]

    def _message(self, kind: Incoming, found: Class) -> tuple[Any, dict[str, Any]]:
        """Data of a class that came in least often until now."""
        number = min(range(len(found.samples)), key=lambda one: (self._used[id(found), one], self._choice.random()))
        self._used[id(found), number] += 1
        return message(kind.fields, found.samples[number]), nested(found.samples[number])

    def _unreadable(self, reception: rosgraph.Reception) -> tuple[Any, dict[str, Any]] | None:
        """Data without the elements that the present state needs; None where it needs none, or had that before."""
        kind = self.incoming[reception.event]
        if event_name(reception.event) not in kind.unreadable or self._used["unreadable", reception]:
            return None
        data = message(kind.fields, {})
        if self._controller.reads([reception], data):
            return None
        self._used["unreadable", reception] += 1
        return data, {}


def _work(event_loop: EventLoop) -> None:
    while event_loop.run_pending() == 0:
        pass
