"""Node without ROS, and the robot behind it, which a script or a tool plays."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass, field
from functools import partial
from threading import Event
from typing import TYPE_CHECKING, Any

from robosc.base.files.json_reading import JsonError, json_value
from robosc.base.files.reading import read
from robosc.base.ros_types import DefinitionError, Section
from robosc.base.ros_types.wire import NestedType
from robosc.model.semantics.roles import plant_of
from robosc.run.node_tests.messages import new_object, new_value
from robosc.run.runtime.core.event_loop import EventLoop, Timer
from robosc.run.runtime.core.node import LONGEST_WAIT, RunningNode
from robosc.run.runtime.core.port import CancelAnswer, GoalOutcome
from robosc.tools.gate.commands import UnknownTypeError
from robosc.tools.gate.shapes import Anything, Choice, Fields, Messages, Number, Shapes, faults_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import NoReturn

    from robosc.base.ros_types import RosTypes
    from robosc.language.configuration.parameters import Parameter
    from robosc.model import rosgraph
    from robosc.run.runtime.core.event_handler import EventHandler
    from robosc.run.runtime.core.port import CallHandlers, Client, Endpoint, GoalHandlers, Message, Server

#: Commands that the robot remembers.
_MOST_RECEIVED = 1000


@dataclass
class DryGoal:
    """Goal that the robot has accepted; it ends on a cancel, or when the robot ends it."""

    handlers: GoalHandlers
    result: Message
    runs: bool = True
    canceling: bool = False

    def cancel(self) -> None:
        """Accept the request to cancel, and end as canceled."""
        if not self.runs:
            self.handlers.cancel_answered(CancelAnswer.TERMINATED)
            return
        self.canceling = True
        self.handlers.cancel_answered(CancelAnswer.ACCEPTED)
        self.end(GoalOutcome.CANCELED, self.result)

    def is_canceling(self) -> bool:
        """Return whether the goal is being canceled."""
        return self.canceling

    def is_gone(self) -> bool:
        """Return False: the robot is in this process."""
        return False

    def end(self, outcome: GoalOutcome, result: Message) -> None:
        """End the goal."""
        self.runs = False
        self.handlers.ended(outcome, result, "")


@dataclass
class DryRobot:
    """Robot in this process: it accepts all goals, and answers each call with the last given response."""

    #: Names of commands and their data, the newest last.
    received: deque[tuple[str, Message]] = field(default_factory=lambda: deque(maxlen=_MOST_RECEIVED))
    responses: dict[rosgraph.ServiceClient, Message] = field(default_factory=dict)
    goals: dict[rosgraph.ActionClient, DryGoal] = field(default_factory=dict)
    receivers: dict[rosgraph.Subscription, Callable[[Message], None]] = field(default_factory=dict)


class DryNode(RunningNode):
    """Node of a layer without ROS. Its data has the types of ROS 2."""

    type_hint = ""
    refusals = (ValueError,)
    in_graph = False
    simulated = False

    def __init__(self, name: str, graph: rosgraph.RosGraph, types: RosTypes, report: Callable[[str], object]) -> None:
        """`types`: the definitions of the types of the graph. `report` gets all texts for people."""
        self._distribution = types.distribution(2)
        super().__init__(graph)
        self._name = name
        self._report = report
        self.event_loop = EventLoop(time.monotonic)
        self.robot = DryRobot()
        self._woken = Event()

    def _load_type(self, interface: rosgraph.Interface) -> Any:
        return interface

    # The node's life

    @property
    def full_name(self) -> str:
        return f"/{self._name}"

    def _parameter(self, parameter: Parameter) -> object:
        return parameter.default

    def _is_up(self) -> bool:
        return True

    def _spin_once(self) -> None:
        left = self.event_loop.run_pending()
        self._woken.wait(LONGEST_WAIT if left is None else min(left, LONGEST_WAIT))
        self._woken.clear()

    def wake(self) -> None:
        self._woken.set()

    def close(self) -> None:
        pass

    def _take_leave(self) -> None:
        pass

    def _follow_parameters(self, handler: EventHandler) -> None:
        pass

    def _absolute_names(self) -> Sequence[tuple[str, str]]:
        return ()

    # Reports

    def now(self) -> float:
        return time.time()

    def open_reports(self, names: Sequence[str]) -> None:
        pass

    def _diagnostics_publisher(self, kind: Any) -> Any:
        pass

    def open_diagnostics(self) -> None:
        pass

    def publish_report(self, name: str, text: str) -> None:
        pass

    def report_listeners(self, name: str) -> int:  # noqa: ARG002  # nothing can listen
        return 0

    def info(self, text: str) -> None:
        self._report(text)

    def warn(self, text: str) -> None:
        self._report(text)

    def error(self, text: str) -> None:
        self._report(text)

    # Data

    def hear(self) -> None:
        pass

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        return new_value(NestedType(interface.package, interface.type), section, self._distribution)

    def unset(self, interface: rosgraph.Interface, section: Section, path: Sequence[str]) -> Message:
        return new_object(self._distribution, interface, section, path)

    def wire_types(self, message: Message) -> Mapping[str, str]:
        types: Mapping[str, str] = message.wire_types
        return types

    def _stamp_now(self) -> Any:
        stamp = new_value(NestedType("builtin_interfaces", "Time"), Section.MESSAGE, self._distribution)
        seconds = self.now()
        stamp.sec, stamp.nanosec = int(seconds), int(seconds % 1 * 1e9)
        return stamp

    # The robot

    def _publisher(self, publisher: rosgraph.Publisher) -> Any:
        return _Topic(self.robot, publisher)

    def _subscribe(self, subscription: rosgraph.Subscription, receive: Callable[[Message], None]) -> None:
        self.robot.receivers[subscription] = receive

    def _service_client(self, service: rosgraph.ServiceClient) -> Any:
        return service

    def _action_client(self, action: rosgraph.ActionClient) -> Any:
        return action

    def is_served(self, client: Client) -> bool:  # noqa: ARG002  # the robot serves all
        return True

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: CallHandlers) -> None:
        self.robot.received.append((_name(client.request), request))
        response = self.robot.responses.get(client)
        handlers.answered(self.create(client.interface, Section.RESPONSE) if response is None else response)

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> DryGoal:
        self.robot.received.append((_name(client.request), goal))
        sent = self.robot.goals[client] = DryGoal(handlers, self.create(client.interface, Section.RESULT))
        handlers.accepted()
        return sent

    def type_name(self, interface: rosgraph.Interface) -> str:
        return f"{interface.package}/{interface.type}"

    def serving_nodes(self, element: Client | Server) -> Sequence[tuple[str, str]]:  # noqa: ARG002  # no ROS graph
        return ()

    def calling_nodes(self, client: Client) -> Sequence[str]:  # noqa: ARG002  # no ROS graph
        return ()

    def endpoints(self) -> Mapping[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        return {}

    # Only for controllers, and for layers between two nodes

    def inside(self, name: str) -> str:
        return name

    def _unused(self, *_: Any) -> NoReturn:
        raise NotImplementedError

    _relay: Any = _unused
    serve: Any = _unused
    _serve_action: Any = _unused
    _proxy: Any = _unused


@dataclass(frozen=True)
class _Topic:
    robot: DryRobot
    publisher: rosgraph.Publisher

    def get_subscription_count(self) -> int:
        """Return 1: the robot."""
        return 1

    def publish(self, message: Message) -> None:
        """Send a message to the robot."""
        (sending,) = self.publisher.sendings
        self.robot.received.append((_name(sending), message))


def _name(sending: rosgraph.Sending) -> str:
    plant = plant_of(sending.event)
    return plant.origin or plant.name


# Events of the robot

#: Ends of a goal that the robot chooses.
_ENDS = {"succeeded": GoalOutcome.SUCCEEDED, "aborted": GoalOutcome.ABORTED, "canceled": GoalOutcome.CANCELED}


@dataclass(frozen=True)
class RobotEvent:
    """Event of the robot that a script or a tool can cause: its name, the shape of its data, and its effect.

    `cause` gets converted data in the event loop's thread. It returns why the event is impossible now, else None.
    """

    name: str
    shape: Fields
    cause: Callable[[Mapping[str, Any]], str | None]


def robot_events(node: DryNode, graph: rosgraph.RosGraph, types: RosTypes) -> dict[str, RobotEvent]:
    """Return the events of the robot by name: a message, `Lamp.light.response`, `Base.go.feedback`, and ends of goals.

    Raises UnknownTypeError.
    """
    robot, messages, shapes = node.robot, Messages(node), Shapes(types.distribution(2))
    known: dict[str, RobotEvent] = {}

    def add(
        name: str, interface: rosgraph.Interface, section: Section, effect: Callable[[Message], str | None]
    ) -> None:
        def cause(data: Mapping[str, Any]) -> str | None:
            return effect(messages.create(interface, section, data))

        try:
            known[name] = RobotEvent(name, shapes.of(interface.package, interface.type, section, None, ""), cause)
        except DefinitionError as error:
            raise UnknownTypeError(f"{name}: {error}") from None

    for subscription in graph.subscriptions:
        plant = plant_of(subscription.receptions[0].event)
        add(plant.origin or plant.name, subscription.interface, Section.MESSAGE, partial(_receive, robot, subscription))
    for service in graph.serviceClients:
        add(
            f"{_name(service.request)}.response", service.interface, Section.RESPONSE, partial(_respond, robot, service)
        )
    for action in graph.actionClients:
        name = _name(action.request)
        add(f"{name}.feedback", action.interface, Section.FEEDBACK, partial(_feed_back, robot, action))
        for word, outcome in _ENDS.items():
            add(f"{name}.{word}", action.interface, Section.RESULT, partial(_end, robot, action, outcome))
    return known


def _receive(robot: DryRobot, subscription: rosgraph.Subscription, message: Message) -> None:
    robot.receivers[subscription](message)


def _respond(robot: DryRobot, service: rosgraph.ServiceClient, response: Message) -> None:
    robot.responses[service] = response


def _feed_back(robot: DryRobot, action: rosgraph.ActionClient, feedback: Message) -> str | None:
    goal = robot.goals.get(action)
    if goal is None or not goal.runs:
        return "no goal runs"
    goal.handlers.feedback(feedback)
    return None


def _end(robot: DryRobot, action: rosgraph.ActionClient, outcome: GoalOutcome, result: Message) -> str | None:
    goal = robot.goals.get(action)
    if goal is None or not goal.runs:
        return "no goal runs"
    goal.end(outcome, result)
    return None


# Scripts


class ScriptError(Exception):
    """Faults of a script; the message has a line for each."""


@dataclass(frozen=True)
class Step:
    """Step of a script: seconds after the start, the event, its data, and seconds between repetitions or None."""

    time: float
    event: RobotEvent
    data: Mapping[str, Any]
    every: float | None


def read_script(path: str, events: Mapping[str, RobotEvent]) -> list[Step]:
    """Return the steps of a script, `{"after": 0.5, "event": "Lidar.scan", "data": {...}}` a line.

    `after` counts in seconds from the step before. With `every`, the step repeats after so many seconds, until a later
    step with the same event. Raises ScriptError and OSError.
    """
    seconds, pause = Number(0, 86_400, "d"), Number(0.01, 86_400, "d")
    words = {"after": seconds, "every": pause, "event": Choice(tuple(events)), "data": Anything()}
    shape, steps, faults, now = Fields(words, ("event",)), list[Step](), list[str](), 0.0
    for number, line in enumerate(read(path).decode("utf-8", errors="replace").splitlines(), 1):
        if not line.strip():
            continue
        try:
            entry = json_value(line)
        except JsonError as error:
            faults.append(f"{path}:{number}: {error}")
            continue
        wrong = faults_of(shape, entry)
        if not wrong:
            event, data = events[entry["event"]], entry.get("data", {})
            wrong = faults_of(event.shape, data)
            now += entry.get("after", 0)
            steps.append(Step(now, event, {} if wrong else event.shape.converted(data), entry.get("every")))
        faults += [f"{path}:{number}: {fault}" for fault in wrong]
    if faults:
        raise ScriptError("\n".join(faults))
    return steps


def play(node: DryNode, steps: Sequence[Step]) -> None:
    """Plan the steps of a script; call this in the event loop's thread."""
    repetitions: dict[str, Timer] = {}

    def begin(step: Step) -> None:
        if (repetition := repetitions.pop(step.event.name, None)) is not None:
            repetition.cancel()
        happen(step)

    def happen(step: Step) -> None:
        if step.every is not None:
            repetitions[step.event.name] = node.event_loop.call_later(step.every, partial(happen, step))
        trouble = step.event.cause(step.data)
        if trouble is not None:
            node.warn(f"{step.event.name} is impossible: {trouble}")

    for step in steps:
        node.event_loop.call_later(step.time, partial(begin, step))
