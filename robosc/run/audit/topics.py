"""Topics of a recording as the events and commands of a robot: messages, and the parts of services and actions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import OrderedDict
from typing import TYPE_CHECKING, Any

from robosc.base.recordings.decoding import DecodingError, flat
from robosc.base.ros_types import Section
from robosc.run.audit.findings import SECOND
from robosc.run.runtime.core.port import Failure, GoalOutcome

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from robosc.base.recordings import Channel
    from robosc.model import rosgraph
    from robosc.run.audit.judge import Judge
    from robosc.run.audit.port import RecordingPort
    from robosc.run.runtime.core.event_loop import Timer
    from robosc.run.runtime.core.port import Message, Server

#: Maximum number of calls and goals that are remembered.
_MOST = 1000
#: Values of `event_type` in `service_msgs/ServiceEventInfo`.
_REQUESTS, _RESPONSES = (0, 1), (2, 3)
#: Values of `status` in ROS 2's `action_msgs/GoalStatus`, and in ROS 1's `actionlib_msgs/GoalStatus`.
_ACTIVE, _CANCELING = (1, 2, 3), 3
_ENDS = {4: GoalOutcome.SUCCEEDED, 5: GoalOutcome.CANCELED, 6: GoalOutcome.ABORTED}
_ROS_1_ENDS = {
    2: GoalOutcome.CANCELED,
    3: GoalOutcome.SUCCEEDED,
    4: GoalOutcome.ABORTED,
    8: GoalOutcome.CANCELED,
    9: GoalOutcome.LOST,
}
_ROS_1_REJECTED = 5


class Part(ABC):
    """A communication of the model, with the topics that show it."""

    def __init__(self, judge: Judge, port: RecordingPort, name: str) -> None:
        self.judge = judge
        self.port = port
        self.name = name
        #: Topics that were seen.
        self.seen: set[str] = set()

    @abstractmethod
    def topics(self) -> dict[str, tuple[str, Callable[[Message], None]]]:
        """Return the type and the handler of each topic."""

    @abstractmethod
    def unseen(self, ros: int) -> Iterator[tuple[str, str]]:
        """Yield the names that a recording of ROS 1 or 2 did not show, with the reason."""


class Heard(Part):
    """A topic of the robot."""

    def __init__(self, judge: Judge, port: RecordingPort, name: str, subscription: rosgraph.Subscription) -> None:
        super().__init__(judge, port, name)
        self._subscription = subscription

    def topics(self) -> dict[str, tuple[str, Callable[[Message], None]]]:
        """Return the topic."""
        kind = _type_of(self._subscription.interface)
        return {self.name: (kind, lambda message: self.judge.receive(self._subscription, message))}

    def unseen(self, ros: int) -> Iterator[tuple[str, str]]:  # noqa: ARG002
        """Yield the topic if it has no message."""
        if not self.seen:
            yield self.name, "the recording has no message of this topic"


class Sent(Part):
    """A topic of commands."""

    def __init__(self, judge: Judge, port: RecordingPort, name: str, publisher: rosgraph.Publisher) -> None:
        super().__init__(judge, port, name)
        self._publisher = publisher

    def topics(self) -> dict[str, tuple[str, Callable[[Message], None]]]:
        """Return the topic."""
        return {self.name: (_type_of(self._publisher.interface), self._command)}

    def _command(self, message: Message) -> None:
        self.judge.command(list(self._publisher.sendings), message)

    def unseen(self, ros: int) -> Iterator[tuple[str, str]]:  # noqa: ARG002
        """Yield the topic if it has no message."""
        if not self.seen:
            yield self.name, "the recording has no message of this topic"


class Service(Part):
    """A service of the robot, as service introspection of ROS 2 shows it. `timeout` in seconds."""

    def __init__(
        self, judge: Judge, port: RecordingPort, name: str, client: rosgraph.ServiceClient, timeout: float
    ) -> None:
        super().__init__(judge, port, name)
        self._client = client
        self._timeout = timeout
        self._known: OrderedDict[tuple[object, ...], None] = OrderedDict()
        self._open: tuple[object, ...] | None = None
        self._deadline: Timer | None = None
        self._late: set[tuple[object, ...]] = set()

    def topics(self) -> dict[str, tuple[str, Callable[[Message], None]]]:
        """Return the topic of introspection."""
        interface = self._client.interface
        return {f"{self.name}/_service_event": (f"{interface.package}/msg/{interface.type}_Event", self._event)}

    def unseen(self, ros: int) -> Iterator[tuple[str, str]]:
        """Yield the service if its calls were not recorded."""
        if ros == 1:
            yield self.name, "bags of ROS 1 have no calls of services"
        elif not self.seen:
            yield (
                self.name,
                f"its calls are in a recording only with service introspection, on {self.name}/_service_event",
            )

    def _event(self, message: Message) -> None:
        info = message.info
        is_request = info.event_type in _REQUESTS
        call = (bytes(info.client_gid), int(info.sequence_number))
        if not _is_new(self._known, (is_request, *call)):
            return  # client and server report the same
        if is_request:
            request = message.request[0] if len(message.request) else None
            self.judge.command(
                [self._client.request],
                request,
                lambda happens: self._begin(call) if happens else None,
                is_known=request is not None,
            )
            return
        self.judge.decide()
        if call in self._late:
            self._late.remove(call)
        else:
            self._end()
            response = message.response[0] if len(message.response) else None
            if response is None:
                response = self.port.create(self._client.interface, Section.RESPONSE)
            self.judge.respond(self._client, response)

    def _begin(self, call: tuple[object, ...]) -> None:
        self._open = call
        self._deadline = self.judge.call_later(self._timeout, lambda: self._expire(call))

    def _end(self) -> None:
        self._open = None
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _expire(self, call: tuple[object, ...]) -> None:
        if self._open == call:
            self._open = None
            self._late.add(call)
            self.judge.fail(self._client, Failure.TIMEOUT, "no answer")


class _Goals(Part):
    """Goals of an action. The model knows one at a time: the `present` one."""

    def __init__(self, judge: Judge, port: RecordingPort, name: str, client: rosgraph.ActionClient) -> None:
        super().__init__(judge, port, name)
        self._client = client
        self._present: bytes | str | None = None
        #: Goals that have begun, each with whether it has ended.
        self._ended: OrderedDict[bytes | str, bool] = OrderedDict()

    def _begin(self, goal: bytes | str, request: Message) -> None:
        """Judge the request of a goal, once."""
        if goal in self._ended:
            return
        _is_new(self._ended, goal)
        self._ended[goal] = False

        def done(happens: bool) -> None:
            if happens:
                self._present = goal

        self.judge.command([self._client.request], request, done, is_known=request is not None)

    def _finish(self, goal: bytes | str, outcome: GoalOutcome | None, result: Message) -> None:
        """Note the end of a goal; None for a goal that was rejected."""
        self.judge.decide()
        if self._ended.get(goal):
            return
        _is_new(self._ended, goal)
        self._ended[goal] = True
        if goal != self._present:
            return
        self._present = None
        match outcome:
            case GoalOutcome.SUCCEEDED:
                if result is None:
                    result = self.port.create(self._client.interface, Section.RESULT)
                self.judge.respond(self._client, result)
            case GoalOutcome.CANCELED:
                self.judge.end_canceled(self._client, Failure.CANCELED, "canceled", result)
            case GoalOutcome.ABORTED:
                self.judge.fail(self._client, Failure.ABORTED, "aborted", result)
            case GoalOutcome.LOST:
                self.judge.fail(self._client, Failure.LOST, "lost", result)
            case None:
                self.judge.fail(self._client, Failure.REJECTED, "rejected")
        # A newer goal may have replaced this one.
        active = next((known for known, ended in reversed(self._ended.items()) if not ended), None)
        if active is not None:
            self.judge.adopt(self._client)
            self._present = active

    def _feed_back(self, goal: bytes | str, feedback: Message) -> None:
        if goal not in self._ended:
            self._begin(goal, None)
        self.judge.decide()
        if goal == self._present:
            self.judge.feed_back(self._client, feedback)
        elif self._ended[goal]:
            self.judge.unexpected(self._client.feedback.event, "the goal has ended")

    def _cancel(self) -> None:
        self.judge.decide()
        self.judge.cancel(self._client)


class Ros2Action(_Goals):
    """An action of ROS 2: its status and feedback, and what action introspection shows."""

    def __init__(self, judge: Judge, port: RecordingPort, name: str, client: rosgraph.ActionClient) -> None:
        super().__init__(judge, port, name, client)
        self._is_first = True
        #: Goal of each request for a goal or a result, by the call.
        self._calls: OrderedDict[tuple[object, ...], bytes] = OrderedDict()
        #: Goals whose result is requested, so that it comes with its data.
        self._awaited: OrderedDict[bytes, Any] = OrderedDict()

    def topics(self) -> dict[str, tuple[str, Callable[[Message], None]]]:
        """Return the topics of the action."""
        start = f"{self._client.interface.package}/msg/{self._client.interface.type}"
        return {
            f"{self.name}/_action/status": ("action_msgs/msg/GoalStatusArray", self._status),
            f"{self.name}/_action/feedback": (f"{start}_FeedbackMessage", self._feedback),
            f"{self.name}/_action/send_goal/_service_event": (f"{start}_SendGoal_Event", self._send_goal),
            f"{self.name}/_action/get_result/_service_event": (f"{start}_GetResult_Event", self._get_result),
        }

    def unseen(self, ros: int) -> Iterator[tuple[str, str]]:  # noqa: ARG002
        """Yield the parts of the action that were not recorded."""
        action = f"{self.name}/_action"
        if f"{action}/status" not in self.seen:
            why = "goals and their ends are hidden topics: record them with --include-hidden-topics"
            yield f"{action}/status", why
        if f"{action}/send_goal/_service_event" not in self.seen:
            why = "without action introspection, a goal counts from its acceptance on, and its data is unknown"
            yield f"{action}/send_goal", why
        if f"{action}/get_result/_service_event" not in self.seen:
            yield f"{action}/get_result", "without action introspection, results have the defaults of ROS"

    def _status(self, message: Message) -> None:
        for entry in message.status_list:
            goal, status = bytes(entry.goal_info.goal_id.uuid), int(entry.status)
            if self._is_first and goal not in self._ended and not self._began_here(entry.goal_info.stamp):
                self._ended[goal] = status in _ENDS
                if status in _ACTIVE:
                    self._present = goal
                    self.judge.adopt(self._client)
            elif status in _ACTIVE or status in _ENDS:
                self._begin(goal, None)
            if status == _CANCELING and goal == self._present:
                self._cancel()
            if status in _ENDS and goal not in self._awaited:
                self._finish(goal, _ENDS[status], None)
        self._is_first = False

    def _began_here(self, stamp: Message) -> bool:
        """Return whether a goal was accepted since the start of the recording, by the clock of its server."""
        accepted, start = int(stamp.sec) * SECOND + int(stamp.nanosec), self.judge.audit.start
        return start is not None and start < accepted <= self.judge.time

    def _feedback(self, message: Message) -> None:
        goal = bytes(message.goal_id.uuid)
        # Only a status shows whether the goal began before the recording.
        if goal in self._ended or not self._is_first:
            self._feed_back(goal, message.feedback)

    def _send_goal(self, message: Message) -> None:
        call = _call(message)
        if len(message.request) and message.info.event_type in _REQUESTS:
            request = message.request[0]
            goal = bytes(request.goal_id.uuid)
            self._is_first = False
            _is_new(self._calls, call)
            self._calls[call] = goal
            self._begin(goal, request.goal)
        elif len(message.response) and call in self._calls and not message.response[0].accepted:
            self._finish(self._calls[call], None, None)

    def _get_result(self, message: Message) -> None:
        call = ("result", *_call(message))
        if len(message.request):
            goal = bytes(message.request[0].goal_id.uuid)
            _is_new(self._awaited, goal)
            _is_new(self._calls, call)
            self._calls[call] = goal
        elif len(message.response) and call in self._calls:
            response = message.response[0]
            outcome = _ENDS.get(int(response.status))
            if outcome is not None:
                self._finish(self._calls[call], outcome, response.result)


class Ros1Action(_Goals):
    """An action of ROS 1: all of it are topics."""

    def topics(self) -> dict[str, tuple[str, Callable[[Message], None]]]:
        """Return the topics of the action."""
        start = f"{self._client.interface.package}/msg/{self._client.interface.type}Action"
        return {
            f"{self.name}/goal": (f"{start}Goal", lambda message: self._begin(message.goal_id.id, message.goal)),
            f"{self.name}/cancel": ("actionlib_msgs/msg/GoalID", lambda _: self._cancel()),
            f"{self.name}/feedback": (
                f"{start}Feedback",
                lambda message: self._feed_back(message.status.goal_id.id, message.feedback),
            ),
            f"{self.name}/result": (f"{start}Result", self._result),
        }

    def unseen(self, ros: int) -> Iterator[tuple[str, str]]:  # noqa: ARG002
        """Yield the topics that have no message."""
        for topic in (f"{self.name}/goal", f"{self.name}/result"):
            if topic not in self.seen:
                yield topic, "the recording has no message of this topic"

    def _result(self, message: Message) -> None:
        status = int(message.status.status)
        if status in _ROS_1_ENDS or status == _ROS_1_REJECTED:
            self._finish(message.status.goal_id.id, _ROS_1_ENDS.get(status), message.result)


class Topics:
    """The topics of a robot's graph in a recording. `resolve` returns the name of a topic, service or action there.

    `service_timeout` is in seconds.
    """

    def __init__(
        self,
        judge: Judge,
        port: RecordingPort,
        graph: rosgraph.RosGraph,
        resolve: Callable[[str], str],
        service_timeout: float,
    ) -> None:
        self._judge = judge
        self._port = port
        self._graph = graph
        self._by_version: dict[int, list[Part]] = {}
        both: list[Part] = [
            *(Sent(judge, port, resolve(sent.topic), sent) for sent in graph.publishers),
            *(Heard(judge, port, resolve(heard.topic), heard) for heard in graph.subscriptions),
            *(
                Service(judge, port, resolve(client.identifier), client, service_timeout)
                for client in graph.serviceClients
            ),
        ]
        for ros, kind in ((1, Ros1Action), (2, Ros2Action)):
            actions = [kind(judge, port, resolve(client.identifier), client) for client in graph.actionClients]
            self._by_version[ros] = [*both, *actions]
        #: Parts of each topic, with its type and handler. A controller may listen to its own commands.
        self._handlers: dict[int, dict[str, list[tuple[Part, str, Callable[[Message], None]]]]] = {}
        for ros, parts in self._by_version.items():
            handlers = self._handlers[ros] = {}
            for part in parts:
                for topic, described in part.topics().items():
                    handlers.setdefault(topic, []).append((part, *described))
        servers: list[Server] = [*graph.serviceServers, *graph.actionServers]
        self._served = [resolve(server.identifier) for server in servers]
        self._other_types: dict[str, str] = {}
        #: Number of messages of a topic that cannot be decoded, with the first reason.
        self._broken: dict[str, tuple[int, str]] = {}
        self.names = {topic for handlers in self._handlers.values() for topic in handlers}

    def handler(self, channel: Channel) -> Callable[[bytes], None] | None:
        """Return the function that handles a message of a channel; None if the model has no such topic, or type."""
        known = self._handlers[channel.ros].get(channel.topic, [])
        fitting = [(part, handle) for part, kind, handle in known if flat(channel.type) == kind]
        if len(fitting) < len(known):
            kinds = " and ".join(dict.fromkeys(kind for _, kind, _ in known))
            self._other_types[channel.topic] = f"it has the type {channel.type}, the model expects {kinds}"
        if not fitting:
            return None
        decode, port, judge, topic = channel.decode, self._port, self._judge, channel.topic

        def read(data: bytes) -> None:
            try:
                message = decode(data)
            except DecodingError as error:
                count, why = self._broken.get(topic, (0, str(error)))
                self._broken[topic] = count + 1, why
                return
            for part, handle in fitting:
                part.seen.add(topic)
                port.recorded_types = decode.wire_types
                judge.topic = topic
                handle(message)

        return read

    def unseen(self, ros: int) -> dict[str, str]:
        """Return the names that a recording of ROS 1 or 2 did not show, each with the reason."""
        names = dict(pair for part in self._by_version[ros] for pair in part.unseen(ros))
        served = dict.fromkeys(self._served, "communications that the controller serves are not judged")
        broken = {topic: f"{count} messages cannot be decoded: {why}" for topic, (count, why) in self._broken.items()}
        return names | self._other_types | broken | served


def _type_of(interface: rosgraph.Interface) -> str:
    return f"{interface.package}/msg/{interface.type}"


def _call(message: Message) -> tuple[object, ...]:
    return bytes(message.info.client_gid), int(message.info.sequence_number)


def _is_new(known: OrderedDict[Any, Any], key: Any) -> bool:
    """Add a key unless it is known; forget the oldest of many. Return whether it is new."""
    if key in known:
        return False
    known[key] = None
    if len(known) > _MOST:
        known.popitem(last=False)
    return True
