"""The supervisory layer as a node of ROS 1: topics, services and the topics of actions."""

from __future__ import annotations

from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

from robosc.runtime.core.clients import Answers, ServiceClient
from robosc.runtime.core.layer import hearing, passing
from robosc.runtime.ros1.node import Ros1Node
from robosc.semantics.naming import below_layer

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.metamodel import rosgraph
    from robosc.runtime.core.layer import Layer
    from robosc.runtime.core.port import Message
    from robosc.runtime.core.settings import Settings

_DEPTH = 10
_LOOK = 0.05
_CANCELLED = (GoalStatus.PREEMPTED, GoalStatus.RECALLED)
_UNDER_WAY = (GoalStatus.PENDING, GoalStatus.ACTIVE, GoalStatus.PREEMPTING, GoalStatus.RECALLING)


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

    def hear(self, name: str, kind: Any, act: Callable[[Message], None], most: int | None = _DEPTH) -> Any:
        """Subscribes; what comes is dealt with by the thread that works."""

        def post(message: Message) -> None:
            self.agenda.post(lambda: act(message), None if most is None else name, most or 0)

        return rospy.Subscriber(name, kind, post, queue_size=most, tcp_nodelay=True)


def _publisher(name: str, kind: Any, *, latch: bool = False) -> Any:
    return rospy.Publisher(name, kind, queue_size=_DEPTH, latch=latch, tcp_nodelay=True)


def _inside(name: str) -> str:
    """The name for the controller, as ROS 1 writes private names."""
    return f"~{below_layer(name)}"


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

    def __init__(self, message: Message) -> None:
        self.message = message
        self.identifier: str = message.goal_id.id
        self.status = GoalStatus(goal_id=message.goal_id, status=GoalStatus.PENDING)
        self.sent = self.accepted = self.cancelled = self.refused = False
        #: What the controller has asked to cancel before the goal was sent.
        self.cancels: list[Message] = []


class _ActionProxy:
    """An action for the controller behind which stands the robot's one: its five topics."""

    def __init__(self, port: Ros1Layer, kind: Any, action: rosgraph.ActionClient, layer: Layer, timeout: float) -> None:
        self._port = port
        self._action = action
        self._layer = layer
        self._timeout = timeout
        self._goal: _Running | None = None
        self._ended = ""
        self._deadline = 0.0
        made = kind()
        goal, result, feedback = (type(each) for each in (made.action_goal, made.action_result, made.action_feedback))
        self._result_type = result
        inside, outside = _inside(action.identifier), action.identifier
        self._goals = _publisher(f"{outside}/goal", goal)
        self._cancels = _publisher(f"{outside}/cancel", GoalID)
        self._results = _publisher(f"{inside}/result", result)
        self._feedback = _publisher(f"{inside}/feedback", feedback)
        self._statuses = _publisher(f"{inside}/status", GoalStatusArray)
        self._heard = port.hear(f"{outside}/result", result, self._on_result, None)
        port.hear(f"{outside}/feedback", feedback, self._on_feedback)
        port.hear(f"{outside}/status", GoalStatusArray, self._on_status)
        port.hear(f"{inside}/goal", goal, self._on_goal, None)
        port.hear(f"{inside}/cancel", GoalID, self._on_cancel, None)

    def cancel(self) -> None:
        """Cancels the goal at hand, before the robot has accepted it as soon as it does."""
        goal = self._goal
        if goal is not None and not goal.cancelled:
            goal.cancelled = True
            if goal.accepted:
                self._send_cancel(goal)

    # From the controller

    def _on_goal(self, message: Message) -> None:
        if self._goal is not None:
            self._layer.turn_away(self._action.request)
            self._end(message.goal_id, GoalStatus.REJECTED, "blocked: another goal has not ended")
            return
        if not message.goal_id.id:
            # The server would name it, and the layer would not know it again.
            message.goal_id.id = f"{rospy.get_name()}-{rospy.get_time()}"
        self._goal = _Running(message)
        if self._layer.passes(self._action.request):
            self._deadline = self._port.agenda.clock() + self._timeout
            self._look(self._goal)
        else:
            self._goal = None
            self._end(message.goal_id, GoalStatus.REJECTED, "blocked by the supervisor")

    def _on_cancel(self, message: Message) -> None:
        """The controller's own requests always pass."""
        if self._goal is not None and not self._goal.sent:
            self._goal.cancels.append(message)
        else:
            self._cancels.publish(message)

    # From the robot

    def _on_feedback(self, message: Message) -> None:
        goal = self._at_hand(message.status)
        if goal is not None:
            if not goal.cancelled:
                self._layer.feed_back(self._action, message.feedback)
            self._feedback.publish(message)

    def _on_result(self, message: Message) -> None:
        goal, status = self._at_hand(message.status), message.status.status
        if goal is None:
            return
        if not goal.cancelled:
            if status == GoalStatus.SUCCEEDED:
                self._layer.respond(self._action, message.result)
            else:
                rejected = "rejected" if status == GoalStatus.REJECTED else "aborted"
                self._layer.fail(self._action, "cancelled" if status in _CANCELLED else rejected)
        self._finish(goal)
        self._results.publish(message)

    def _on_status(self, message: Message) -> None:
        """That a goal has ended is told with its result, not before: the supervisor knows first."""
        told = GoalStatusArray(header=message.header)
        told.status_list = [each for each in message.status_list if each.goal_id.id == self._ended]
        mine = [each for each in message.status_list if self._at_hand(each)]
        goal = self._goal
        for each in mine:
            assert goal is not None
            goal.status.text = each.text
            if each.status in _UNDER_WAY:
                goal.status.status = each.status
            if each.status not in (GoalStatus.PENDING, GoalStatus.RECALLING, GoalStatus.REJECTED):
                self._accept(goal)
        if goal is not None and (mine or not goal.accepted):
            told.status_list.append(goal.status)  # one that the robot has not heard of yet is not lost
        self._statuses.publish(told)

    def _at_hand(self, status: GoalStatus) -> _Running | None:
        """The goal at hand, if that is the one."""
        goal = self._goal
        return goal if goal is not None and goal.identifier == status.goal_id.id else None

    # Waiting

    def _look(self, goal: _Running) -> None:
        """Sends the goal as soon as there is a server; then watches that it is accepted and stays."""
        if self._goal is not goal:
            return
        now = self._port.agenda.clock()
        ends: tuple[Any, ...] = (self._goals, self._cancels, self._heard)
        served = all(each.get_num_connections() > 0 for each in ends)
        if goal.cancelled and not goal.sent:
            self._give_up(goal, "cancelled before it was sent")
        elif served and not goal.sent:
            goal.sent = True
            for publisher, message in [(self._goals, goal.message), *((self._cancels, each) for each in goal.cancels)]:
                publisher.publish(message)
        elif served and goal.accepted:
            if not goal.cancelled:
                self._deadline = now + self._timeout
            elif now >= self._deadline and not goal.refused and goal.status.status == GoalStatus.ACTIVE:
                goal.refused = True
                self._port.warn(f"{self._action.identifier}: the server refuses to cancel the goal")
        elif now >= self._deadline:
            within = f" within {round(self._timeout * 1000)} ms"
            missing = ("not accepted" if goal.sent else "no server") + within
            self._give_up(goal, "the server is gone" if goal.accepted else missing)
        if self._goal is goal:
            self._port.agenda.after(_LOOK, lambda: self._look(goal))

    def _accept(self, goal: _Running) -> None:
        if not goal.accepted:
            goal.accepted = True
            self._deadline = self._port.agenda.clock() + self._timeout
            if goal.cancelled:
                self._send_cancel(goal)

    def _send_cancel(self, goal: _Running) -> None:
        self._deadline = self._port.agenda.clock() + self._timeout
        self._cancels.publish(GoalID(id=goal.identifier))  # without a time, which would cancel other goals, too

    def _give_up(self, goal: _Running, why: str) -> None:
        """Nobody waits for the goal any more: a robot that has it, or gets it yet, is told to cancel it."""
        if goal.sent:
            self._cancels.publish(GoalID(id=goal.identifier))
        if not goal.cancelled:
            self._layer.fail(self._action, why)
        self._finish(goal)
        self._end(goal.message.goal_id, GoalStatus.ABORTED if goal.accepted else GoalStatus.REJECTED, why)

    def _finish(self, goal: _Running) -> None:
        self._goal, self._ended = None, goal.identifier

    def _end(self, identifier: GoalID, status: int, text: str) -> None:
        """Tells the controller of the end of a goal that the robot says nothing of."""
        message = self._result_type(status=GoalStatus(goal_id=identifier, status=status, text=text))
        message.header.stamp = rospy.Time.now()
        self._results.publish(message)
