"""Actions of ROS 2: goals that a controller sends, and actions that a layer offers its controller."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from action_msgs.msg import GoalInfo, GoalStatus
from rclpy.action.client import ClientGoalHandle
from rclpy.qos import DurabilityPolicy, QoSProfile

from robosc.run.runtime.core.cancel_requests import GoalTimes
from robosc.run.runtime.core.clients import LOST
from robosc.run.runtime.core.port import Failure, GoalHandlers, GoalOutcome
from robosc.run.runtime.core.proxies import ActionProxy, ProxiedGoal
from robosc.run.runtime.ros2.answers import cancel_answer, outcome, uuid_bytes

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.model import rosgraph
    from robosc.run.runtime.core.layer import Layer
    from robosc.run.runtime.core.port import Message
    from robosc.run.runtime.ros2.node import Ros2Node

#: Number of looks for a server for each look at the graph.
LOOKS = 4


def settle(answered: Callable[[Message], None], failed: Callable[[str], None], future: Any) -> None:
    """Call the matching function with the result of a future; neither if it was canceled."""
    if future.cancelled():
        return
    if future.exception() is not None:
        failed(str(future.exception()))
    elif future.result() is not None:
        answered(future.result())


class SentGoal:
    """Goal that a controller has sent to an action server.

    `servers` returns the present servers in the ROS graph.
    """

    def __init__(
        self, client: Any, goal: Message, handlers: GoalHandlers, servers: Callable[[], frozenset[bytes]]
    ) -> None:
        self._handlers = handlers
        self._servers = servers
        self._sent_to = servers()
        self._looks = 0
        identifier = GoalInfo().goal_id
        identifier.uuid = list(uuid4().bytes)
        self._handle = ClientGoalHandle(client, identifier, None)
        sent = client.send_goal_async(goal, lambda message: handlers.feedback(message.feedback), identifier)
        sent.add_done_callback(partial(settle, self._decided, self._failed))

    def cancel(self) -> None:
        """Send a request to cancel the goal to the server."""
        answer = self._handle.cancel_goal_async()
        goal = uuid_bytes(self._handle.goal_id)
        answered = lambda response: self._handlers.cancel_answered(cancel_answer(response, goal))  # noqa: E731
        answer.add_done_callback(partial(settle, answered, lambda _: None))

    def is_canceling(self) -> bool:
        """Return whether the server reports that the goal is being canceled."""
        return bool(self._handle.status == GoalStatus.STATUS_CANCELING)

    def is_gone(self) -> bool:
        """Return whether all servers of the time of sending are gone: a server that dies can't report it."""
        self._looks += 1
        return self._looks % LOOKS == 0 and not self._sent_to & self._servers()

    def _decided(self, handle: Any) -> None:
        if not handle.accepted:
            self._handlers.rejected()
            return
        self._handle = handle
        self._handlers.accepted()
        handle.get_result_async().add_done_callback(partial(settle, self._ended, self._failed))

    def _ended(self, answer: Any) -> None:
        self._handlers.ended(outcome(answer.status), answer.result, "")

    def _failed(self, why: str) -> None:
        self._handlers.ended(GoalOutcome.LOST, None, why)


class LateAnswer:
    """Answer to one call of a service of the layer, given before or after the caller is known."""

    def __init__(self, response: Message) -> None:
        self.response = response
        self._send: Callable[[Message], None] | None = None
        self._is_complete = False

    def give(self, response: Message = None) -> None:
        """Answer; without a response, with an unset one."""
        self.response, self._is_complete = response or self.response, True
        if self._send is not None:
            self._send(self.response)

    def send_with(self, send: Callable[[Message], None]) -> None:
        """Set the function that sends the answer to the caller."""
        self._send = send
        if self._is_complete:
            send(self.response)


@dataclass(eq=False)
class _Goal(ProxiedGoal):
    """Goal of the controller: `answer` accepts or rejects it, `waiting` holds its calls for the result."""

    answer: LateAnswer | None = None
    result: Any = None
    status: int = GoalStatus.STATUS_UNKNOWN
    sent_to: frozenset[bytes] = frozenset()
    looks: int = 0
    served: bool = True
    waiting: list[LateAnswer] = field(default_factory=list)


class Ros2ActionProxy(ActionProxy[_Goal]):
    """Proxy of an action on ROS 2. `types` has the types of the action's services and topics."""

    def __init__(self, port: Ros2Node, types: Any, action: rosgraph.ActionClient, layer: Layer, timeout: float) -> None:
        super().__init__(port, port.event_loop, action, layer, GoalTimes(timeout, timeout))
        self._ended: tuple[bytes, Any] | None = None
        self._statuses: Any = types.GoalStatusMessage()
        self._types = types
        inside, outside = f"{port.inside(action.identifier)}/_action", f"{action.identifier}/_action"
        lasting = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node = port.node
        self._goals = node.create_client(types.SendGoalService, f"{outside}/send_goal")
        self._servers = partial(port.servers, action.identifier)
        self._results = node.create_client(types.GetResultService, f"{outside}/get_result")
        self._cancels = node.create_client(types.CancelGoalService, f"{outside}/cancel_goal")
        feedback = port.feedback_qos(action)
        self._feedback = node.create_publisher(types.FeedbackMessage, f"{inside}/feedback", feedback.depth)
        self._status = node.create_publisher(types.GoalStatusMessage, f"{inside}/status", lasting)
        port.listen(types.FeedbackMessage, f"{outside}/feedback", self._on_feedback, feedback)
        port.listen(types.GoalStatusMessage, f"{outside}/status", self._on_status, lasting)
        port.serve(types.SendGoalService, f"{inside}/send_goal", self._on_goal)
        port.serve(types.GetResultService, f"{inside}/get_result", self._on_result_wanted)
        port.serve(types.CancelGoalService, f"{inside}/cancel_goal", self._on_cancel)

    # From the controller

    def _on_goal(self, request: Message, answer: LateAnswer) -> None:
        self._receive_goal(_Goal(uuid_bytes(request.goal_id), request, answer=answer), request.goal)

    def _on_result_wanted(self, request: Message, answer: LateAnswer) -> None:
        identifier = uuid_bytes(request.goal_id)
        goal = self._at_hand(identifier)
        if goal is not None:
            goal.waiting.append(answer)
        elif self._ended is not None and self._ended[0] == identifier:
            answer.give(self._ended[1])
        else:
            answer.give()

    def _on_cancel(self, request: Message, answer: LateAnswer) -> None:
        """Forward a cancel request of the controller; these always pass."""

        def reject() -> None:
            answer.response.return_code = answer.response.ERROR_REJECTED
            answer.give()

        if not self._cancels.service_is_ready() or not self._ask_to_cancel(request, answer.give, reject):
            reject()

    # From the robot

    def _on_accepted(self, goal: _Goal, response: Message) -> None:
        assert goal.answer is not None
        if self._goal is not goal:
            if response.accepted:
                self._send_cancel(goal)  # it counted as lost
        elif not response.accepted:
            self._give_up(goal, Failure.REJECTED, "rejected")
        else:
            goal.answer.give(response)
            request = self._types.GetResultService.Request()
            request.goal_id.uuid = list(goal.identifier)
            goal.result = self._ask(self._results, request, partial(self._on_result, goal))
            self._accept(goal)
            if not goal.result:
                self._send_cancel(goal)
                self._give_up(goal, Failure.LOST, "its result cannot be requested")

    def _on_feedback(self, message: Message) -> None:
        if self._receive_feedback(uuid_bytes(message.goal_id), message.feedback):
            self._feedback.publish(message)

    def _on_result(self, goal: _Goal, response: Message) -> None:
        if self._goal is goal:
            self._receive_end(goal, outcome(response.status), response.result)
            self._finish(goal, response)

    def _on_status(self, message: Message) -> None:
        """Forward the status, but hide the end of a goal until its result, which the supervisor must get first."""
        self._statuses = self._types.GoalStatusMessage()
        for status in message.status_list:
            identifier = uuid_bytes(status.goal_info.goal_id)
            goal = self._at_hand(identifier)
            running = goal is not None
            if goal is not None:
                goal.status = status.status
            if running and status.status > GoalStatus.STATUS_CANCELING:
                status.status = GoalStatus.STATUS_EXECUTING
            if running or (self._ended is not None and self._ended[0] == identifier):
                self._statuses.status_list.append(status)
        self._status.publish(self._statuses)

    # Interface to the layer

    def server_is_ready(self) -> bool:
        """Return whether the robot offers the action."""
        return bool(self._goals.service_is_ready())

    def _is_served(self, goal: _Goal) -> bool:
        if not goal.accepted:
            return self.server_is_ready()
        goal.looks += 1
        # A server that has died and its successor offer the same services.
        if goal.looks % LOOKS == 0:
            goal.served = bool(goal.sent_to & self._servers())
        return goal.served

    def _send(self, goal: _Goal) -> bool:
        goal.sent_to = self._servers()
        return bool(self._ask(self._goals, goal.request, partial(self._on_accepted, goal), self._times.timeout + LOST))

    def _send_cancel(self, goal: _Goal) -> None:
        request = self._types.CancelGoalService.Request()
        request.goal_info.goal_id.uuid = list(goal.identifier)
        answered = lambda response: self._cancel_answered(goal, cancel_answer(response, goal.identifier))  # noqa: E731
        self._ask_to_cancel(request, answered)

    def _is_canceling(self, goal: _Goal) -> bool:
        return bool(goal.status == GoalStatus.STATUS_CANCELING)

    def _ask_to_cancel(
        self, request: Message, answered: Callable[[Message], None], late: Callable[[], None] = lambda: None
    ) -> bool:
        return bool(self._ask(self._cancels, request, answered, self._times.timeout, late))

    def _end(self, goal: _Goal) -> None:
        assert goal.answer is not None
        if not goal.accepted:
            goal.answer.give()
        response = self._types.GetResultService.Response()
        response.status = GoalStatus.STATUS_ABORTED
        self._finish(goal, response)

    def _finish(self, goal: _Goal, response: Message) -> None:
        if goal.result:
            self._results.remove_pending_request(goal.result)
        if goal.sent:
            self._ended = (goal.identifier, response)
        for status in self._statuses.status_list:
            if uuid_bytes(status.goal_info.goal_id) == goal.identifier:
                status.status = response.status
        if goal.accepted:
            self._status.publish(self._statuses)
        for answer in goal.waiting:
            answer.give(response)

    def _ask(
        self,
        client: Any,
        request: Message,
        answered: Callable[[Message], None],
        seconds: float | None = None,
        late: Callable[[], None] = lambda: None,
    ) -> Any:
        """Send a request; return the future of its answer, or None if it can't be sent.

        Calls `answered` with the answer, or `late` after `seconds` without one. Later answers are dropped.
        """
        try:
            future = client.call_async(request)
        except Exception:  # any exception of the middleware
            return None
        future.add_done_callback(lambda future: answered(future.result()))

        def give_up() -> None:
            if not future.done():
                client.remove_pending_request(future)
                late()

        if seconds is not None:
            self._event_loop.call_later(seconds, give_up)
        return future
