"""An action of a layer on ROS 1: its five topics for the controller, and those of the robot's action."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

from robosc.runtime.core.cancel_requests import GoalTimes
from robosc.runtime.core.port import CancelAnswer, Failure
from robosc.runtime.core.proxies import ActionProxy, ProxiedGoal
from robosc.runtime.ros1.outcomes import outcome

if TYPE_CHECKING:
    from robosc.metamodel import rosgraph
    from robosc.runtime.core.layer import Layer
    from robosc.runtime.core.port import Message
    from robosc.runtime.ros1.node import Ros1Node

_CANCELING = (GoalStatus.PREEMPTING, GoalStatus.RECALLING)
_UNDER_WAY = (GoalStatus.PENDING, GoalStatus.ACTIVE, GoalStatus.PREEMPTING, GoalStatus.RECALLING)


@dataclass(eq=False)
class _Goal(ProxiedGoal):
    """A goal of the controller's; `cancels` are its own requests to cancel it before it was sent."""

    cancels: list[Message] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.status = GoalStatus(goal_id=self.request.goal_id, status=GoalStatus.PENDING)


class Ros1ActionProxy(ActionProxy[_Goal]):
    """`kind` is the class of the action's type with `Action` at its end."""

    def __init__(self, node: Ros1Node, kind: Any, action: rosgraph.ActionClient, layer: Layer, timeout: float) -> None:
        # There is no answer to a request to cancel in ROS 1, and so no refusal that another one would follow.
        super().__init__(node, node.event_loop, action, layer, GoalTimes(timeout, None))
        self._ended = ""
        made = kind()
        goal, result, feedback = (type(part) for part in (made.action_goal, made.action_result, made.action_feedback))
        self._result_type = result
        inside, outside = node.inside(action.identifier), action.identifier
        self._goals = node.advertise(f"{outside}/goal", goal)
        self._cancels = node.advertise(f"{outside}/cancel", GoalID)
        self._results = node.advertise(f"{inside}/result", result)
        self._feedback = node.advertise(f"{inside}/feedback", feedback)
        self._statuses = node.advertise(f"{inside}/status", GoalStatusArray)
        self._heard = node.subscribe(f"{outside}/result", result, self._on_result, None)
        node.subscribe(f"{outside}/feedback", feedback, self._on_feedback)
        node.subscribe(f"{outside}/status", GoalStatusArray, self._on_status)
        node.subscribe(f"{inside}/goal", goal, self._on_goal, None)
        node.subscribe(f"{inside}/cancel", GoalID, self._on_cancel, None)

    # From the controller

    def _on_goal(self, message: Message) -> None:
        if self._goal is None and not message.goal_id.id:
            # The server would name it, and the layer would not know it again.
            message.goal_id.id = f"{rospy.get_name()}-{rospy.get_time()}"
        self._receive_goal(_Goal(message.goal_id.id, message))

    def _on_cancel(self, message: Message) -> None:
        """The controller's own requests always pass."""
        if self._goal is not None and not self._goal.sent:
            self._goal.cancels.append(message)
        else:
            self._cancels.publish(message)

    # From the robot

    def _on_feedback(self, message: Message) -> None:
        if self._receive_feedback(message.status.goal_id.id, message.feedback):
            self._feedback.publish(message)

    def _on_result(self, message: Message) -> None:
        goal, status = self._at_hand(message.status.goal_id.id), message.status.status
        if goal is None:
            return
        self._ended = goal.identifier
        if status == GoalStatus.REJECTED:
            self._forget()
            self._layer.fail(self._action, Failure.REJECTED, "rejected", message.result)
        else:
            self._receive_end(goal, outcome(status), message.result)
        self._results.publish(message)

    def _on_status(self, message: Message) -> None:
        """That a goal has ended is told with its result, not before: the supervisor knows first."""
        told = GoalStatusArray(header=message.header)
        told.status_list = [status for status in message.status_list if status.goal_id.id == self._ended]
        goal = self._goal
        if goal is not None:
            own = [status for status in message.status_list if status.goal_id.id == goal.identifier]
            for status in own:
                goal.status.text = status.text
                if status.status in _UNDER_WAY:
                    goal.status.status = status.status
                if status.status not in (GoalStatus.PENDING, GoalStatus.RECALLING, GoalStatus.REJECTED):
                    self._accept(goal)
                if status.status in _CANCELING:
                    self._cancel_answered(goal, CancelAnswer.ACCEPTED)
            # The robot had accepted it and says that it has ended, or says nothing of it any more.
            if goal.accepted and all(status.status not in _UNDER_WAY for status in own):
                self._await_result(goal)
            elif goal.over:
                self._resume(goal)
                if goal.canceled:
                    self._requests.ask()
            told.status_list.append(goal.status)  # even one that the robot does not know: the controller hears its end
        self._statuses.publish(told)

    # What the layer does

    def _is_served(self, goal: _Goal) -> bool:
        del goal
        return all(end.get_num_connections() > 0 for end in (self._goals, self._cancels, self._heard))

    def _send(self, goal: _Goal) -> bool:
        self._goals.publish(goal.request)
        for message in goal.cancels:
            self._cancels.publish(message)
        return True

    def _send_cancel(self, goal: _Goal) -> None:
        self._cancels.publish(GoalID(id=goal.identifier))  # without a time, which would cancel other goals, too

    def _is_canceling(self, goal: _Goal) -> bool:
        del goal
        return False  # a robot of ROS 1 has ended a goal where it says so

    def _end(self, goal: _Goal, why: str) -> None:
        if goal.sent:  # a robot that has it, or gets it yet, is told to cancel it
            self._cancels.publish(GoalID(id=goal.identifier))
            self._ended = goal.identifier
        status = GoalStatus.ABORTED if goal.accepted else GoalStatus.REJECTED
        message = self._result_type(status=GoalStatus(goal_id=goal.request.goal_id, status=status, text=why))
        message.header.stamp = rospy.Time.now()
        self._results.publish(message)
