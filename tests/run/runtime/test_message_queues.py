"""Order and fairness of arrived messages, over an executor with an event for each message."""

from __future__ import annotations

from collections import Counter, deque
from functools import partial
from typing import TYPE_CHECKING

import pytest

from robosc.run.runtime.core.message_queues import MOST_AT_ONCE, MOST_ROUNDS, MessageQueue, MessageQueues

if TYPE_CHECKING:
    from collections.abc import Callable


class Middleware:
    """Topics and an executor in one thread. `handled` holds the topics and numbers of handled messages in order."""

    def __init__(self, *topics: str, depth: int = 100_000) -> None:
        self.handled: list[tuple[str, int]] = []
        self.waits: list[float] = []
        #: Called for each handled message.
        self.hook: Callable[[], None] = lambda: None
        self._events: deque[Callable[[], None]] = deque()
        self._pending: dict[str, deque[int]] = {topic: deque(maxlen=depth) for topic in topics}
        self._sent: Counter[str] = Counter()
        self.queues = MessageQueues(self._spin_once, self.post)
        self.queue = {topic: MessageQueue(partial(self._handle, topic), self._taker(topic), depth) for topic in topics}
        for queue in self.queue.values():
            self.queues.add(queue)

    def run_once(self) -> None:
        self.queues.run_once(lambda: 1)

    def publish(self, topic: str, times: int = 1) -> None:
        for _ in range(times):
            self._sent[topic] += 1
            self._pending[topic].append(self._sent[topic])  # drops the oldest ones
            self._events.append(lambda: self._take_event(topic))

    def post(self, work: Callable[[], None]) -> None:
        self._events.append(work)

    def topics(self) -> str:
        return "".join(topic[0] for topic, _ in self.handled)

    def _taker(self, topic: str) -> Callable[[], int | None]:
        return lambda: self._pending[topic].popleft() if self._pending[topic] else None

    def _take_event(self, topic: str) -> None:
        if self._pending[topic]:
            self.queue[topic].store(self._pending[topic].popleft())

    def _handle(self, topic: str, number: int) -> None:
        self.handled.append((topic, number))
        self.hook()

    def _spin_once(self, wait: float) -> None:
        self.waits.append(wait)
        if self._events:
            self._events.popleft()()


def test_a_rare_message_comes_before_frequent_ones() -> None:
    ros = Middleware("scan", "button", "correction")
    ros.publish("scan", 30)
    ros.publish("correction", 5)
    ros.run_once()
    ros.handled.clear()
    ros.publish("correction")
    ros.publish("button")
    ros.run_once()
    assert ros.topics() == "bc" + MOST_AT_ONCE * "s"


def test_a_topic_that_was_frequent_once_is_rare_again() -> None:
    ros = Middleware("button", "scan")
    ros.publish("button", 1000)
    while len(ros.handled) < 1000:
        ros.run_once()
    for _ in range(100):
        ros.publish("scan", 2)
        ros.run_once()
    ros.handled.clear()
    ros.publish("scan", 3)
    ros.publish("button")
    ros.run_once()
    assert ros.topics() == "bsss"


def test_a_flood_on_one_topic_delays_others_by_one_turn() -> None:
    ros = Middleware("scan", "button")
    ros.hook = lambda: ros.publish("scan", 2 if len(ros.handled) < 5000 else 0)
    ros.publish("scan")
    gaps = []
    for _ in range(100):
        ros.publish("button")
        before = len(ros.handled)
        ros.run_once()
        gaps.append([topic for topic, _ in ros.handled[before:]].index("button"))
    assert max(gaps) <= MOST_AT_ONCE
    assert not any(gaps[1:])


def test_other_work_does_not_wait_behind_events_of_taken_messages() -> None:
    ros = Middleware("scan")
    ros.publish("scan", 300)
    ros.queues.empty()
    assert len(ros.handled) == 300
    done: list[str] = []
    ros.post(lambda: done.append("call"))
    ros.run_once()
    ros.run_once()
    assert done == ["call"]
    assert ros.waits[-1] == 1


def test_other_work_is_done_during_a_flood() -> None:
    ros = Middleware("scan", depth=5)
    # While the node handles a message, three more arrive. The middleware drops messages, but not their events.
    ros.hook = lambda: ros.publish("scan", 3)
    ros.publish("scan", 3)
    for _ in range(100):
        done: list[str] = []
        ros.post(partial(done.append, "call"))
        ros.run_once()
        ros.run_once()
        assert done == ["call"]


@pytest.mark.parametrize("times", [1, 7, MOST_AT_ONCE * 3 + 1])
def test_each_message_is_handled_once_and_in_order(times: int) -> None:
    ros = Middleware("scan", "button")
    for _ in range(5):
        ros.publish("scan", times)
        ros.run_once()
        ros.publish("button")
        ros.run_once()
    while ros.waits[-1] != 1:
        ros.run_once()
    assert [number for topic, number in ros.handled if topic == "scan"] == list(range(1, 5 * times + 1))
    assert [number for topic, number in ros.handled if topic == "button"] == list(range(1, 6))


def test_a_timer_waits_for_a_limited_number_of_messages() -> None:
    ros = Middleware("scan")
    ros.hook = lambda: ros.publish("scan")
    ros.publish("scan")
    ros.queues.empty()
    assert len(ros.handled) == MOST_AT_ONCE * MOST_ROUNDS


def test_a_queue_drops_its_oldest_messages() -> None:
    ros = Middleware("scan", depth=3)
    for number in range(5):
        ros.queue["scan"].store(number)
    ros.queues.empty()
    assert [number for _, number in ros.handled] == [2, 3, 4]


def test_a_removed_queue_handles_what_it_stores() -> None:
    ros = Middleware("scan")
    ros.queue["scan"].store(1)
    ros.queues.remove(ros.queue["scan"])
    ros.publish("scan")
    ros.queues.empty()
    assert ros.handled == [("scan", 1)]


def test_an_executor_that_waits_for_all_at_once_is_called_once() -> None:
    waits: list[float] = []
    queues = MessageQueues(waits.append, None)
    messages = deque(range(MOST_AT_ONCE + 3))
    queues.add(MessageQueue(lambda _: None, lambda: messages.popleft() if messages else None, 5))
    queues.run_once(lambda: 1)
    queues.run_once(lambda: 1)
    assert waits == [0, 1]


def test_a_message_costs_one_round() -> None:
    """The executor waits again right after a message that it has taken."""
    ros = Middleware("scan", "button")
    rounds = 0

    def pending() -> float:
        nonlocal rounds
        rounds += 1
        return 1

    ros.queues.run_once(pending)
    for _ in range(5):
        ros.queue["scan"].store(1)
        ros.queues.run_once(pending)
    assert (rounds, ros.waits) == (6, [1] * 6)


def test_planned_work_is_done_during_a_flood() -> None:
    ros = Middleware("scan", depth=5)
    ros.hook = lambda: ros.publish("scan", 3)
    ros.publish("scan", 3)
    done: list[int] = []
    for number in range(100):
        ros.queues.run_once(lambda number=number: done.append(number) or 1)  # type: ignore[misc]
    assert done == list(range(100))
