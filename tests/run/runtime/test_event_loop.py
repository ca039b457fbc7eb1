"""The next action of a node's event loop."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robosc.run.runtime.core.event_loop import EventLoop


class Clock:
    def __init__(self, now: float = 10.0) -> None:
        self.now = now

    def __call__(self) -> float:
        return self.now


def test_does_what_was_posted_in_order_and_what_is_planned_at_its_time() -> None:
    clock, done = Clock(), []
    event_loop = EventLoop(clock)
    event_loop.post(lambda: done.append("first"))
    event_loop.post(lambda: done.append("second"))
    event_loop.call_later(1.0, lambda: done.append("later"))
    event_loop.call_later(0.5, lambda: done.append("soon"))
    assert event_loop.run_pending() == pytest.approx(0.5)
    assert done == ["first", "second"]
    clock.now += 2
    assert event_loop.run_pending() is None
    assert done == ["first", "second", "soon", "later"]


def test_what_is_called_off_is_not_done() -> None:
    clock = Clock()
    event_loop = EventLoop(clock)
    event_loop.call_later(1.0, lambda: pytest.fail("called off")).cancel()
    clock.now += 2
    event_loop.run_pending()


def test_what_posts_itself_lets_others_have_their_turn() -> None:
    event_loop, done = EventLoop(Clock()), []

    def again() -> None:
        event_loop.post(again)
        done.append("again")

    again()
    event_loop.call_later(0.0, lambda: done.append("planned"))
    assert event_loop.run_pending() == 0.0
    assert done == ["again", "again", "planned"]


@pytest.mark.parametrize(("before", "now"), [(100.0, 0.0), (100.0, 99.5), (0.0, 1.0), (0.0, 1795184703.0)])
def test_a_clock_that_is_set_keeps_what_is_planned_as_far_away(before: float, now: float) -> None:
    clock, done = Clock(before), []
    event_loop = EventLoop(clock, starts_late=True)
    event_loop.call_later(1.0, lambda: done.append("planned"))
    clock.now = now
    assert event_loop.run_pending() == pytest.approx(1.0)
    clock.now += 1.5
    event_loop.run_pending()
    assert done == ["planned"]


def test_a_clock_that_starts_at_zero_is_believed() -> None:
    clock, done = Clock(0.0), []
    event_loop = EventLoop(clock)
    event_loop.call_later(1.0, lambda: done.append("planned"))
    clock.now = 1.0
    event_loop.run_pending()
    assert done == ["planned"]


@given(st.lists(st.integers(0, 80).map(lambda eighths: eighths / 8), min_size=1, max_size=20))
def test_nothing_is_early_nothing_is_lost(delays: list[float]) -> None:
    clock, done = Clock(), []
    event_loop = EventLoop(clock)
    for delay in delays:
        event_loop.call_later(delay, lambda delay=delay: done.append((delay, clock.now - 10.0)))
    while (left := event_loop.run_pending()) is not None:
        clock.now += left
    assert sorted(delay for delay, _ in done) == sorted(delays)
    assert all(passed >= delay - 1e-9 for delay, passed in done)
    assert [delay for delay, _ in done] == sorted(delay for delay, _ in done)


def test_what_begins_with_the_clock_begins_when_it_has_started() -> None:
    clock, done = Clock(0.0), []
    event_loop = EventLoop(clock, starts_late=True)
    event_loop.at_start(lambda: done.append(clock.now))
    event_loop.run_pending()
    assert done == []
    for clock.now in (0.002, 1.0):
        event_loop.run_pending()
    assert done == [0.002]
