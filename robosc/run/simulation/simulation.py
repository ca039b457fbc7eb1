"""Runs of a supervised robot: event by event, with undo, or through its control loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robosc.analysis.wording import name
from robosc.engine import Blocked, ControlLoop, Engine, Hooks, Settings
from robosc.model import expression as ex
from robosc.model import sct
from robosc.model.engine import Role
from robosc.model.semantics.definition import named_state
from robosc.model.semantics.domains import domain
from robosc.model.semantics.printing import SctPrinter
from robosc.model.semantics.roles import assumption_name, assumption_text, event_name, is_goal
from robosc.run.simulation.data import EventData
from robosc.run.simulation.script import REFUSE, WAIT
from robosc.run.simulation.unreadable import Unreadable

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from random import Random

    from robosc.base.ros_types import RosTypes
    from robosc.engine.state import State, Value
    from robosc.model import rosgraph
    from robosc.run.simulation.tracked_data import Stored

#: Maximum number of draws of random data for a command, until some are allowed.
_DRAWS = 100
#: Lines of scripts beside events: the end of a period; the begin and end of a message with several events.
TICK, BEGIN, END = "tick", "begin", "end"


def whole_state(engine: Engine) -> dict[str, Value]:
    """Return the location of every plant, also of those with only one, and the values of variables, by name."""

    def value(element: sct.Plant | sct.DiscreteVariable) -> Value:
        if isinstance(element, sct.Plant):
            return str(element.locations[engine.location(element)].name)
        return engine.value(element)

    return named_state(engine.model, value)


@dataclass(frozen=True)
class RequestResult:
    """Requested event: whether it happened, else what blocked it, and the state afterwards.

    `violated`: the assumptions that block it, by name or else by text.
    """

    event: str
    data: Mapping[str, Any]
    by: Blocked | Unreadable | None
    state: Mapping[str, Value]
    violated: Sequence[str] = ()

    @property
    def accepted(self) -> bool:
        """Whether it happened."""
        return self.by is None

    def answer(self) -> dict[str, Any]:
        """Return the object that `simulate --script` prints."""
        by = None if self.by is None else str(self.by)
        details = dict(self.data) if self.event == REFUSE else {}
        details |= {"violated": list(self.violated)} if self.violated else {}
        return {"event": self.event, **details, "accepted": self.accepted, "by": by, "state": dict(self.state)}


def violated_names(engine: Engine, event: str) -> list[str]:
    """Return the assumptions that an event of the robot would violate now, by name or else by text."""
    return list(map(assumption_name, engine.violated_assumptions(event)))


def refusal(engine: Engine, action: str) -> Blocked | None:
    """Return why a server cannot refuse to cancel the goal of an action: it is not being canceled; else None."""
    ends = (event for event in _plant(engine, action).events if event.kind == sct.EventKind.canceled)
    return engine.blocked_by(event_name(next(ends)))


def refusal_in_words(engine: Engine, action: str) -> str:
    """Return the name of the step `refuse cancel` of an action, such as ``refusal to cancel `Base.go` ``."""
    return f"refusal to cancel `{name(_plant(engine, action))}`"


def _plant(engine: Engine, called: str) -> sct.Plant:
    return next(plant for plant in engine.model.plants if plant.name == called)


class Simulation:
    """Supervised automaton of a model: only requested events happen. `trace` is the list of events that happened."""

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        graph: rosgraph.RosGraph | None = None,
        types: RosTypes | None = None,
    ) -> None:
        """`types`: the definitions of ROS types, for fields missing in data; None: those of the environment."""
        self.engine = Engine(model)
        self.data = EventData(self.engine, graph, types)
        self.trace: list[RequestResult] = []
        self._before: list[tuple[State, Stored]] = []
        self._events = {event_name(event): event for plant in model.plants for event in plant.events}

    @property
    def enabled(self) -> list[str]:
        """The enabled events, in the order of the model."""
        return [event for event in self.engine.events if self.engine.enabled(event)]

    def perform(self, event: str, data: Mapping[str, Any] | None = None) -> RequestResult:
        """Perform an event with data in the shape of the event log if it is enabled, else change nothing.

        A refusal to cancel a goal changes nothing, too. Raises DataError, and KeyError for an unknown event.
        """
        if event == REFUSE:
            arguments = data or {}
            return RequestResult(event, arguments, refusal(self.engine, arguments["of"]), whole_state(self.engine))
        inputs = self.data.inputs(event, data or {})
        self.engine.set_inputs(event, inputs)
        before = self.engine.state, self.data.stored
        by = (
            self.engine.blocked_by(event)
            or self.engine.inputs_blocked_by(event)
            or self.data.unreadable(event, data or {})
        )
        if by is None:
            self.data.before(event, data or {}, inputs)
            self.engine.perform(event, inputs)
        violated = violated_names(self.engine, event) if by is Blocked.ASSUMPTION else ()
        happened = RequestResult(event, data or {}, by, whole_state(self.engine), violated)
        if by is None:
            self._before.append(before)
            self.trace.append(happened)
        return happened

    def undo(self) -> RequestResult | None:
        """Take back the last event that happened and return it; None if there is none."""
        if not self.trace:
            return None
        self.engine.state, self.data.stored = self._before.pop()
        return self.trace.pop()

    def random_event(self, random: Random) -> tuple[str, dict[str, Any]] | None:
        """Return one of the enabled events, with random data; None if none is enabled."""
        enabled = self.enabled
        if not enabled:
            return None
        event = random.choice(enabled)
        for _ in range(_DRAWS):
            values = {carried.name: _any(carried.type, random) for carried in self._events[event].inputs}
            self.engine.set_inputs(event, values)
            if self.engine.permits_inputs(event):
                break
        return event, self.data.shape(event, self.data.fit_reason(event, values))

    def random_step(self, random: Random) -> RequestResult | None:
        """Perform one of the enabled events, with random data; return None if none is enabled."""
        chosen = self.random_event(random)
        return None if chosen is None else self.perform(*chosen)

    def reason(self, event: str, by: Blocked | Unreadable) -> str:
        """Return in words why an event can't happen in the present state; `by` is what blocks it."""
        if isinstance(by, Unreadable):
            if is_goal(self._events[event]):
                return f"{by.why}, so the controller rejects the goal"
            return f"{by.why}, so it counts as {by.error or by.response or 'not received'}"
        if event == REFUSE:
            return "its goal is not being canceled"
        if by is Blocked.PLANT:
            return _not_ready(self._events[event])
        if by is Blocked.ASSUMPTION:
            return f"excluded by {' and '.join(map(assumption_text, self.engine.violated_assumptions(event)))}"
        if by is Blocked.REQUIREMENT:
            texts = [failing.text for failing in self.engine.failing_requirements(event) if failing.text]
            return f"forbidden by {' and '.join(texts) or 'a requirement'}"
        supervisor = self.engine.model.supervisor
        assert supervisor is not None
        guard = next(guard for guard in supervisor.guards if event_name(guard.event) == event)
        needed = SctPrinter()(guard.synthesis) if guard.synthesis is not None else "false"
        otherwise = f"; otherwise, {guard.explanation}" if guard.explanation else ""
        return f"forbidden by synthesis, which requires {needed}{otherwise}"


def _not_ready(event: sct.Event) -> str:
    """Return why the plants block an event."""
    if is_goal(event):
        return "the controller rejects the goal"
    if event.kind == sct.EventKind.request:
        return "it waits: another request is open"
    if event.kind == sct.EventKind.cancelRequest:
        return "no goal is open that a client can cancel"
    return "the robot is not ready for it"


def _any(kind: ex.Type, random: Random) -> Value:
    match kind:
        case ex.BooleanType():
            return random.random() < 0.5
        case ex.IntegerType(minimum=int(low), maximum=int(high)):
            return random.randint(low, high)
    assert isinstance(kind, ex.EnumerationType)
    low, high = domain(kind)
    return str(kind.enumeration.literals[random.randint(low, high)].name)


class LoopSimulation:
    """Control loop of a model, step by step: incoming events as batches of one or more, and ticks."""

    OWN = (TICK, BEGIN, END, WAIT)

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        graph: rosgraph.RosGraph | None = None,
        settings: Settings | None = None,
        types: RosTypes | None = None,
    ) -> None:
        """`types`: the definitions of ROS types, for fields missing in data; None: those of the environment."""
        self._happened: list[str] = []
        hooks = Hooks(self._before, self._happened.append, lambda: self._happened.append("livelock"))
        self._loop = ControlLoop(model, settings, hooks)
        self.data = EventData(self._loop.engine, graph, types)
        #: Data and inputs of the events that a step gives.
        self._step_data: dict[str, tuple[Mapping[str, Any], Mapping[str, Value]]] = {}
        self._commands = {
            event.name for event in self._loop.engine.executed.events if event.role is Role.trigger and event.inputs
        }
        self._in_batch = False

    @property
    def events(self) -> list[str]:
        """The events that a script may name: those of the robot, and the loop's own steps."""
        events = self._loop.engine.executed.events
        return [*(event.name for event in events if event.role in (Role.incoming, Role.timeout)), *self.OWN]

    def step(self, event: str, data: Mapping[str, Any]) -> dict[str, Any]:
        """Perform a step; return the object that `simulate --loop --script` prints. Raises DataError."""
        inputs = {} if event in (*self.OWN, REFUSE) else self.data.inputs(event, data)
        self._happened.clear()
        violated: list[str] = []
        by: Blocked | Unreadable | None = None
        if event == WAIT:
            self._wait(round(data["seconds"] * 1000))
        elif event == REFUSE:
            by = refusal(self._loop.engine, data["of"])
        elif event in self.OWN:
            self._in_batch = event == BEGIN
            getattr(self._loop, event)()
        else:
            if not self._in_batch:
                self._loop.begin()
            engine = self._loop.engine
            engine.set_inputs(event, inputs)
            by = engine.blocked_by(event) or engine.inputs_blocked_by(event) or self.data.unreadable(event, data)
            violated = violated_names(engine, event) if by is Blocked.ASSUMPTION else []
            error = self.data.error_of(event) if violated else by.error if isinstance(by, Unreadable) else None
            if error is not None:
                data_of_error = self.data.of_unreadable(data)
                self._perform(error, data_of_error, self.data.inputs(error, data_of_error))
            elif by is None:
                self._perform(event, data, inputs)
            if not self._in_batch:
                self._loop.end()
        details = dict(data) if event in (WAIT, REFUSE) else {}
        details |= {"violated": violated} if violated else {}
        return {
            "event": event,
            **details,
            "accepted": by is None,
            "by": None if by is None else str(by),
            "happened": list(self._happened),
            "state": whole_state(self._loop.engine),
        }

    def _perform(self, event: str, data: Mapping[str, Any], inputs: Mapping[str, Value]) -> None:
        self._step_data = {event: (data, inputs)}
        self._loop.perform(event, inputs)
        self._step_data = {}

    def _before(self, event: str) -> bool:
        """Set the inputs of a command to the data that it sends, and change the variables that the node stores."""
        data, inputs = self._step_data.get(event, ({}, {}))
        if event in self._commands:
            inputs = self.data.inputs(event, {})
            self._loop.engine.set_inputs(event, inputs)
        if self._loop.engine.permits_inputs(event):
            self.data.before(event, data, inputs)
        return True

    def _wait(self, milliseconds: int) -> None:
        """Let time pass; timers that expire on the way fire at their time."""
        timers = self._loop.timers
        end = timers.now + milliseconds
        while timers.wait is not None and timers.now + timers.wait <= end:
            timers.at(timers.now + timers.wait)
            self._loop.expire()
        timers.at(end)
