"""What a node does next: one thing at a time, from any thread or at a given time."""

from __future__ import annotations

import heapq
import threading
from collections import deque
from itertools import count
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


class Appointment:
    """Something that will be done at its time, unless it is called off."""

    def __init__(self, action: Callable[[], None]) -> None:
        self._action: Callable[[], None] | None = action

    def call_off(self) -> None:
        """It will not be done."""
        self._action = None

    def keep(self) -> None:
        """Does it, at most once."""
        action, self._action = self._action, None
        if action is not None:
            action()


class Agenda:
    """Calls from any thread and at given times, done one at a time by the thread that calls `work`.

    `clock` is what times are counted on, in seconds; one that `starts_late` stands at 0 until somebody tells its time.
    `wake`, if given, is called from any thread when there is more.
    """

    def __init__(
        self, clock: Callable[[], float], wake: Callable[[], None] | None = None, *, starts_late: bool = False
    ) -> None:
        self.clock = clock
        self._wake = wake
        self._posted: deque[tuple[str | None, Callable[[], None]]] = deque()
        self._changed = threading.Condition()
        self._appointments: list[tuple[float, int, Appointment]] = []
        self._numbers = count()
        self._last = clock()
        self._told = self._last != 0 or not starts_late

    def post(self, action: Callable[[], None], topic: str | None = None, most: int = 10) -> None:
        """Something to do after all that was posted before. Of one topic at most so many wait; the oldest gives way."""
        with self._changed:
            if topic is not None:
                waiting = [each for each in self._posted if each[0] == topic]
                if len(waiting) >= most:
                    self._posted.remove(waiting[0])
            self._posted.append((topic, action))
            self._changed.notify()
        if self._wake is not None:
            self._wake()

    def after(self, seconds: float, action: Callable[[], None]) -> Appointment:
        """Something to do so many seconds from now; only from the thread that works."""
        appointment = Appointment(action)
        now = self._time()  # may move what is planned
        heapq.heappush(self._appointments, (now + seconds, next(self._numbers), appointment))
        return appointment

    def work(self) -> float | None:
        """Does what is due; then the seconds until more is, None where nothing is planned.

        What is posted meanwhile is done too, once: a call that posts itself does not keep others from their turn.
        """
        for _ in range(len(self._posted)):
            with self._changed:
                if not self._posted:
                    break
                _, action = self._posted.popleft()
            action()
        now = self._time()
        while self._appointments and self._appointments[0][0] <= now:
            heapq.heappop(self._appointments)[2].keep()
        if self._posted:
            return 0.0
        return max(0.0, self._appointments[0][0] - now) if self._appointments else None

    def _time(self) -> float:
        """The time. Where the clock was set back, or started late, what is planned stays as far away as it was."""
        now = self.clock()
        shift = now - self._last
        if shift < 0 or not self._told:
            self._appointments = [(time + shift, number, each) for time, number, each in self._appointments]
        self._last = now
        self._told = self._told or now != 0
        return now

    def wait(self, seconds: float) -> None:
        """Waits until something is posted, at most so long."""
        with self._changed:
            if not self._posted:
                self._changed.wait(seconds)

    def poke(self) -> None:
        """Ends a wait: the clock has changed."""
        with self._changed:
            self._changed.notify()
