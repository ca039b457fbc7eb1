"""Action servers of ROS 2: the goals that other nodes send to a controller."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.task import Future

from robosc.run.runtime.core.port import GoalOutcome

if TYPE_CHECKING:
    from robosc.model import rosgraph
    from robosc.run.runtime.core import servers
    from robosc.run.runtime.core.port import Message
    from robosc.run.runtime.ros2.node import Ros2Node


class _Goal:
    """Accepted goal of a client."""

    def __init__(self, handle: Any) -> None:
        self.handle = handle
        self.is_answered = False
        self._result: Any = Future()
        handle.execute(self._work)

    def feed_back(self, feedback: Message) -> None:
        """Publish feedback."""
        self.handle.publish_feedback(feedback)

    def end(self, outcome: GoalOutcome, result: Message) -> None:
        """End the goal with a result."""
        ends = {
            GoalOutcome.SUCCEEDED: self.handle.succeed,
            GoalOutcome.ABORTED: self.handle.abort,
            GoalOutcome.CANCELED: self.handle.canceled,
        }
        ends[outcome]()
        self._result.set_result(result)

    async def _work(self, _: Any) -> Message:
        """Return the result of the goal when it has one; rclpy sends it in the same step."""
        result = await self._result
        self.is_answered = True
        return result


class Ros2ActionServer:
    """Action of a controller on ROS 2. `kind` is the Python class of its type."""

    def __init__(self, port: Ros2Node, kind: Any, action: rosgraph.ActionServer, server: servers.ActionServer) -> None:
        self._server = server
        self._goal: _Goal | None = None
        self._actions = ActionServer(
            port.node,
            kind,
            action.identifier,
            execute_callback=lambda _: None,  # each goal has its own
            goal_callback=self._decide,
            handle_accepted_callback=self._begin,
            cancel_callback=self._cancel,
            feedback_pub_qos_profile=port.feedback_qos(action),
        )

    def close(self) -> None:
        """Withdraw the action."""
        self._actions.destroy()

    def _decide(self, goal: Message) -> GoalResponse:
        return GoalResponse.ACCEPT if self._server.accepts(goal) else GoalResponse.REJECT

    def _begin(self, handle: Any) -> None:
        self._goal = _Goal(handle)
        self._server.begin(self._goal, handle.request)

    def _cancel(self, handle: Any) -> CancelResponse:
        is_present = self._goal is not None and self._goal.handle == handle
        return CancelResponse.ACCEPT if is_present and self._server.cancel() else CancelResponse.REJECT
