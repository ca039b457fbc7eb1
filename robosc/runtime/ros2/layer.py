"""The supervisory layer as a node of ROS 2: topics, services and the parts of actions, one by one."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalStatus
from rclpy.clock import Clock, ClockType
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data

from robosc.runtime.core.clients import Answers, ServiceClient
from robosc.runtime.core.layer import hearing, passing
from robosc.runtime.ros2.node import Ros2Node
from robosc.semantics.naming import below_layer

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.metamodel import rosgraph
    from robosc.runtime.core.layer import Layer
    from robosc.runtime.core.port import Message
    from robosc.runtime.core.settings import Settings

_DEPTH = 10
_LOOK = 0.05
#: Seconds after its time for acceptance is over in which a goal may still be accepted; then it counts as lost.
_LOST = 30.0


class Ros2Layer(Ros2Node):
    """The node of a layer."""

    def connect(self, layer: Layer, settings: Settings) -> None:
        """Stands between the controller and the robot from now on."""
        for topic in self._graph.subscriptions:
            _Relay(self, self._route(topic, topic.topic, f"~/{below_layer(topic.topic)}"), hearing(layer, topic))
        for publisher in self._graph.publishers:
            (sending,) = publisher.sendings
            route = self._route(publisher, f"~/{below_layer(publisher.topic)}", publisher.topic)
            _Relay(self, route, passing(layer, sending))
        for service in self._graph.serviceClients:
            self._clients[service] = self._service_client(service)
            _ServiceProxy(self, self._types[service.interface], service, layer, settings.seconds("service_timeout_ms"))
        for action in self._graph.actionClients:
            timeout = settings.seconds("action_timeout_ms")
            proxy = _ActionProxy(self, self._types[action.interface], action, layer, timeout)
            layer.cancels[action.cancel] = proxy.cancel

    def _route(self, element: rosgraph.Subscription | rosgraph.Publisher, source: str, target: str) -> _Route:
        sensor = element.interface.package == "sensor_msgs"
        usual = QoSProfile(depth=_DEPTH)
        received = self._quality(element.topic, qos_profile_sensor_data if sensor else usual)
        # What is sent on is reliable, whatever is received.
        chosen = self._configuration.qos.get(element.topic.removeprefix("/"))
        sent = QoSProfile(depth=chosen.depth) if chosen and chosen.depth else usual
        return _Route(self._types[element.interface], source, target, received, sent)


@dataclass(frozen=True)
class _Route:
    """From one topic to another, each with its quality of service."""

    kind: Any
    source: str
    target: str
    received: Any
    sent: Any


class _Relay:
    """Takes messages from one topic to another where `passes` says so.

    What it publishes is reliable, and transient-local where all who publish the messages are.
    """

    def __init__(self, port: Ros2Layer, route: _Route, passes: Callable[[Any], bool]) -> None:
        self._port = port
        self._route = route
        self._passes = passes
        self._lasting = False
        self._subscription: Any = None
        self._publisher = port.node.create_publisher(route.kind, route.target, route.sent)
        # Publishers come and go whether simulated time passes or not.
        self._timer = port.node.create_timer(_LOOK, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._look()

    def _look(self) -> None:
        publishers = self._port.node.get_publishers_info_by_topic(
            self._port.node.resolve_topic_name(self._route.source)
        )
        lasting = all(each.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for each in publishers)
        if publishers and (self._subscription is None or lasting != self._lasting):
            self._open(lasting=lasting)

    def _open(self, *, lasting: bool) -> None:
        node, route = self._port.node, self._route
        if lasting != self._lasting:
            self._lasting = lasting
            node.destroy_publisher(self._publisher)
            self._publisher = node.create_publisher(route.kind, route.target, _durable(route.sent, lasting=lasting))
        if self._subscription is not None:
            node.destroy_subscription(self._subscription)
        quality = _durable(route.received, lasting=lasting)
        self._subscription = node.create_subscription(route.kind, route.source, self._forward, quality)

    def _forward(self, message: Message) -> None:
        if self._passes(message):
            self._publisher.publish(message)


def _durable(quality: Any, *, lasting: bool) -> Any:
    durability = DurabilityPolicy.TRANSIENT_LOCAL if lasting else DurabilityPolicy.VOLATILE
    return QoSProfile(depth=quality.depth, reliability=quality.reliability, durability=durability)


class _Answer:
    """The answer to one call of a service of ours, given now or later."""

    def __init__(self, response: Any) -> None:
        self.response = response
        self._send: Callable[[Any], None] | None = None
        self._given = False

    def give(self, response: Any = None) -> None:
        """Answers; with nothing, the response that nothing was set in."""
        self.response, self._given = response or self.response, True
        if self._send is not None:
            self._send(self.response)

    def ready_to(self, send: Callable[[Any], None]) -> None:
        """Who called is known now."""
        self._send = send
        if self._given:
            send(self.response)


def _serve(port: Ros2Layer, kind: Any, name: str, asked: Callable[[Any, _Answer], None]) -> None:
    """A service whose calls are answered when there is an answer; rclpy by itself answers as soon as it was asked."""
    under_way: list[_Answer] = []

    def ask(request: Any, response: Any) -> Any:
        under_way.append(_Answer(response))
        asked(request, under_way[-1])
        return response

    service = port.node.create_service(kind, name, ask)
    send = service.send_response
    service.send_response = lambda _, caller: under_way.pop().ready_to(lambda response: send(response, caller))


class _ServiceProxy:
    """A service for the controller behind which stands the robot's one."""

    def __init__(
        self, port: Ros2Layer, kind: Any, service: rosgraph.ServiceClient, layer: Layer, timeout: float
    ) -> None:
        self._service = service
        self._layer = layer
        self._waiting: _Answer | None = None
        self._client = ServiceClient(port, port.agenda, service, timeout, Answers(self._answered, self._failed))
        _serve(port, kind, f"~/{below_layer(service.identifier)}", self._asked)

    def _asked(self, request: Any, answer: _Answer) -> None:
        if self._waiting is not None:
            self._layer.turn_away(self._service.request)
            answer.give()
        elif not self._layer.passes(self._service.request):
            answer.give()
        else:
            self._waiting = answer
            self._client.call(request)

    def _answered(self, response: Any) -> None:
        self._layer.respond(self._service, response)
        self._finish(response)

    def _failed(self, why: str) -> None:
        self._layer.fail(self._service, why)
        self._finish(None)

    def _finish(self, response: Any) -> None:
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.give(response)


class _Running:
    """The goal at hand."""

    def __init__(self, identifier: bytes, answer: _Answer) -> None:
        self.identifier = identifier
        self.answer = answer
        self.sent = self.accepted = self.cancelled = False
        #: Of the request for its result.
        self.asked: Any = None
        self.waiting: list[_Answer] = []


class _ActionProxy:
    """An action for the controller behind which stands the robot's one, so that goals keep their identity."""

    def __init__(self, port: Ros2Layer, kind: Any, action: rosgraph.ActionClient, layer: Layer, timeout: float) -> None:
        self._port = port
        self._action = action
        self._layer = layer
        self._timeout = timeout
        self._goal: _Running | None = None
        self._ended: tuple[bytes, Any] | None = None
        self._deadline = 0.0
        self._statuses: Any = kind.Impl.GoalStatusMessage()
        self._types = kind.Impl
        inside, outside = f"~/{below_layer(action.identifier)}/_action", f"{action.identifier}/_action"
        lasting = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node = port.node
        self._goals = node.create_client(self._types.SendGoalService, f"{outside}/send_goal")
        self._results = node.create_client(self._types.GetResultService, f"{outside}/get_result")
        self._cancels = node.create_client(self._types.CancelGoalService, f"{outside}/cancel_goal")
        quality = port.feedback_quality(action)
        self._feedback = node.create_publisher(self._types.FeedbackMessage, f"{inside}/feedback", quality.depth)
        self._status = node.create_publisher(self._types.GoalStatusMessage, f"{inside}/status", lasting)
        node.create_subscription(self._types.FeedbackMessage, f"{outside}/feedback", self._on_feedback, quality)
        node.create_subscription(self._types.GoalStatusMessage, f"{outside}/status", self._on_status, lasting)
        _serve(port, self._types.SendGoalService, f"{inside}/send_goal", self._on_goal)
        _serve(port, self._types.GetResultService, f"{inside}/get_result", self._on_result_wanted)
        _serve(port, self._types.CancelGoalService, f"{inside}/cancel_goal", self._on_cancel)

    def cancel(self) -> None:
        """Cancels the goal at hand, before the robot has accepted it as soon as it does."""
        goal = self._goal
        if goal is not None and not goal.cancelled:
            goal.cancelled = True
            if goal.accepted:
                self._send_cancel(goal.identifier)

    # From the controller

    def _on_goal(self, request: Any, answer: _Answer) -> None:
        if self._goal is not None:
            self._layer.turn_away(self._action.request)
            answer.give()
            return
        self._goal = _Running(_bytes(request.goal_id), answer)
        if self._layer.passes(self._action.request):
            self._deadline = self._port.agenda.clock() + self._timeout
            self._look(self._goal, request)
        else:
            self._goal = None
            answer.give()

    def _on_result_wanted(self, request: Any, answer: _Answer) -> None:
        identifier = _bytes(request.goal_id)
        if self._goal is not None and self._goal.identifier == identifier:
            self._goal.waiting.append(answer)
        elif self._ended is not None and self._ended[0] == identifier:
            answer.give(self._ended[1])
        else:
            answer.give()

    def _on_cancel(self, request: Any, answer: _Answer) -> None:
        """The controller's own requests always pass."""

        def reject() -> None:
            answer.response.return_code = answer.response.ERROR_REJECTED
            answer.give()

        if not self._cancels.service_is_ready() or not self._ask_to_cancel(request, answer.give, reject):
            reject()

    # From the robot

    def _on_accepted(self, goal: _Running, response: Any) -> None:
        if self._goal is not goal:
            if response.accepted:
                self._send_cancel(goal.identifier)  # too late: nobody waits for it
        elif not response.accepted:
            self._fail("rejected")
        else:
            goal.accepted = True
            goal.answer.give(response)
            request = self._types.GetResultService.Request()
            request.goal_id.uuid = list(goal.identifier)
            goal.asked = self._ask(self._results, request, lambda response: self._on_result(goal, response))
            if goal.cancelled or not goal.asked:
                self._send_cancel(goal.identifier)
            if not goal.asked:
                self._fail("its result can't be asked for")

    def _on_feedback(self, message: Any) -> None:
        goal = self._goal
        if goal is not None and goal.identifier == _bytes(message.goal_id):
            if not goal.cancelled:
                self._layer.feed_back(self._action, message.feedback)
            self._feedback.publish(message)

    def _on_result(self, goal: _Running, response: Any) -> None:
        if self._goal is not goal:
            return
        if not goal.cancelled:
            if response.status == GoalStatus.STATUS_SUCCEEDED:
                self._layer.respond(self._action, response.result)
            else:
                cancelled = response.status == GoalStatus.STATUS_CANCELED
                self._layer.fail(self._action, "cancelled" if cancelled else "aborted")
        self._finish(goal, response)

    def _on_status(self, message: Any) -> None:
        """That a goal has ended is told with its result, not before: the supervisor knows first."""
        self._statuses = self._types.GoalStatusMessage()
        for each in message.status_list:
            identifier = _bytes(each.goal_info.goal_id)
            running = self._goal is not None and self._goal.identifier == identifier
            if running and each.status > GoalStatus.STATUS_CANCELING:
                each.status = GoalStatus.STATUS_EXECUTING
            if running or (self._ended is not None and self._ended[0] == identifier):
                self._statuses.status_list.append(each)
        self._status.publish(self._statuses)

    # Waiting

    def _look(self, goal: _Running, request: Any) -> None:
        """Sends the goal as soon as there is a server; then watches that it is accepted and stays."""
        if self._goal is not goal:
            return
        if goal.cancelled and not goal.sent:
            self._fail("cancelled before it was sent")
            return
        now = self._port.agenda.clock()
        if not goal.sent and self._goals.service_is_ready():
            accepted = functools.partial(self._on_accepted, goal)
            goal.sent = bool(self._ask(self._goals, request, accepted, self._timeout + _LOST))
        if goal.accepted and self._results.service_is_ready():
            self._deadline = now + self._timeout
        if now >= self._deadline:
            within = f" within {round(self._timeout * 1000)} ms"
            self._fail(
                "the server is gone" if goal.accepted else ("not accepted" if goal.sent else "no server") + within
            )
        else:
            self._port.agenda.after(_LOOK, lambda: self._look(goal, request))

    def _fail(self, why: str) -> None:
        goal = self._goal
        assert goal is not None
        if not goal.cancelled:
            self._layer.fail(self._action, why)
        if not goal.accepted:
            goal.answer.give()
        response = self._types.GetResultService.Response()
        response.status = GoalStatus.STATUS_ABORTED
        self._finish(goal, response)

    def _finish(self, goal: _Running, response: Any) -> None:
        self._goal = None
        if goal.asked:
            self._results.remove_pending_request(goal.asked)
        self._ended = (goal.identifier, response)
        for each in self._statuses.status_list:
            if _bytes(each.goal_info.goal_id) == goal.identifier:
                each.status = response.status
        if goal.accepted:
            self._status.publish(self._statuses)
        for answer in goal.waiting:
            answer.give(response)

    def _ask(
        self,
        client: Any,
        request: Any,
        answered: Callable[[Any], None],
        seconds: float | None = None,
        late: Callable[[], None] = lambda: None,
    ) -> Any:
        """Sends a request; the future of its answer, or None where it can't be sent.

        Calls `answered`, or after so many seconds without an answer `late`, after which an answer is dropped.
        """
        try:
            future = client.call_async(request)
        except Exception:  # whatever the middleware raises
            return None
        future.add_done_callback(lambda future: answered(future.result()))

        def give_up() -> None:
            if not future.done():
                client.remove_pending_request(future)
                late()

        if seconds is not None:
            self._port.agenda.after(seconds, give_up)
        return future

    def _send_cancel(self, identifier: bytes) -> None:
        request = self._types.CancelGoalService.Request()
        request.goal_info.goal_id.uuid = list(identifier)
        within = f"within {round(self._timeout * 1000)} ms"
        late = f"the server does not answer the request to cancel the goal {within}"
        if not self._ask_to_cancel(request, self._on_cancelling, lambda: self._refused(late)):
            self._refused("the request to cancel the goal can't be sent")

    def _ask_to_cancel(self, request: Any, answered: Callable[[Any], None], late: Callable[[], None]) -> bool:
        return bool(self._ask(self._cancels, request, answered, self._timeout, late))

    def _on_cancelling(self, response: Any) -> None:
        nothing = response.return_code == response.ERROR_NONE and not response.goals_canceling
        if nothing or response.return_code == response.ERROR_REJECTED:
            self._refused("the server refuses to cancel the goal")

    def _refused(self, why: str) -> None:
        self._port.warn(f"{self._action.identifier}: {why}")


def _bytes(identifier: Any) -> bytes:
    return bytes(bytearray(identifier.uuid))
