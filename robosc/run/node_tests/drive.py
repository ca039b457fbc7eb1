"""Controller that runs in Python without ROS, with a simulated robot and a simulated clock."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from robosc.language.configuration.parameters import Value, controller_parameters
from robosc.model.semantics.operators import UnreadableError
from robosc.run.node_tests.robot import PlayedRequest, Robot
from robosc.run.node_tests.samples import all_incoming
from robosc.run.node_tests.trace_player import START, Pace
from robosc.run.runtime.core.controller import Controller
from robosc.run.runtime.core.event_log import EventLog
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.json_text import json_text
from robosc.run.runtime.core.settings import Settings
from robosc.run.runtime.core.times import RESOLUTION_MS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.base.ros_types import RosDistribution
    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph, sct
    from robosc.run.node_tests.samples import IncomingKind
    from robosc.run.runtime.core.clients import ActionClient, ServiceClient

    #: Function that lets data come in and returns its fields, None if it has none.
    Act = Callable[[], "dict[str, Any] | None"]

_Controller = TypeVar("_Controller", bound="DrivenController")

_DAY = 24 * 3600 * 1000
#: Milliseconds after its time at which a timer has certainly expired.
_MARGIN = 1.01
#: Seconds by which a timer expires late at most: the clock is read in whole milliseconds.
LATENESS = (RESOLUTION_MS + _MARGIN + 0.01) / 1000


def parameters(graph: rosgraph.RosGraph, configuration: Configuration) -> dict[str, bool | int]:
    """Return the parameters of a node under test. Every deadline is a multiple of the period, so none falls on a tick.

    The watchdog does not stop the robot when its topics are silent between two lines of a trace.
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
    """Log that keeps its lines in memory."""

    active = True

    def __init__(self) -> None:
        super().__init__("")
        self.lines: list[str] = []

    def append(self, line: str) -> None:
        self.lines.append(line.removesuffix("\n"))


class DrivenController(Controller):
    """Controller with access to its clients, its timers, and the readability of data."""

    def caller(self, service: rosgraph.ServiceClient) -> ServiceClient:
        """Return the client that calls a service."""
        return self._callers[service]

    def starter(self, action: rosgraph.ActionClient) -> ActionClient:
        """Return the client that sends the goals of an action."""
        return self._starters[action]

    def request(self, service: rosgraph.ServiceServer, data: Any) -> None:
        """Let a client call a service of the controller."""
        self.services[service].call(data, PlayedRequest())

    def request_goal(self, action: rosgraph.ActionServer, data: Any) -> bool:
        """Let a client send a goal to the controller; return whether the controller accepts it."""
        server = self.actions[action]
        accepted = server.accepts(data)
        if accepted:
            server.begin(PlayedRequest(), data)
        return accepted

    def request_cancel(self, action: rosgraph.ActionServer) -> bool:
        """Let a client ask to cancel its goal; return whether the controller accepts that."""
        return self.actions[action].cancel()

    def reads(self, receptions: Sequence[rosgraph.Reception], data: Any) -> bool:
        """Return whether the data of a message that the transitions of the present state need can be read."""
        try:
            for reception in receptions:
                self._data.receive(reception.event, reception.inputs, data)
        except UnreadableError:
            return False
        return True

    @property
    def pauses(self) -> bool:
        """Whether the controller pauses after a failure."""
        return any(failure.pause is not None for failure in self._failures.values())

    @property
    def up(self) -> int | None:
        """The time of the next expiry in milliseconds; None if no timer runs."""
        timers = self._control.timers
        return None if timers.wait is None else timers.now + timers.wait


class Drive:
    """Runs of one controller, one after the other; `_lines.lines` is the trace of the present run."""

    _controller: DrivenController

    def __init__(self, graph: rosgraph.RosGraph, configuration: Configuration, distribution: RosDistribution) -> None:
        self._graph = graph
        self._distribution = distribution
        self._configuration = configuration
        self.parameters = parameters(graph, configuration)
        self._period = self.parameters["period_ms"] / 1000
        #: Reads and sample messages of each incoming event; the events of one topic share them.
        self.incoming: dict[sct.Event, IncomingKind] = all_incoming(graph, distribution)

    def _begin(self, kind: type[_Controller]) -> _Controller:
        """Create the controller of a new run, without starting it."""
        self._pace = Pace(self._period)
        self._now = START * self._period
        self._expiries = 0
        settings = Settings(_defaults(self._graph, self._configuration) | self.parameters, self._configuration)
        self._robot = Robot(self._graph, self._distribution, lambda: self._now, self.incoming)
        self._event_loop = EventLoop(lambda: self._now)
        self._lines = _Lines()
        controller = kind(self._graph, settings, self._robot, self._event_loop)
        controller.log_to(self._lines)
        return controller

    def _let_in(self, act: Act) -> None:
        before = len(self._lines.lines)
        sent = act()
        self._work()
        if sent is not None and len(self._lines.lines) > before:
            line = self._lines.lines[before]
            self._lines.lines[before] = f'{line[:-1]},"message":{json_text(sent)}}}'

    def _pass_period(self) -> None:
        """Let a period pass as the player does: the clock stops where a timer expires on the way.

        A tick that is due at such a stop comes after the timer, as in every node.
        """
        over = False
        while not over:
            self._work()
            up = self._controller.up
            stop = self._pace.next if up is None else self._pace.before((up + _MARGIN) / 1000)
            if stop is None:
                self._expire()
            else:
                self._now = stop
                over = self._pace.advance()
                self._work()

    def _expire(self) -> None:
        """Let time pass until the next timer has expired."""
        assert self._controller.up is not None
        self._now = (self._controller.up + _MARGIN) / 1000
        self._expiries += 1
        self._work()

    def _pass_expiry(self, seconds: float) -> bool:
        """Let the next timer expire if it has expired by a time, with a tick that is due before; return whether so."""
        up = self._controller.up
        if up is None or (up + _MARGIN) / 1000 > seconds:
            return False
        if self._pace.before((up + _MARGIN) / 1000) is None:
            self._expire()
        else:
            self._pass_period()
        return True

    def _work(self) -> None:
        while self._event_loop.run_pending() == 0:
            pass
