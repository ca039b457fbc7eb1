"""Clients of actions of ROS 1, on actionlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.runtime.core.node import StartError
from robosc.runtime.core.port import CancelAnswer, Goal, GoalHandlers
from robosc.runtime.ros1.outcomes import outcome

try:
    import actionlib
    import rospy
    from actionlib_msgs.msg import GoalStatus
except ImportError as error:
    raise StartError(f"actionlib is not there for this Python: {error}", "apt install python3-actionlib") from error

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.runtime.core.port import Message

#: Looks in which a server may be missing.
_PATIENCE = 10


class ActionClient:
    """The topics of one action; `kind` is its type's class with `Action` at the end."""

    def __init__(self, name: str, kind: Any) -> None:
        self._client = actionlib.ActionClient(name, kind)

    def is_served(self) -> bool:
        """Whether a server has connected to all topics."""
        # actionlib looks at least once, until a time that is over; no time is before 0, where a simulation begins.
        has_begun = rospy.get_rostime() > rospy.Time()
        return has_begun and bool(self._client.wait_for_server(rospy.Duration(0, -1)))

    def send(self, goal: Message, handlers: GoalHandlers) -> Goal:
        """Sends a goal; the handlers are called from rospy's threads."""
        handle = self._client.send_goal(
            goal, lambda handle: _follow(handle, handlers), lambda _, feedback: handlers.feedback(feedback)
        )
        return _SentGoal(handle, self.is_served)


class _SentGoal:
    """A goal that was sent; `is_served`: whether a server is there."""

    def __init__(self, handle: Any, is_served: Callable[[], bool]) -> None:
        self._handle = handle
        self._is_served = is_served
        self._missed = 0

    def cancel(self) -> None:
        """Asks the server to cancel it."""
        self._handle.cancel()

    def is_canceling(self) -> bool:
        """A server of ROS 1 has ended a goal where it says so."""
        return False

    def is_gone(self) -> bool:
        """Whether no server was there in several looks: of one that came back, parts are missing for a moment."""
        self._missed = 0 if self._is_served() else self._missed + 1
        return self._missed > _PATIENCE


def _follow(handle: Any, handlers: GoalHandlers) -> None:
    state = handle.get_comm_state()
    if state == actionlib.CommState.ACTIVE:
        handlers.accepted()
    elif state in (actionlib.CommState.RECALLING, actionlib.CommState.PREEMPTING):
        handlers.cancel_answered(CancelAnswer.ACCEPTED)
    elif state == actionlib.CommState.WAITING_FOR_RESULT:
        handlers.over()
    elif state == actionlib.CommState.DONE:
        status = handle.get_goal_status()
        if status == GoalStatus.REJECTED:
            handlers.rejected()
        else:
            handlers.ended(outcome(status), handle.get_result(), handle.get_goal_status_text())
