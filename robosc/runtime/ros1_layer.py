"""The supervisory layer as a node of ROS 1: topics, services and the topics of actions."""

from __future__ import annotations

import copy
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

from robosc.runtime.clients import Answers, ServiceClient
from robosc.runtime.layer import below_layer, hearing, passing
from robosc.runtime.ros1 import Ros1Node

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.metamodel import rosgraph
    from robosc.runtime.layer import Layer
    from robosc.runtime.port import Message
    from robosc.runtime.settings import Settings

_DEPTH = 10
_LOOK = 0.05
_CANCELLED = (GoalStatus.PREEMPTED, GoalStatus.RECALLED)


class Ros1Layer(Ros1Node):
    """The node of a layer."""

    def connect(self, layer: Layer, settings: Settings) -> None:
        """Stands between the controller and the robot from now on."""
        for topic in self._graph.subscriptions:
            self._relay(topic, topic.topic, _inside(topic.topic), hearing(layer, topic))
        for publisher in self._graph.publishers:
            (sending,) = publisher.sendings
            self._relay(publisher, _inside(publisher.topic), publisher.topic, passing(layer, sending))
        for service in self._graph.serviceClients:
            kind = self._types[service.interface]
            self._clients[service] = rospy.ServiceProxy(service.identifier, kind)
            _ServiceProxy(self, kind, service, layer, settings.seconds("service_timeout_ms"))
        for action in self._graph.actionClients:
            proxy = _ActionProxy(
                self, self._types[action.interface]["Action"], action, layer, settings.seconds("action_timeout_ms")
            )
            layer.cancels[action.cancel] = proxy.cancel

    def _relay(
        self,
        element: rosgraph.Subscription | rosgraph.Publisher,
        source: str,
        target: str,
        passes: Callable[[Message], bool],
    ) -> None:
        kind = self._types[element.interface]
        publishers: dict[bool, Any] = {}

        def forward(message: Message) -> None:
            if passes(message):
                latched = message._connection_header.get("latching") == "1"  # noqa: SLF001  # as genpy has it
                if latched not in publishers:
                    publishers[latched] = _publisher(target, kind, latch=latched)
                publishers[latched].publish(message)

        # Advertised before the first message, so that those who listen are connected when it comes.
        publishers[False] = _publisher(target, kind)
        self.hear(source, kind, forward)

    def hear(self, name: str, kind: Any, act: Callable[[Message], None], most: int | None = _DEPTH) -> None:
        """Subscribes; what comes is dealt with by the thread that works."""

        def post(message: Message) -> None:
            self.agenda.post(lambda: act(message), None if most is None else name, most or 0)

        rospy.Subscriber(name, kind, post, queue_size=most, tcp_nodelay=True)


def _publisher(name: str, kind: Any, *, latch: bool = False) -> Any:
    return rospy.Publisher(name, kind, queue_size=_DEPTH, latch=latch, tcp_nodelay=True)


def _inside(name: str) -> str:
    """The name for the controller, as ROS 1 writes private names."""
    return below_layer(name).replace("~/", "~")


class _ServiceProxy:
    """A service for the controller behind which stands the robot's one; who calls it waits on a thread of rospy's."""

    def __init__(
        self, port: Ros1Layer, kind: Any, service: rosgraph.ServiceClient, layer: Layer, timeout: float
    ) -> None:
        self._service = service
        self._layer = layer
        self._agenda = port.agenda
        self._waiting: Future[Any] | None = None
        self._client = ServiceClient(port, port.agenda, service, timeout, Answers(self._answered, self._failed))
        rospy.Service(_inside(service.identifier), kind, self._called)

    def _called(self, request: Message) -> Message:
        answer: Future[Any] = Future()
        self._agenda.post(lambda: self._asked(request, answer))
        return answer.result()  # an exception becomes the service's error

    def _asked(self, request: Message, answer: Future[Any]) -> None:
        if self._waiting is not None:
            self._layer.turn_away(self._service.request)
            answer.set_exception(rospy.ServiceException("blocked: another call waits"))
        elif not self._layer.passes(self._service.request):
            answer.set_exception(rospy.ServiceException("blocked by the supervisor"))
        else:
            self._waiting = answer
            self._client.call(request)

    def _answered(self, response: Message) -> None:
        self._layer.respond(self._service, response)
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.set_result(response)

    def _failed(self, why: str) -> None:
        self._layer.fail(self._service, why)
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.set_exception(rospy.ServiceException(why))


class _Running:
    """The goal at hand."""

    def __init__(self, identifier: str) -> None:
        self.identifier = identifier
        self.accepted = self.cancelled = False


class _ActionProxy:
    """An action for the controller behind which stands the robot's one: its five topics."""

    def __init__(self, port: Ros1Layer, kind: Any, action: rosgraph.ActionClient, layer: Layer, timeout: float) -> None:
        self._port = port
        self._action = action
        self._layer = layer
        self._timeout = timeout
        self._goal: _Running | None = None
        self._deadline = 0.0
        self._blocked: list[GoalStatus] = []
        made = kind()
        goal, result, feedback = (type(each) for each in (made.action_goal, made.action_result, made.action_feedback))
        self._result_type = result
        inside, outside = _inside(action.identifier), action.identifier
        self._goals = _publisher(f"{outside}/goal", goal)
        self._cancels = _publisher(f"{outside}/cancel", GoalID)
        self._results = _publisher(f"{inside}/result", result)
        self._feedback = _publisher(f"{inside}/feedback", feedback)
        self._statuses = _publisher(f"{inside}/status", GoalStatusArray)
        port.hear(f"{outside}/result", result, self._on_result, None)
        port.hear(f"{outside}/feedback", feedback, self._on_feedback)
        port.hear(f"{outside}/status", GoalStatusArray, self._on_status)
        port.hear(f"{inside}/goal", goal, self._on_goal, None)
        port.hear(f"{inside}/cancel", GoalID, self._on_cancel, None)

    def cancel(self) -> None:
        """Cancels the goal at hand."""
        goal = self._goal
        if goal is not None and not goal.cancelled:
            goal.cancelled = True
            self._cancels.publish(GoalID(id=goal.identifier))

    # From the controller

    def _on_goal(self, message: Message) -> None:
        if not message.goal_id.id:
            message.goal_id.id = f"{rospy.get_name()}-{rospy.get_time()}"
        if self._goal is not None:
            self._layer.turn_away(self._action.request)
            self._end(message.goal_id, GoalStatus.REJECTED, "blocked: another goal has not ended")
        elif self._layer.passes(self._action.request):
            self._goal = _Running(message.goal_id.id)
            self._deadline = self._port.agenda.clock() + self._timeout
            self._look(self._goal, message)
        else:
            self._end(message.goal_id, GoalStatus.REJECTED, "blocked by the supervisor")

    def _on_cancel(self, message: Message) -> None:
        """The controller's own requests always pass."""
        self._cancels.publish(message)

    # From the robot

    def _on_feedback(self, message: Message) -> None:
        goal = self._goal
        if goal is not None and message.status.goal_id.id == goal.identifier:
            goal.accepted = True
            if not goal.cancelled:
                self._layer.feed_back(self._action, message.feedback)
        self._feedback.publish(message)

    def _on_result(self, message: Message) -> None:
        goal, status = self._goal, message.status.status
        if goal is not None and message.status.goal_id.id == goal.identifier:
            self._goal = None
            if not goal.cancelled:
                if status == GoalStatus.SUCCEEDED:
                    self._layer.respond(self._action, message.result)
                else:
                    rejected = "rejected" if status == GoalStatus.REJECTED else "aborted"
                    self._layer.fail(self._action, "cancelled by someone else" if status in _CANCELLED else rejected)
        self._results.publish(message)

    def _on_status(self, message: Message) -> None:
        """That a goal has ended is told with its result, not before: the supervisor knows first."""
        goal = self._goal
        told = copy.deepcopy(message)
        for each in told.status_list:
            if goal is not None and each.goal_id.id == goal.identifier:
                goal.accepted = goal.accepted or each.status not in (GoalStatus.PENDING, GoalStatus.RECALLING)
                if each.status in (GoalStatus.SUCCEEDED, GoalStatus.ABORTED, *_CANCELLED):
                    each.status = GoalStatus.ACTIVE
        told.status_list += self._blocked
        self._statuses.publish(told)

    # Waiting

    def _look(self, goal: _Running, message: Message | None) -> None:
        """Sends the goal as soon as there is a server; then watches that it is accepted and stays."""
        if self._goal is not goal:
            return
        now = self._port.agenda.clock()
        served = self._goals.get_num_connections() > 0
        if message is not None and served:
            self._goals.publish(message)
            message = None
        if goal.accepted and served:
            self._deadline = now + self._timeout
        if now >= self._deadline:
            self._goal = None
            within = f" within {round(self._timeout * 1000)} ms"
            why = "the server is gone" if goal.accepted else ("no server" if message else "not accepted") + within
            if not goal.cancelled:
                self._layer.fail(self._action, why)
            self._end(GoalID(id=goal.identifier), GoalStatus.ABORTED, why)
        else:
            self._port.agenda.after(_LOOK, lambda: self._look(goal, message))

    def _end(self, identifier: GoalID, status: int, text: str) -> None:
        """Tells the controller of the end of a goal that the robot says nothing of."""
        ended = GoalStatus(goal_id=identifier, status=status, text=text)
        self._blocked = [*self._blocked[-9:], ended]
        message = self._result_type(status=ended)
        message.header.stamp = rospy.Time.now()
        self._results.publish(message)
