"""Event loop of a node: runs one call at a time, posted from any thread or planned for a given time."""

from __future__ import annotations

import heapq
from collections import deque
from itertools import count
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


class Timer:
    """Call that is made once, at its time, unless it is canceled before."""

    def __init__(self, action: Callable[[], None]) -> None:
        self._action: Callable[[], None] | None = action

    def cancel(self) -> None:
        """Cancel the call."""
        self._action = None

    def fire(self) -> None:
        """Make the call, at most once."""
        action, self._action = self._action, None
        if action is not None:
            action()


class EventLoop:
    """Make calls one at a time, in the thread that calls `run_pending`.

    `clock` returns the time in seconds. A clock that `starts_late` stands at 0 until it receives the time, as the clock
    of a simulation does.
    """

    def __init__(self, clock: Callable[[], float], *, starts_late: bool = False) -> None:
        self.clock = clock
        self._posted: deque[Callable[[], None]] = deque()
        self._timers: list[tuple[float, int, Timer]] = []
        self._numbers = count()
        self._last = clock()
        self._started = self._last != 0 or not starts_late
        self._at_start: deque[Callable[[], None]] = deque()

    def post(self, action: Callable[[], None]) -> None:
        """Make a call after all that were posted before; from any thread."""
        self._posted.append(action)

    def call_later(self, seconds: float, action: Callable[[], None]) -> Timer:
        """Make a call after some seconds; only from the loop's own thread."""
        timer = Timer(action)
        now = self._time()  # may move planned calls
        heapq.heappush(self._timers, (now + seconds, next(self._numbers), timer))
        return timer

    def at_start(self, action: Callable[[], None]) -> None:
        """Make a call as soon as the clock has started; only from the loop's own thread."""
        self._at_start.append(action)

    def run_pending(self) -> float | None:
        """Make all calls that are due; return the seconds until the next one, None if none is planned.

        Calls posted before the start of this run are made once: a call that posts itself does not delay others.
        """
        for _ in range(len(self._posted)):
            self._posted.popleft()()
        now = self._time()
        while self._started and self._at_start:
            self._at_start.popleft()()
        while self._timers and self._timers[0][0] <= now:
            heapq.heappop(self._timers)[2].fire()
        if self._posted:
            return 0.0
        return max(0.0, self._timers[0][0] - now) if self._timers else None

    def _time(self) -> float:
        """Return the time. If the clock was set back or started late, keep the remaining time of all timers."""
        now = self.clock()
        shift = now - self._last
        if shift < 0 or not self._started:
            self._timers = [(time + shift, number, timer) for time, number, timer in self._timers]
        self._last = now
        self._started = self._started or now != 0
        return now
