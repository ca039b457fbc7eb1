"""Tours of a controller: stimuli planned to cover all goals; the runs are the traces."""

from __future__ import annotations

import random
from collections import Counter
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.base.cache import cached
from robosc.engine import Settings as LoopSettings
from robosc.model.semantics.roles import event_name
from robosc.run.node_tests.coverage import Coverage, Watcher
from robosc.run.node_tests.drive import Drive, DrivenController
from robosc.run.node_tests.plan import Plan
from robosc.run.node_tests.steps import WAIT, Place, Stimulus, TourStep
from robosc.run.runtime.core.event_log import nest
from robosc.run.runtime.core.port import Failure, GoalOutcome
from robosc.run.runtime.core.times import RESOLUTION_MS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from robosc.base.ros_types import RosDistribution
    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph
    from robosc.run.node_tests.coverage import Goal
    from robosc.run.node_tests.drive import Act
    from robosc.run.node_tests.samples import Class, IncomingKind

_SEED = 1
#: Maximum number of periods to wait for a timer, a failure or the pause after it.
_LONGEST = 600
#: Maximum number of runs. A state that is never reached again can be left in one way only per run.
_TRACES = 8


class _Controller(DrivenController):
    """Controller whose coverage is recorded."""

    def watch(self, shown: set[Goal]) -> None:
        """Begin to record the goals that are seen."""
        self._shown = shown
        #: Events since this was emptied.
        self.happened: set[str] = set()
        self._watcher = Watcher(self._control)

    def _before(self, name: str) -> bool:
        may_happen = super()._before(name)
        if may_happen:
            self.happened.add(name)
            self._shown.update(self._watcher.before_event(name))
        return may_happen

    def look(self) -> None:
        """Record the goals that are visible when the control loop has settled."""
        self._shown |= self._watcher.at_rest()

    def place(self, plan: Plan) -> Place:
        """Return the place of the controller when the control loop has settled."""
        self.look()
        return plan.place(self._control.saved, pauses=self.pauses)


#: Maximum number of deviations in a row that show no new goal: inputs may depend on data that no plan follows.
_IN_VAIN = 8


class _Planned(NamedTuple):
    """Planned steps from a place, and the goals seen before."""

    start: Place
    shown: frozenset[Goal]
    steps: list[TourStep]


class _OtherwiseError(Exception):
    """Deviation of a tour from the plan of an earlier one."""


def tour_of(graph: rosgraph.RosGraph, configuration: Configuration, distribution: RosDistribution) -> Tour:
    """Return the tour of a controller on one ROS.

    Within `robosc.base.cache.cache_results`, both versions of ROS share a plan if their stimuli are equal.
    """

    def anew() -> Tour:
        return Tour(graph, configuration, distribution)

    first = cached((Tour, graph), anew)
    if first.is_for(configuration, distribution):
        return first
    with suppress(_OtherwiseError):
        return Tour(graph, configuration, distribution, first)
    return anew()


class Tour(Drive):
    """Runs of one controller, each from its start: `traces` are their log lines, `coverage` their joint coverage."""

    _controller: _Controller

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        configuration: Configuration,
        distribution: RosDistribution,
        earlier: Tour | None = None,
    ) -> None:
        super().__init__(graph, configuration, distribution)
        self._choice = random.Random(_SEED)  # noqa: S311  # reproducible
        self._used: Counter[object] = Counter()
        self._acts = self._all_acts()
        control = configuration.control_loop
        self.plan = Plan(
            graph.model,
            LoopSettings(control.events_per_tick, control.reactions_per_tick, control.react_immediately, RESOLUTION_MS),
            [*self._acts, WAIT],
            _LONGEST * self.parameters["period_ms"],
            self.parameters["period_ms"],
            self.parameters.get("retry_ms", 0),
            graph,
        )
        #: Planned parts of all runs, in order.
        self.planned: list[_Planned] = []
        self._planned_before: Iterator[_Planned] | None = None
        if earlier is not None:
            if not self.plan.is_like(earlier.plan):
                raise _OtherwiseError
            self.plan, self._planned_before = earlier.plan, iter(earlier.planned)
        self._shown: set[Goal] = set()
        self._steps = 0
        self.traces: list[list[str]] = []
        self._run()
        while len(self.traces) < _TRACES and (left := self.plan.possible - self._shown):
            self._run()
            if left <= self.plan.possible - self._shown:
                self.traces.pop()
                break
        self.plan.release()
        shown = frozenset(self._shown)
        impossible = frozenset(self.plan.goals) - self.plan.possible - shown
        self.coverage = Coverage(tuple(self.plan.goals), shown, impossible, self._steps)

    def _run(self) -> None:
        """Run the controller from its start until no new goal can be seen."""
        self._controller = self._begin(_Controller)
        self._controller.watch(self._shown)
        self._controller.start()
        try:
            self._pass_period()
            self._controller.look()
            shown = len(self._shown)
            in_vain = 0
            again = False
            while in_vain < _IN_VAIN and any(self._stepped(step) for step in self._tour(again=again)):
                again = True
                in_vain = 0 if len(self._shown) > shown else in_vain + 1
                shown = len(self._shown)
        finally:
            self._controller.close()
        self.traces.append(self._lines.lines)

    def _work(self) -> None:
        super()._work()
        self._controller.look()

    def is_for(self, configuration: Configuration, distribution: RosDistribution) -> bool:
        """Return whether the tour was created for this configuration and distribution."""
        return self._configuration == configuration and self._distribution is distribution

    def _tour(self, *, again: bool) -> list[TourStep]:
        start, shown = self._controller.place(self.plan), frozenset(self._shown)
        if self._planned_before is None:
            planned = _Planned(start, shown, self.plan.tour(start, shown, again=again))
        else:
            before = next(self._planned_before, None)
            if before is None or before.shown != shown or not before.start.resembles(start):
                raise _OtherwiseError
            planned = before
        self.planned.append(planned)
        return planned.steps

    def _stepped(self, step: TourStep) -> bool:
        """Perform a step; return whether the controller deviated from the plan."""
        self._steps += 1
        self._controller.happened.clear()
        if step.stimulus.events:
            self._let_in(self._acts[step.stimulus])
        waits = self._waiting(step.stimulus)
        for _ in range(_LONGEST):
            self._pass_period()
            if not waits():
                break
        return not self._controller.place(self.plan).resembles(step.end)

    def _waiting(self, stimulus: Stimulus) -> Callable[[], bool]:
        """Return a function that returns whether the effect of the stimulus is still to come."""
        if stimulus.fails:
            [(failure, _)] = stimulus.events
            return lambda: failure not in self._controller.happened
        if stimulus.events:
            return lambda: False
        if self._controller.pauses:
            return lambda: self._controller.pauses
        up = self._controller.up
        return lambda: up is not None and self._now * 1000 < up

    # Incoming data

    def _all_acts(self) -> dict[Stimulus, Act]:
        """Return all stimuli, each with the function that performs it."""
        acts: dict[Stimulus, Act] = {}
        for topic in self._graph.subscriptions:
            acts |= self._classes(topic.topic, topic.receptions, partial(self._publish, topic))
        for service in self._graph.serviceClients:
            acts |= self._classes(service.identifier, [service.response], partial(self._answer, service))
            reasons = tuple((assignment.input.name, Failure.TIMEOUT.value) for assignment in service.error.inputs)
            failure = Stimulus(f"{service.identifier} fails", ((event_name(service.error.event), reasons),), fails=True)
            acts[failure] = partial(self._fail, service)
        for action in self._graph.actionClients:
            acts |= self._classes(action.identifier, [action.feedback], partial(self._feed_back, action))
            succeed = partial(self._end, action, GoalOutcome.SUCCEEDED)
            acts |= self._classes(action.identifier, [action.response], succeed)
            acts |= self._classes(
                f"{action.identifier} fails", [action.error], partial(self._abort, action), fails=True
            )
            end = partial(self._end, action, GoalOutcome.CANCELED)
            acts |= self._classes(f"{action.identifier} is canceled", [action.canceled], end)
        for called in self._graph.serviceServers:
            acts |= self._classes(f"call of {called.identifier}", [called.request], partial(self._call, called))
        for served in self._graph.actionServers:
            acts |= self._classes(f"goal for {served.identifier}", [served.request], partial(self._send_goal, served))
            if served.cancel is not None:
                cancel = Stimulus(f"{served.identifier} is to be canceled", ((event_name(served.cancel), ()),))
                acts[cancel] = partial(self._ask_to_cancel, served)
        return acts

    def _classes(
        self,
        name: str,
        receptions: Sequence[rosgraph.Reception],
        send: Callable[[IncomingKind, Class], dict[str, Any] | None],
        *,
        fails: bool = False,
    ) -> dict[Stimulus, Act]:
        kind = self.incoming[receptions[0].event]
        return {
            Stimulus(f"{name} {number}", message_class.events, fails): partial(send, kind, message_class)
            for number, message_class in enumerate(kind.classes)
        }

    def _publish(self, topic: rosgraph.Subscription, kind: IncomingKind, message_class: Class) -> dict[str, Any]:
        """Send a message; the first one on a topic with several events lacks data that one of them needs."""
        unreadable = [self._unreadable(reception) for reception in topic.receptions[1:]]
        short = next((message for message in unreadable if message is not None), None)
        data, fields = self._message(kind, message_class) if short is None else short
        self._controller.receive(topic, data)
        return fields

    def _answer(self, client: rosgraph.ServiceClient, kind: IncomingKind, message_class: Class) -> dict[str, Any]:
        _, handlers = self._robot.calls.pop(client)
        data, fields = self._message(kind, message_class)
        handlers.answered(data)
        return fields

    def _fail(self, client: rosgraph.ServiceClient) -> dict[str, Any] | None:
        """Answer with data that can't be read, if possible; else let the call time out."""
        _, handlers = self._robot.calls.pop(client)
        unreadable = self._unreadable(client.response)
        if unreadable is None:
            return None
        handlers.answered(unreadable[0])
        return unreadable[1]

    def _feed_back(self, client: rosgraph.ActionClient, kind: IncomingKind, message_class: Class) -> dict[str, Any]:
        data, fields = self._message(kind, message_class)
        self._robot.goals[client].handlers.feedback(data)
        return fields

    def _end(
        self, client: rosgraph.ActionClient, outcome: GoalOutcome, kind: IncomingKind, message_class: Class
    ) -> dict[str, Any] | None:
        """End a goal with a result."""
        data, fields = self._message(kind, message_class)
        self._robot.goals.pop(client).handlers.ended(outcome, data, "")
        return fields if fields or outcome is GoalOutcome.SUCCEEDED else None

    def _abort(self, client: rosgraph.ActionClient, kind: IncomingKind, message_class: Class) -> dict[str, Any] | None:
        """End a goal with a result that can't be read, if possible; else abort it."""
        unreadable = self._unreadable(client.response)
        if unreadable is None:
            return self._end(client, GoalOutcome.ABORTED, kind, message_class)
        self._robot.goals.pop(client).handlers.ended(GoalOutcome.SUCCEEDED, unreadable[0], "")
        return unreadable[1]

    def _call(self, service: rosgraph.ServiceServer, kind: IncomingKind, message_class: Class) -> dict[str, Any]:
        data, fields = self._message(kind, message_class)
        self._controller.request(service, data)
        return fields

    def _send_goal(self, action: rosgraph.ActionServer, kind: IncomingKind, message_class: Class) -> dict[str, Any]:
        data, fields = self._message(kind, message_class)
        self._controller.request_goal(action, data)
        return fields

    def _ask_to_cancel(self, action: rosgraph.ActionServer) -> None:
        self._controller.request_cancel(action)

    def _message(self, kind: IncomingKind, message_class: Class) -> tuple[Any, dict[str, Any]]:
        """Return the least used sample of a class, as data and as nested fields."""
        number = min(
            range(len(message_class.samples)),
            key=lambda sample: (self._used[id(message_class), sample], self._choice.random()),
        )
        self._used[id(message_class), number] += 1
        return kind.message(message_class.samples[number]), nest(message_class.samples[number])

    def _unreadable(self, reception: rosgraph.Reception) -> tuple[Any, dict[str, Any]] | None:
        """Return data without the elements that the present state needs; None if it needs none, or if used before."""
        kind = self.incoming[reception.event]
        if event_name(reception.event) not in kind.unreadable or self._used["unreadable", reception]:
            return None
        data = kind.message({})
        if self._controller.reads([reception], data):
            return None
        self._used["unreadable", reception] += 1
        return data, {}
