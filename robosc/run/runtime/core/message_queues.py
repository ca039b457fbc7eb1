"""Queues of arrived messages: topics with little traffic first, and no topic keeps another one waiting."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.run.runtime.core.port import Message

#: Messages of a topic handled in its turn, and rounds of turns before an expired timer.
MOST_AT_ONCE = 10
MOST_ROUNDS = 100
#: Events that the executor handles at most between two rounds.
MOST_EVENTS = 10_000
#: Weight of the last turn in the traffic of a topic.
_NEWEST = 1 / 16


class MessageQueue:
    """Arrived messages of one subscription.

    `receive` handles a message. `take` returns the next one that the middleware stores, None if there is none. `depth`
    is the number of messages that the queue stores by itself; like the middleware, it drops the oldest ones.
    """

    def __init__(self, receive: Callable[[Message], None], take: Callable[[], Message | None], depth: int) -> None:
        self.receive = receive
        self.take = take
        self.stored: deque[Message] = deque(maxlen=max(depth, 1))
        #: Messages per turn, of the last turns.
        self.traffic = 0.0

    def store(self, message: Message) -> None:
        """Store a message that the executor has taken, until the next turn."""
        self.stored.append(message)


class MessageQueues:
    """All queues of a node, handled in rounds of turns, and the executor that does all other work.

    `spin_once` lets the executor handle one item, and waits for it at most the given seconds. An executor that has a
    queue of events also has one for each message that was taken here or dropped. An event of a taken message is without
    effect, but other work waits behind it. `post` adds a call to that queue; it is None for an executor without one.
    """

    def __init__(
        self, spin_once: Callable[[float], object], post: Callable[[Callable[[], None]], object] | None
    ) -> None:
        self._spin_once = spin_once
        self._post = post
        self._queues: list[MessageQueue] = []
        #: Whether a turn of the last round ended before its queue was empty.
        self._full = False
        #: Whether messages were taken here whose events the executor may still have.
        self._behind = False

    def add(self, queue: MessageQueue) -> None:
        """Handle the messages of a queue from now on."""
        self._queues.append(queue)

    def remove(self, queue: MessageQueue) -> None:
        """Handle the stored messages of a queue, and no others."""
        self._queues.remove(queue)
        while queue.stored:
            queue.receive(queue.stored.popleft())

    def run_once(self, pending: Callable[[], float]) -> None:
        """Give each queue a turn, then do other work, then let the executor work.

        `pending` does all work that is due and returns how many seconds the executor may wait for more.
        """
        self._round()
        wait = pending()
        if self._behind and self._post is not None:
            self._catch_up(self._post)
        else:
            self._spin_once(0 if self._full else wait)

    def _catch_up(self, post: Callable[[Callable[[], None]], object]) -> None:
        """Let the executor handle all events that it has now."""
        self._behind = False
        reached: list[bool] = []
        post(lambda: reached.append(True))
        for _ in range(MOST_EVENTS):
            self._spin_once(0)
            if reached:
                return

    def empty(self) -> None:
        """Handle all messages that have arrived, up to a limit of rounds."""
        for _ in range(MOST_ROUNDS):
            if not self._round():
                return

    def _round(self) -> int:
        """Give each queue a turn, those with the least traffic first; return the number of handled messages."""
        turns = [self._turn(queue) for queue in sorted(self._queues, key=lambda queue: queue.traffic)]
        self._full = MOST_AT_ONCE in turns
        return sum(turns)

    def _turn(self, queue: MessageQueue) -> int:
        handled = 0
        while handled < MOST_AT_ONCE and (message := self._next(queue)) is not None:
            queue.receive(message)
            handled += 1
        queue.traffic += (handled - queue.traffic) * _NEWEST
        return handled

    def _next(self, queue: MessageQueue) -> Message | None:
        if queue.stored:
            return queue.stored.popleft()
        message = queue.take()
        if message is not None:
            self._behind = True
        return message
