"""A random walk of a controller: what comes in is chosen at random, what the controller does with it is the trace."""

from __future__ import annotations

import random
from collections import Counter
from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.engine import Engine
from robosc.node_tests.messages import Leaf, message
from robosc.node_tests.robot import Robot
from robosc.node_tests.samples import Incoming, Values, find_samples, incoming, shortened
from robosc.node_tests.trace_player import START, between, just_after
from robosc.ros_types import Section
from robosc.runtime.core.controller import Controller
from robosc.runtime.core.event_log import EventLog, ReceivedData, nested
from robosc.runtime.core.event_loop import EventLoop
from robosc.runtime.core.json_text import json_text
from robosc.runtime.core.node_data import NodeData
from robosc.runtime.core.port import Outcome
from robosc.runtime.core.settings import Settings
from robosc.semantics.messages import kept_reads
from robosc.semantics.parameters import Value, controller_parameters
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from robosc.configuration import Configuration
    from robosc.metamodel import rosgraph, sct
    from robosc.ros_types import RosDistribution

_DAY = 24 * 3600 * 1000
#: Of so many answers one is a failure.
_FAILURES = 6
#: Of so many messages with arrays one is without some of what is read.
_UNREADABLE = 6


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


class _Lines(EventLog):
    """Keeps the lines of a log until they are taken."""

    active = True

    def __init__(self) -> None:
        super().__init__("")
        self._kept: list[str] = []

    def append(self, line: str) -> None:
        self._kept.append(line.removesuffix("\n"))

    def taken(self) -> list[str]:
        """The lines since the last time."""
        lines, self._kept = self._kept, []
        return lines


class Walk:
    """One walk of one controller, from its start; `seed` decides where it goes."""

    def __init__(
        self, graph: rosgraph.RosGraph, configuration: Configuration, distribution: RosDistribution, seed: int
    ) -> None:
        self._graph = graph
        self._distribution = distribution
        self._configuration = configuration
        self._choice = random.Random(seed)  # noqa: S311  # the same each time
        self._parameters = parameters(graph, configuration)
        self._period = self._parameters["period_ms"] / 1000
        self._now = START * self._period
        self._tick = 0
        self._failing_until = 0.0
        self._values = Values(graph)
        self._later = list(kept_reads(graph))
        #: What each event that comes in shows, and the messages to choose from; the events of one topic share it.
        self.incoming: dict[sct.Event, Incoming] = self._known(seed)
        self._used: Counter[object] = Counter()

    def go(self, stimuli: int) -> Iterator[str]:
        """The lines of the trace of so many stimuli."""
        declared = _defaults(self._graph, self._configuration)
        settings = Settings(declared | self._parameters, self._configuration)
        robot = Robot(self._graph, self._distribution, lambda: self._now)
        event_loop = EventLoop(lambda: self._now)
        lines = _Lines()
        controller = Controller(self._graph, settings, robot, event_loop)
        controller.log_to(lines)
        controller.start()
        try:
            yield from self._went(stimuli, controller, robot, event_loop, lines.taken)
        finally:
            controller.close()

    def _went(
        self, stimuli: int, controller: Controller, robot: Robot, event_loop: EventLoop, new: Callable[[], list[str]]
    ) -> Iterator[str]:
        for _ in range(stimuli):
            self._pass_period(event_loop)
            robot.end_cancelled()
            _work(event_loop)
            yield from new()
            for _ in range(self._choice.choice((1, 1, 1, 1, 2))):
                sent = self._stimulate(controller, robot)
                _work(event_loop)
                first, *rest = new() or [""]
                if first:
                    yield first if sent is None else f'{first[:-1]},"message":{json_text(sent)}}}'
                yield from rest
        self._pass_period(event_loop)
        yield from new()

    def _pass_period(self, event_loop: EventLoop) -> None:
        """As the player lets it pass."""
        self._tick += 1
        for time_of in (just_after, between):
            self._now = time_of(self._tick, self._period)
            _work(event_loop)

    def _stimulate(self, controller: Controller, robot: Robot) -> dict[str, Any] | None:
        """Something comes in; the fields of what it is, None where it has none."""
        late = self._now - self._parameters.get("service_timeout_ms", 0) / 2000
        for service, (called, _) in robot.calls.items():
            if called < late:
                return self._answer(robot, service)
        options: list[tuple[float, Callable[[], dict[str, Any] | None]]] = [
            (3 / (1 + self._used[topic]), partial(self._publish, controller, topic))
            for topic in self._graph.subscriptions
        ]
        options += [(2, partial(self._answer, robot, service)) for service in robot.calls]
        options += [(2, partial(self._feed_back, robot, action)) for action in robot.goals]
        options += [(1, partial(self._end, robot, action)) for action in robot.goals]
        if not options:
            return None
        (act,) = self._choice.choices([act for _, act in options], [weight for weight, _ in options])
        return act()

    def _publish(self, controller: Controller, topic: rosgraph.Subscription) -> dict[str, Any]:
        self._used[topic] += 1
        data, fields = self._message(topic.receptions[0].event)
        controller.receive(topic, data)
        return fields

    def _answer(self, robot: Robot, client: rosgraph.ServiceClient) -> dict[str, Any] | None:
        _, handlers = robot.calls.pop(client)
        if self._shall_fail("service_timeout_ms"):
            return None  # never answered: the time will be over
        data, fields = self._message(client.response.event)
        handlers.answered(data)
        return fields

    def _feed_back(self, robot: Robot, client: rosgraph.ActionClient) -> dict[str, Any]:
        data, fields = self._message(client.feedback.event)
        robot.goals[client].handlers.feedback(data)
        return fields

    def _end(self, robot: Robot, client: rosgraph.ActionClient) -> dict[str, Any] | None:
        handlers = robot.goals.pop(client).handlers
        if self._shall_fail():
            handlers.ended(Outcome.ABORTED, None, "")
            return None
        data, fields = self._message(client.response.event)
        handlers.ended(Outcome.SUCCEEDED, data, "")
        return fields

    def _shall_fail(self, *timeouts: str) -> bool:
        """Now and then, but never so that deadlines meet: which of them comes first, ROS does not say."""
        fails = self._now > self._failing_until and self._choice.randrange(_FAILURES) == 0
        if fails:
            deadlines = sum(self._parameters[timeout] for timeout in (*timeouts, "retry_ms"))
            self._failing_until = self._now + deadlines / 1000 + self._period
        return fails

    def _message(self, event: sct.Event) -> tuple[Any, dict[str, Any]]:
        """Data that means something which came in least often until now."""
        kind = self.incoming[event]
        literals = min(kind.samples, key=lambda found: (self._used[event, found], self._choice.random()))
        self._used[event, literals] += 1
        values: dict[tuple[str, ...], Leaf] = dict(self._choice.choice(kind.samples[literals]))
        if not kind.conversions:
            pools = {path: self._values.of(field) for path, field in kind.fields.items()}
            values = {path: self._choice.choice(pool) for path, pool in pools.items() if pool}
        if kind.unreadable and self._choice.randrange(_UNREADABLE) == 0:
            values = shortened(values, self._choice)
        return message(kind.fields, values), nested(values)

    def _known(self, seed: int) -> dict[sct.Event, Incoming]:
        data = NodeData(self._graph, Engine(self._graph.model))
        known: dict[sct.Event, Incoming] = {}
        for interface, part, receptions in self._receptions():
            described = []
            for reception in receptions:
                values = [assigned.value for assigned in reception.inputs] + data.values_read(reception.event)
                later = [(path, read) for kept, path, read in self._later if kept is reception]
                described.append((event_name(reception.event), ReceivedData(values).parts, values, later))
            kind = incoming(self._distribution, interface, part, described)
            find_samples(kind, self._values, data, seed)
            known |= dict.fromkeys((reception.event for reception in receptions), kind)
        return known

    def _receptions(self) -> Iterator[tuple[rosgraph.Interface, Section, Sequence[rosgraph.Reception]]]:
        for topic in self._graph.subscriptions:
            yield topic.interface, Section.MESSAGE, topic.receptions
        for service in self._graph.serviceClients:
            yield service.interface, Section.RESPONSE, [service.response]
        for action in self._graph.actionClients:
            yield action.interface, Section.FEEDBACK, [action.feedback]
            yield action.interface, Section.RESULT, [action.response]


def _work(event_loop: EventLoop) -> None:
    while event_loop.run_pending() == 0:
        pass
