"""Answers of an action server of ROS 2: the end of a goal, and the answer to a request to cancel it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.run.runtime.core.port import CancelAnswer, GoalOutcome

if TYPE_CHECKING:
    from robosc.run.runtime.core.port import Message

#: The final values of `action_msgs/msg/GoalStatus`.
_OUTCOMES = {4: GoalOutcome.SUCCEEDED, 5: GoalOutcome.CANCELED, 6: GoalOutcome.ABORTED}


def outcome(status: int) -> GoalOutcome:
    """Return how a goal has ended by the status of its result; with any other status the goal may still run."""
    return _OUTCOMES.get(status, GoalOutcome.LOST)


def cancel_answer(response: Message, goal: bytes) -> CancelAnswer:
    """Return the answer to a request to cancel a goal; one that names only other goals is a refusal."""
    match response.return_code:
        case response.ERROR_GOAL_TERMINATED:
            return CancelAnswer.TERMINATED
        case response.ERROR_UNKNOWN_GOAL_ID:
            return CancelAnswer.UNKNOWN
        case response.ERROR_NONE if any(uuid_bytes(info.goal_id) == goal for info in response.goals_canceling):
            return CancelAnswer.ACCEPTED
    return CancelAnswer.REFUSED


def uuid_bytes(identifier: Message) -> bytes:
    """Return the bytes of a goal's identifier."""
    return bytes(bytearray(identifier.uuid))
