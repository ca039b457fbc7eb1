"""Every call and goal ends exactly once, whatever the server does and when."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.run.runtime.core.cancel_requests import FAREWELL, GoalTimes
from robosc.run.runtime.core.clients import ActionClient, Answers, ServiceClient
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.port import CancelAnswer, Failure, GoalOutcome
from tests.run.runtime.fake import FakePort

TIMEOUT, RETRY = 5.0, 1.0
REFUSED = "/light: the server refuses to cancel the goal"
UNANSWERED = "/light: the server does not answer the request to cancel the goal within 5000 ms"


class Bench:
    """A client, its notifications, and whether each came during a call."""

    def __init__(self, kind: type[ServiceClient] | type[ActionClient]) -> None:
        self.port = FakePort(time=0.5)
        self.event_loop = EventLoop(lambda: self.port.time)
        self.told: list[tuple[Any, ...]] = []
        self.inside = False
        answers = Answers(*(self._hear(kind) for kind in ("response", "error", "feedback", "canceled")))
        client: Any = SimpleNamespace(identifier="/light")
        times: Any = GoalTimes(TIMEOUT, RETRY) if kind is ActionClient else TIMEOUT
        self.client: Any = kind(self.port, self.event_loop, client, times, answers)

    def _hear(self, what: str) -> Any:
        def hear(*values: Any) -> None:
            assert not self.inside
            self.told.append((what, *values))

        return hear

    def do(self, action: Any) -> None:
        self.inside = True
        action()
        self.inside = False
        self.event_loop.run_pending()

    def wait(self, seconds: float) -> None:
        until = self.port.time + seconds
        while (left := self.event_loop.run_pending()) is not None and self.port.time + left <= until:
            self.port.time += left
        self.port.time = until
        self.event_loop.run_pending()


def test_a_call_that_is_failed_ends_once() -> None:
    bench = Bench(ServiceClient)
    bench.do(lambda: bench.client.fail(Failure.UNAVAILABLE, "no call"))
    bench.do(lambda: bench.client.call("request"))
    bench.do(lambda: bench.client.fail(Failure.UNAVAILABLE, "no server"))
    bench.do(lambda: bench.client.fail(Failure.FAILED, "again"))
    bench.port.calls[-1].answered("late")
    bench.wait(10)
    assert bench.told == [("error", Failure.UNAVAILABLE, "no server", None)]


def test_a_goal_that_is_failed_ends_once() -> None:
    bench = Bench(ActionClient)
    bench.do(lambda: bench.client.fail(Failure.TIMEOUT, "no goal"))
    bench.do(lambda: bench.client.start("goal"))
    bench.do(lambda: bench.client.fail(Failure.TIMEOUT, "accepted too late", "result"))
    bench.do(lambda: bench.client.fail(Failure.UNAVAILABLE, "again"))
    assert not bench.client.busy
    bench.wait(40)
    assert bench.told == [("error", Failure.TIMEOUT, "accepted too late", "result")]


def test_an_answer_in_time_is_the_response_and_a_second_one_nothing() -> None:
    bench = Bench(ServiceClient)
    bench.do(lambda: bench.client.call("request"))
    bench.wait(4.9)
    bench.do(lambda: bench.port.calls[0].answered("yes"))
    bench.do(lambda: bench.port.calls[0].answered("again"))
    bench.wait(10)
    assert bench.told == [("response", "yes")]


def test_no_answer_no_server_and_a_failed_call_are_errors() -> None:
    bench = Bench(ServiceClient)
    bench.do(lambda: bench.client.call("request"))
    bench.wait(5)
    bench.do(lambda: bench.port.calls[0].answered("late"))
    bench.port.served = False
    bench.do(lambda: bench.client.call("request"))
    bench.wait(5)
    bench.port.served = True
    bench.do(lambda: bench.client.call("request"))
    bench.do(lambda: bench.port.calls[1].failed("torn"))
    assert bench.told == [
        ("error", Failure.TIMEOUT, "no answer within 5000 ms", None),
        ("error", Failure.UNAVAILABLE, "no server within 5000 ms", None),
        ("error", Failure.FAILED, "the call failed: torn", None),
    ]


def test_a_server_that_comes_in_time_is_called() -> None:
    bench = Bench(ServiceClient)
    bench.port.served = False
    bench.do(lambda: bench.client.call("request"))
    bench.wait(4)
    assert not bench.port.calls
    bench.port.served = True
    bench.wait(0.5)
    bench.do(lambda: bench.port.calls[0].answered("yes"))
    assert bench.told == [("response", "yes")]


_STEPS = st.lists(
    st.tuples(st.sampled_from(("call", "answered", "failed", "wait", "serve")), st.integers(0, 9)), max_size=30
)


@pytest.mark.slow
@given(_STEPS)
def test_every_call_comes_to_one_end_unless_another_takes_its_place(steps: list[tuple[str, int]]) -> None:
    bench = Bench(ServiceClient)
    calls = replaced = 0
    for step, number in steps:
        if step == "call":
            replaced += bench.client.waiting
            calls += 1
            bench.do(lambda: bench.client.call("request"))
        elif step == "wait":
            bench.wait(number / 2)
        elif step == "serve":
            bench.port.served = bool(number % 2)
        elif bench.port.calls:
            handlers = bench.port.calls[number % len(bench.port.calls)]
            bench.do(lambda handlers=handlers, step=step: getattr(handlers, step)("x"))
    bench.wait(TIMEOUT + 1)
    assert len(bench.told) == calls - replaced
    assert not bench.client.waiting


def accepted(bench: Bench) -> Any:
    bench.do(lambda: bench.client.start("goal"))
    goal = bench.port.goals[-1]
    bench.do(goal.handlers.accepted)
    return goal


def end(bench: Bench, goal: Any, outcome: GoalOutcome, result: Any = None, text: str = "") -> None:
    bench.do(lambda: goal.handlers.ended(outcome, result, text))


def answer(bench: Bench, goal: Any, verdict: CancelAnswer) -> None:
    bench.do(lambda: goal.handlers.cancel_answered(verdict))


def test_a_goal_succeeds_after_any_time() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.wait(1000)
    bench.do(lambda: goal.handlers.feedback("half"))
    end(bench, goal, GoalOutcome.SUCCEEDED, "there")
    bench.do(lambda: goal.handlers.feedback("late"))
    assert bench.told == [("feedback", "half"), ("response", "there")]
    assert not bench.client.busy


@pytest.mark.parametrize(
    ("outcome", "told"),
    [
        (GoalOutcome.ABORTED, ("error", Failure.ABORTED, "aborted: stuck", "where")),
        (GoalOutcome.CANCELED, ("canceled", Failure.CANCELED, "canceled by someone else: stuck", "where")),
        (GoalOutcome.LOST, ("error", Failure.LOST, "the server has lost the goal: stuck", None)),
    ],
)
def test_a_goal_that_does_not_succeed_has_a_reason_and_its_result(outcome: GoalOutcome, told: tuple[Any, ...]) -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    end(bench, goal, outcome, "where", "stuck")
    assert bench.told == [told]


def test_no_server_a_rejection_and_a_server_that_goes_are_errors() -> None:
    bench = Bench(ActionClient)
    bench.port.served = False
    bench.do(lambda: bench.client.start("goal"))
    bench.wait(5)
    bench.port.served = True
    bench.do(lambda: bench.client.start("goal"))
    bench.do(bench.port.goals[0].handlers.rejected)
    accepted(bench)
    bench.port.served = False
    bench.wait(1)
    assert bench.told == [
        ("error", Failure.UNAVAILABLE, "no server within 5000 ms", None),
        ("error", Failure.REJECTED, "rejected", None),
        ("error", Failure.LOST, "the server is gone", None),
    ]


@pytest.mark.parametrize(
    ("outcome", "told"),
    [
        (GoalOutcome.CANCELED, ("canceled", Failure.TIMEOUT, "accepted too late, then canceled", "where")),
        (GoalOutcome.ABORTED, ("error", Failure.TIMEOUT, "accepted too late, then aborted", "where")),
        (GoalOutcome.SUCCEEDED, ("response", "where")),
    ],
)
def test_a_goal_accepted_too_late_is_canceled_and_its_end_is_told_when_it_has_ended(
    outcome: GoalOutcome, told: tuple[Any, ...]
) -> None:
    bench = Bench(ActionClient)
    bench.do(lambda: bench.client.start("goal"))
    goal = bench.port.goals[0]
    bench.wait(6)
    assert (bench.told, bench.client.busy) == ([], True)
    assert bench.port.said == ["/light: not accepted within 5000 ms"]
    assert bench.client.trouble == "not accepted within 5000 ms"
    asked = goal.cancels
    bench.do(goal.handlers.accepted)
    assert goal.cancels == asked + 1
    answer(bench, goal, CancelAnswer.ACCEPTED)
    bench.wait(100)
    assert (bench.told, bench.client.busy, bench.client.trouble) == ([], True, "")
    end(bench, goal, outcome, "where")
    assert not bench.client.busy
    assert bench.told == [told]


def test_a_goal_that_is_rejected_late_is_an_error_then() -> None:
    bench = Bench(ActionClient)
    bench.do(lambda: bench.client.start("goal"))
    bench.wait(6)
    bench.do(bench.port.goals[0].handlers.rejected)
    assert bench.told == [("error", Failure.REJECTED, "rejected", None)]


def test_a_goal_that_nobody_answers_is_lost_at_last_and_canceled_should_it_be_heard_of_after_all() -> None:
    bench = Bench(ActionClient)
    bench.do(lambda: bench.client.start("goal"))
    goal = bench.port.goals[0]
    bench.wait(34)
    assert bench.client.busy
    bench.wait(2)
    assert not bench.client.busy
    assert bench.told == [("error", Failure.LOST, "neither accepted nor rejected", None)]
    second = accepted(bench)
    asked = goal.cancels
    bench.do(goal.handlers.accepted)
    bench.do(lambda: goal.handlers.feedback("half"))
    assert (goal.cancels, second.cancels) == (asked + 1, 0)
    assert bench.client.busy


def test_a_goal_that_was_lost_is_canceled_where_its_server_comes_back_with_it() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.port.served = False
    bench.wait(1)
    assert bench.told == [("error", Failure.LOST, "the server is gone", None)]
    bench.port.served = True
    bench.do(lambda: goal.handlers.feedback("half"))
    assert goal.cancels == 1
    bench.do(lambda: goal.handlers.feedback("half"))
    assert goal.cancels == 1, "once"


def test_time_for_a_server_and_for_its_acceptance_is_one() -> None:
    bench = Bench(ActionClient)
    bench.port.served = False
    bench.do(lambda: bench.client.start("goal"))
    bench.wait(4)
    bench.port.served = True
    bench.wait(2)
    assert bench.port.said == ["/light: not accepted within 5000 ms"]


@pytest.mark.parametrize(
    ("outcome", "told"),
    [
        (GoalOutcome.SUCCEEDED, ("response", "where")),
        (
            GoalOutcome.CANCELED,
            ("canceled", Failure.CANCELED, "canceled by the controller itself, an error to the model", "where"),
        ),
        (GoalOutcome.ABORTED, ("error", Failure.ABORTED, "aborted", "where")),
    ],
)
def test_a_cancel_waits_for_acceptance_and_nothing_that_the_goal_still_says_is_dropped(
    outcome: GoalOutcome, told: tuple[Any, ...]
) -> None:
    bench = Bench(ActionClient)
    bench.do(lambda: bench.client.start("goal"))
    goal = bench.port.goals[0]
    bench.do(bench.client.cancel)
    assert goal.cancels == 0
    bench.do(goal.handlers.accepted)
    assert goal.cancels == 1
    answer(bench, goal, CancelAnswer.ACCEPTED)
    bench.do(lambda: goal.handlers.feedback("half"))
    bench.wait(60)
    assert (bench.client.busy, goal.cancels) == (True, 1), "it brakes, and nothing is asked again"
    end(bench, goal, outcome, "where")
    assert bench.told == [("feedback", "half"), told]


def test_a_goal_that_was_not_sent_because_of_the_cancel_is_canceled() -> None:
    bench = Bench(ActionClient)
    bench.port.served = False
    bench.do(lambda: bench.client.start("goal"))
    bench.do(bench.client.cancel)
    assert bench.told == [("canceled", Failure.CANCELED, "canceled before it was sent", None)]
    bench.port.served = True
    bench.wait(10)
    assert (bench.port.goals, bench.client.busy) == ([], False)


def test_a_refused_cancel_is_reported_once_and_asked_again_until_it_is_accepted() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.do(bench.client.cancel)
    answer(bench, goal, CancelAnswer.REFUSED)
    bench.wait(0.9)
    assert (goal.cancels, bench.client.trouble) == (1, "the server refuses to cancel the goal")
    bench.wait(0.2)
    assert goal.cancels == 2
    answer(bench, goal, CancelAnswer.REFUSED)
    bench.wait(1)
    assert goal.cancels == 3
    answer(bench, goal, CancelAnswer.ACCEPTED)
    bench.wait(20)
    assert (goal.cancels, bench.client.trouble, bench.client.busy) == (3, "", True)
    assert bench.port.said == [REFUSED]


def test_no_answer_to_a_cancel_counts_as_a_refusal_in_other_words() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.do(bench.client.cancel)
    bench.wait(4.9)
    assert (goal.cancels, bench.port.said) == (1, [])
    bench.wait(0.2)
    assert bench.port.said == [UNANSWERED]
    assert f"/light: {bench.client.trouble}" == UNANSWERED
    bench.wait(1)
    assert goal.cancels == 2
    answer(bench, goal, CancelAnswer.REFUSED)
    bench.wait(30)
    assert bench.port.said == [UNANSWERED, REFUSED]
    assert bench.client.busy


def test_an_unknown_goal_is_lost_and_a_terminated_one_when_its_result_does_not_come() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.do(bench.client.cancel)
    answer(bench, goal, CancelAnswer.UNKNOWN)
    assert bench.told == [("error", Failure.LOST, "the server does not know the goal", None)]
    goal = accepted(bench)
    bench.do(bench.client.cancel)
    answer(bench, goal, CancelAnswer.TERMINATED)
    bench.wait(4.9)
    assert len(bench.told) == 1
    bench.wait(0.2)
    assert bench.told[1:] == [
        ("error", Failure.LOST, "the goal has ended, but its result did not come within 5000 ms", None)
    ]
    goal = accepted(bench)
    bench.do(bench.client.cancel)
    answer(bench, goal, CancelAnswer.TERMINATED)
    end(bench, goal, GoalOutcome.SUCCEEDED, "there")
    assert bench.told[2:] == [("response", "there")]


def test_a_goal_that_someone_else_has_canceled_is_terminated_to_the_server_and_goes_on() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    goal.canceling = True
    bench.do(bench.client.cancel)
    answer(bench, goal, CancelAnswer.TERMINATED)
    bench.wait(60)
    assert (bench.told, bench.client.busy, goal.cancels) == ([], True, 1)
    end(bench, goal, GoalOutcome.CANCELED, "there")
    assert [kind for kind, *_ in bench.told] == ["canceled"]


def test_an_answer_to_a_repeated_request_is_nothing_after_an_accepted_one() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.do(bench.client.cancel)
    bench.wait(6.1)
    assert goal.cancels == 2
    answer(bench, goal, CancelAnswer.ACCEPTED)
    for late in (CancelAnswer.TERMINATED, CancelAnswer.UNKNOWN, CancelAnswer.REFUSED):
        answer(bench, goal, late)
    bench.wait(20)
    assert (bench.told, bench.client.busy, bench.client.trouble, goal.cancels) == ([], True, "", 2)


def test_a_goal_whose_result_does_not_come_ends_with_the_timeout_whatever_is_asked_meanwhile() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.do(bench.client.cancel)
    answer(bench, goal, CancelAnswer.TERMINATED)
    bench.do(bench.client.cancel)
    answer(bench, goal, CancelAnswer.REFUSED)
    bench.wait(4.9)
    assert bench.told == []
    bench.wait(0.1)
    assert bench.told == [
        ("error", Failure.LOST, "the goal has ended, but its result did not come within 5000 ms", None)
    ]
    assert (goal.cancels, bench.client.busy) == (1, False)


def test_a_goal_that_can_not_be_sent_is_an_error() -> None:
    bench = Bench(ActionClient)

    def broken(*_: Any) -> None:
        raise RuntimeError("torn")

    bench.port.send_goal = broken  # type: ignore[method-assign]
    bench.do(lambda: bench.client.start("goal"))
    assert bench.told == [("error", Failure.UNAVAILABLE, "the goal cannot be sent: torn", None)]


@pytest.mark.parametrize(
    ("steps", "report"),
    [
        ((), "the goal has not ended when this node ends: the server has not answered"),
        (
            (CancelAnswer.REFUSED,),
            "the goal has not ended when this node ends: the server refuses to cancel the goal",
        ),
        ((CancelAnswer.ACCEPTED,), "the goal has not ended when this node ends: the server cancels the goal"),
    ],
)
def test_a_node_that_ends_waits_for_the_answer_to_a_cancel_and_reports_what_becomes_of_the_goal(
    steps: tuple[CancelAnswer, ...], report: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = Bench(ActionClient)
    steady = SimpleNamespace(monotonic=lambda: bench.port.time)
    for module in ("clients", "cancel_requests"):
        monkeypatch.setattr(f"robosc.run.runtime.core.{module}.time", steady)
    goal = accepted(bench)
    assert not bench.client.waits
    bench.do(bench.client.cancel)
    for step in steps:
        answer(bench, goal, step)
    start = bench.port.time
    while bench.client.waits:
        bench.wait(0.25)
    waited = FAREWELL if CancelAnswer.ACCEPTED in steps else TIMEOUT
    assert waited <= bench.port.time - start < waited + 0.5
    del bench.port.said[:]
    bench.client.leave()
    unanswered = "the server does not answer the request to cancel the goal within 5000 ms"
    assert bench.port.said == [f"/light: {report}".replace("the server has not answered", unanswered)]
    assert not bench.client.busy


_GOAL_STEPS = st.lists(
    st.tuples(
        st.sampled_from(
            ("start", "cancel", "accepted", "rejected", "feedback", "ended", "answer", "wait", "serve", "stop")
        ),
        st.integers(0, 9),
    ),
    max_size=40,
)


def play(bench: Bench, goal: Any, step: str, number: int) -> None:
    """Let the server perform a step with a goal."""
    match step:
        case "feedback":
            bench.do(lambda: goal.handlers.feedback(number))
        case "answer":
            answer(bench, goal, list(CancelAnswer)[number % 4])
        case "stop":
            goal.canceling = bool(number % 2)
        case "ended":
            end(bench, goal, list(GoalOutcome)[number % 4])
        case _:
            bench.do(getattr(goal.handlers, step))


@given(_GOAL_STEPS)
def test_every_goal_comes_to_one_end(steps: list[tuple[str, int]]) -> None:
    bench = Bench(ActionClient)
    started = 0
    for step, number in steps:
        goal = bench.port.goals[number % len(bench.port.goals)] if bench.port.goals else None
        if step == "start" and not bench.client.busy:
            started += 1
            bench.do(lambda: bench.client.start("goal"))
        elif step == "cancel":
            bench.do(bench.client.cancel)
        elif step == "wait":
            bench.wait(number)
        elif step == "serve":
            bench.port.served = bool(number % 2)
        elif goal is not None and step != "start":
            play(bench, goal, step, number)
    for goal in bench.port.goals:
        goal.canceling = False
    bench.port.served = False
    bench.wait(3 * TIMEOUT)
    ends = [kind for kind, *_ in bench.told if kind != "feedback"]
    assert not bench.client.busy
    assert len(ends) == started
