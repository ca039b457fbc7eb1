"""Servers of a controller: requests wait for their turn, and each accepted goal has exactly one end."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.run.runtime.core.cancel_requests import FAREWELL
from robosc.run.runtime.core.port import GoalOutcome

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.run.runtime.core.event_loop import EventLoop
    from robosc.run.runtime.core.port import Answer, Message, ServedGoal

#: Number of requests of one service that wait while another one is open.
MOST_WAITING = 10
#: Seconds that a stopping node waits at most until the middleware has the result of its goal.
_LAST_RESULT = 5.0
_REJECTED = "a goal is rejected: its data or the present state does not permit it"


class ServiceServer:
    """Server of one service: at most one request is open, and the next ones wait.

    `take` performs the event of a request, and returns whether it has happened; if not, the request has no response,
    because services of ROS 2 cannot refuse one.
    """

    def __init__(self, event_loop: EventLoop, take: Callable[[Message], bool], warn: Callable[[str], None]) -> None:
        self._event_loop = event_loop
        self._take = take
        self._warn = warn
        self._open: Answer | None = None
        self._waiting: deque[tuple[Message, Answer]] = deque()
        self._ended = False

    def call(self, request: Message, answer: Answer) -> None:
        """Handle a request: open it, or let it wait. If too many wait, drop the oldest of them."""
        self._waiting.append((request, answer))
        self._open_next()
        if len(self._waiting) > MOST_WAITING:
            self._waiting.popleft()
            self._warn(f"more than {MOST_WAITING} requests wait: the oldest one is dropped")

    def respond(self, response: Message) -> None:
        """Answer the open request; the next one follows after the present events."""
        answer, self._open = self._open, None
        assert answer is not None
        answer.give(response)
        self._event_loop.post(self._open_next)

    def leave(self) -> None:
        """Report the requests without a response when the node ends."""
        self._ended = True
        number = len(self._waiting) + (self._open is not None)
        if number:
            self._warn(f"requests without a response at the end of this node: {number}")

    def _open_next(self) -> None:
        if self._waiting and self._open is None and not self._ended:
            request, self._open = self._waiting.popleft()
            if not self._take(request):
                self._open = None
                self._event_loop.post(self._open_next)


@dataclass(frozen=True)
class GoalEvents:
    """Decisions and events of the controller for the goals of one action.

    `permits` returns whether a goal can be accepted now: none is open, and its event can happen. `take` performs the
    event of an accepted goal, and returns whether it has happened. `may_cancel` returns whether a client may cancel the
    goal now, and `cancel` performs that event. `default` returns a result with the defaults of ROS.
    """

    permits: Callable[[Message], bool]
    take: Callable[[Message], bool]
    may_cancel: Callable[[], bool]
    cancel: Callable[[], None]
    default: Callable[[], Message]


class ActionServer:
    """Server of one action, with one goal at a time."""

    def __init__(self, event_loop: EventLoop, events: GoalEvents, warn: Callable[[str], None]) -> None:
        self._event_loop = event_loop
        self._events = events
        self._warn = warn
        self._goal: ServedGoal | None = None
        self._aborted: ServedGoal | None = None
        self._until = 0.0

    def accepts(self, goal: Message) -> bool:
        """Return whether to accept a goal now; report a rejection."""
        permits = self._events.permits(goal)
        if not permits:
            self._warn(_REJECTED)
        return permits

    def begin(self, goal: ServedGoal, data: Message) -> None:
        """Perform the event of an accepted goal. Precondition: `accepts` has just returned True for its data."""
        self._goal = goal
        if not self._events.take(data):
            self.end(GoalOutcome.ABORTED, self._events.default())

    def cancel(self) -> bool:
        """Return whether a client may cancel the present goal; if so, the event follows after the answer to it."""
        goal = self._goal
        if goal is None or not self._events.may_cancel():
            return False
        self._event_loop.post(lambda: self._events.cancel() if self._goal is goal else None)
        return True

    def feed_back(self, feedback: Message) -> None:
        """Publish feedback on the present goal."""
        assert self._goal is not None
        self._goal.feed_back(feedback)

    def end(self, outcome: GoalOutcome, result: Message) -> None:
        """End the present goal."""
        goal, self._goal = self._goal, None
        assert goal is not None
        goal.end(outcome, result)

    @property
    def waits(self) -> bool:
        """Whether the stopping node waits until the client has the end of its goal."""
        if self._aborted is None:
            return False
        left = self._until - time.monotonic()
        return left > 0 or (not self._aborted.is_answered and left > -_LAST_RESULT)

    def leave(self) -> None:
        """Abort the present goal as the node ends."""
        if self._goal is not None:
            self._aborted, self._until = self._goal, time.monotonic() + FAREWELL
            self._warn("the goal is aborted because this node ends")
            self.end(GoalOutcome.ABORTED, self._events.default())
