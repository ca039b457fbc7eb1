"""Ends of goals of ROS 1."""

from __future__ import annotations

from robosc.runtime.core.port import Outcome

#: The final values of `actionlib_msgs/GoalStatus`: preempted, succeeded, aborted, recalled.
_OUTCOMES = {2: Outcome.CANCELED, 3: Outcome.SUCCEEDED, 4: Outcome.ABORTED, 8: Outcome.CANCELED}


def outcome(status: int) -> Outcome:
    """Return how a goal that was not rejected has ended; with a status that is not final the goal may still run."""
    return _OUTCOMES.get(status, Outcome.LOST)
