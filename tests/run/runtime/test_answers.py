"""Only a final status of an action server ends a goal, and only an answer with the goal's ID cancels it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from robosc.run.runtime.core.port import CancelAnswer, GoalOutcome
from robosc.run.runtime.ros2 import answers

OWN, OTHER = bytes(range(16)), bytes(16)


def response(code: int, *goals: bytes) -> SimpleNamespace:
    """Return a response of `action_msgs/srv/CancelGoal`."""
    named = [SimpleNamespace(goal_id=SimpleNamespace(uuid=list(goal))) for goal in goals]
    constants = {"ERROR_NONE": 0, "ERROR_REJECTED": 1, "ERROR_UNKNOWN_GOAL_ID": 2, "ERROR_GOAL_TERMINATED": 3}
    return SimpleNamespace(return_code=code, goals_canceling=named, **constants)


def test_any_other_status_leaves_the_end_open() -> None:
    ends = {4: GoalOutcome.SUCCEEDED, 5: GoalOutcome.CANCELED, 6: GoalOutcome.ABORTED}
    for status in range(-128, 128):
        assert answers.outcome(status) is ends.get(status, GoalOutcome.LOST)


@pytest.mark.parametrize(
    ("code", "goals", "verdict"),
    [
        (0, [OWN], CancelAnswer.ACCEPTED),
        (0, [OTHER, OWN], CancelAnswer.ACCEPTED),
        (0, [], CancelAnswer.REFUSED),
        (0, [OTHER], CancelAnswer.REFUSED),
        (1, [], CancelAnswer.REFUSED),
        (1, [OWN], CancelAnswer.REFUSED),
        (77, [], CancelAnswer.REFUSED),
        (77, [OWN], CancelAnswer.REFUSED),
        (2, [], CancelAnswer.UNKNOWN),
        (3, [], CancelAnswer.TERMINATED),
    ],
)
def test_a_cancel_is_accepted_by_an_answer_without_error_that_names_the_goal(
    code: int, goals: list[bytes], verdict: CancelAnswer
) -> None:
    assert answers.cancel_answer(response(code, *goals), OWN) is verdict
