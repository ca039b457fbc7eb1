"""Clients of actions of ROS 1, on actionlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.runtime.core.node import StartError
from robosc.runtime.core.port import Goal, GoalHandlers, Outcome

try:
    import actionlib
    import rospy
    from actionlib_msgs.msg import GoalStatus
except ImportError as error:
    raise StartError(f"actionlib is not there for this Python: {error}", "apt install python3-actionlib") from error

if TYPE_CHECKING:
    from robosc.runtime.core.port import Message

_OUTCOMES = {
    GoalStatus.SUCCEEDED: Outcome.SUCCEEDED,
    GoalStatus.PREEMPTED: Outcome.CANCELLED,
    GoalStatus.RECALLED: Outcome.CANCELLED,
}


class ActionClient:
    """The topics of one action; `kind` is its type's class with `Action` at the end."""

    def __init__(self, name: str, kind: Any) -> None:
        self._client = actionlib.ActionClient(name, kind)

    def is_served(self) -> bool:
        """Whether a server has connected to all topics."""
        # actionlib looks at least once, however short the time.
        return bool(self._client.wait_for_server(rospy.Duration(-1)))

    def send(self, goal: Message, handlers: GoalHandlers) -> Goal:
        """Sends a goal; the handlers are called from rospy's threads."""
        sent: Goal = self._client.send_goal(
            goal, lambda handle: _follow(handle, handlers), lambda _, feedback: handlers.feedback(feedback)
        )
        return sent


def _follow(handle: Any, handlers: GoalHandlers) -> None:
    state = handle.get_comm_state()
    if state == actionlib.CommState.ACTIVE:
        handlers.accepted()
    elif state == actionlib.CommState.WAITING_FOR_RESULT:
        handlers.over()
    elif state == actionlib.CommState.DONE:
        status = handle.get_goal_status()
        if status == GoalStatus.REJECTED:
            handlers.rejected()
        else:
            outcome = _OUTCOMES.get(status, Outcome.ABORTED)
            handlers.ended(outcome, handle.get_result(), handle.get_goal_status_text())
