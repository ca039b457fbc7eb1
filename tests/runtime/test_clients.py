"""Services and actions: what is sent comes to exactly one end, whatever the server does and when."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.runtime.core.clients import ActionClient, Answers, ServiceClient
from robosc.runtime.core.event_loop import EventLoop
from robosc.runtime.core.port import Outcome
from tests.runtime.fake import FakePort

TIMEOUT = 5.0


class Bench:
    """A client, what it told, and whether it was inside of a call then."""

    def __init__(self, kind: type[ServiceClient] | type[ActionClient]) -> None:
        self.port = FakePort(time=0.5)
        self.event_loop = EventLoop(lambda: self.port.time)
        self.told: list[tuple[str, Any]] = []
        self.inside = False
        answers = Answers(*(self._hear(kind) for kind in ("response", "error", "feedback")), self._ended)
        client: Any = SimpleNamespace(identifier="/light")
        self.client = kind(self.port, self.event_loop, client, TIMEOUT, answers)

    def _hear(self, what: str) -> Any:
        def hear(value: Any) -> None:
            assert not self.inside
            self.told.append((what, value))

        return hear

    def _ended(self) -> None:
        assert not self.inside
        self.told.append(("ended", None))

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
        ("error", "no answer within 5000 ms"),
        ("error", "no server within 5000 ms"),
        ("error", "the call failed: torn"),
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


def test_a_goal_succeeds_after_any_time() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.wait(1000)
    bench.do(lambda: goal.handlers.feedback("half"))
    bench.do(lambda: goal.handlers.ended(Outcome.SUCCEEDED, "there", ""))
    bench.do(lambda: goal.handlers.feedback("late"))
    assert bench.told == [("feedback", "half"), ("response", "there")]
    assert not bench.client.busy


@pytest.mark.parametrize(
    ("outcome", "why"),
    [(Outcome.ABORTED, "aborted: stuck"), (Outcome.CANCELLED, "cancelled by someone else: stuck")],
)
def test_a_goal_that_does_not_succeed_is_an_error(outcome: Outcome, why: str) -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.do(lambda: goal.handlers.ended(outcome, None, "stuck"))
    assert bench.told == [("error", why)]


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
    assert [text for _, text in bench.told] == ["no server within 5000 ms", "rejected", "the server is gone"]


def test_a_goal_accepted_too_late_is_cancelled_and_keeps_others_away() -> None:
    bench = Bench(ActionClient)
    bench.do(lambda: bench.client.start("goal"))
    goal = bench.port.goals[0]
    bench.wait(6)
    assert bench.told == [("error", "not accepted within 5000 ms")]
    assert bench.client.busy
    bench.do(goal.handlers.accepted)
    assert goal.cancels == 1
    bench.do(lambda: goal.handlers.ended(Outcome.CANCELLED, None, ""))
    assert not bench.client.busy
    assert bench.told[1:] == [("ended", None)]


def test_a_goal_that_nobody_answers_is_lost_at_last_and_cancelled_should_it_be_accepted_after_all() -> None:
    bench = Bench(ActionClient)
    bench.do(lambda: bench.client.start("goal"))
    goal = bench.port.goals[0]
    bench.wait(34)
    assert bench.client.busy
    bench.wait(2)
    assert not bench.client.busy
    assert bench.told == [("error", "not accepted within 5000 ms"), ("ended", None)]
    second = accepted(bench)
    bench.do(goal.handlers.accepted)
    assert (goal.cancels, second.cancels) == (1, 0)
    assert bench.client.busy


def test_time_for_a_server_and_for_its_acceptance_is_one() -> None:
    bench = Bench(ActionClient)
    bench.port.served = False
    bench.do(lambda: bench.client.start("goal"))
    bench.wait(4)
    bench.port.served = True
    bench.wait(2)
    assert bench.told == [("error", "not accepted within 5000 ms")]


def test_a_cancel_waits_for_acceptance_and_a_goal_may_still_succeed() -> None:
    bench = Bench(ActionClient)
    bench.do(lambda: bench.client.start("goal"))
    goal = bench.port.goals[0]
    bench.do(bench.client.cancel)
    assert goal.cancels == 0
    bench.do(goal.handlers.accepted)
    assert goal.cancels == 1
    bench.do(lambda: goal.handlers.feedback("half"))
    assert bench.client.busy
    bench.do(lambda: goal.handlers.ended(Outcome.SUCCEEDED, "there", ""))
    assert bench.told == [("feedback", "half"), ("response", "there")]


def test_a_refused_cancel_is_reported_and_the_goal_goes_on() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.do(bench.client.cancel)
    bench.do(goal.handlers.refused)
    assert bench.port.said == ["/light: the server refuses to cancel the goal"]
    assert bench.client.busy


def test_a_goal_whose_result_does_not_come_ends_with_the_timeout_whatever_is_asked_meanwhile() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.do(goal.handlers.over)
    bench.wait(4.9)
    assert bench.told == []
    bench.wait(0.1)
    assert bench.told == [("error", "the goal has ended, but its result did not come within 5000 ms")]
    goal = accepted(bench)
    bench.do(goal.handlers.over)
    bench.do(bench.client.cancel)
    bench.do(goal.handlers.refused)
    bench.wait(5)
    assert (bench.told[1:], goal.cancels, bench.client.busy) == ([("ended", None)], 0, False)


def test_an_interrupted_goal_ends_in_an_error() -> None:
    bench = Bench(ActionClient)
    goal = accepted(bench)
    bench.do(lambda: bench.client.cancel(expected=False))
    assert goal.cancels == 1
    bench.do(lambda: goal.handlers.ended(Outcome.CANCELLED, None, ""))
    assert bench.told == [("error", "cancelled by the controller itself, an error to the model")]


def test_a_goal_that_is_interrupted_before_it_is_sent_ends_in_the_same_error() -> None:
    bench = Bench(ActionClient)
    bench.port.served = False
    bench.do(lambda: bench.client.start("goal"))
    bench.do(lambda: bench.client.cancel(expected=False))
    assert bench.told == [("error", "cancelled by the controller itself, an error to the model")]


_GOAL_STEPS = st.lists(
    st.tuples(
        st.sampled_from(
            ("start", "cancel", "accepted", "rejected", "feedback", "over", "ended", "refused", "wait", "serve")
        ),
        st.integers(0, 9),
    ),
    max_size=40,
)


@given(_GOAL_STEPS)
def test_every_goal_comes_to_one_end(steps: list[tuple[str, int]]) -> None:
    bench = Bench(ActionClient)
    started = 0
    late = 0
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
        elif goal is not None and step in ("accepted", "rejected", "refused", "over"):
            bench.do(getattr(goal.handlers, step))
        elif goal is not None and step == "feedback":
            bench.do(lambda goal=goal, number=number: goal.handlers.feedback(number))
        elif goal is not None and step == "ended":
            outcome = list(Outcome)[number % 3]
            bench.do(lambda goal=goal, outcome=outcome: goal.handlers.ended(outcome, None, ""))
    bench.port.served = False
    bench.wait(3 * TIMEOUT)
    ends = [kind for kind, _ in bench.told if kind != "feedback"]
    late = sum(message == ("error", "not accepted within 5000 ms") for message in bench.told)
    assert not bench.client.busy
    assert len(ends) == started + late, "a goal not accepted in time is an error, and told again when it is over"
    assert all(goal.cancels <= 2 for goal in bench.port.goals)
