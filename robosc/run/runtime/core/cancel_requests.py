"""Requests to cancel a goal: repeated until the server accepts one."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.run.runtime.core.event_loop import EventLoop, Timer

#: Seconds that a stopping node waits for the end of a goal whose server has accepted to cancel it.
FAREWELL = 0.5
REFUSED = "the server refuses to cancel the goal"
CANCELING = "the server cancels the goal"


@dataclass(frozen=True)
class GoalTimes:
    """Time limits of a goal in seconds, without the time for its work.

    `timeout` bounds the search for a server together with the wait for acceptance, the wait for the answer to a cancel
    request, and the wait for the result of a goal that has ended. A refused cancel request is repeated after `retry`.
    """

    timeout: float
    retry: float

    @property
    def within(self) -> str:
        """The timeout in words, as `within 5000 ms`."""
        return f"within {round(self.timeout * 1000)} ms"


class CancelRequests:
    """The requests to cancel one goal.

    `send` sends one. No answer in time counts as a refusal. `warn` reports each kind of refusal once. After an accepted
    request, and after `stop`, nothing is sent.
    """

    def __init__(
        self, event_loop: EventLoop, times: GoalTimes, send: Callable[[], None], warn: Callable[[str], None]
    ) -> None:
        self._event_loop = event_loop
        self._times = times
        self._send = send
        self._warn = warn
        self._reported: set[str] = set()
        self._timer: Timer | None = None
        self._stopped = False
        self._until = 0.0
        #: Whether a request was sent, and whether the server has accepted one.
        self.sent = self.accepted = False
        #: Why the goal is not being canceled; empty if the server has accepted, or may still accept.
        self.trouble = ""

    @property
    def waits(self) -> bool:
        """Whether the stopping node waits: for an answer, then briefly for the end of the goal."""
        return self.sent and not self._stopped and time.monotonic() < self._until

    def extend(self) -> None:
        """Restart the time that a stopping node waits for the answer to a request."""
        if not self.accepted:
            self._until = time.monotonic() + self._times.timeout

    def ask(self) -> None:
        """Send a request, unless one was sent before."""
        if not self.sent and not self.accepted and not self._stopped:
            self.sent = True
            self.extend()
            self._ask()

    def accept(self) -> None:
        """Record that the server cancels the goal."""
        self._set_timer(None)
        self.accepted, self.trouble = True, ""
        self._until = time.monotonic() + FAREWELL

    def refuse(self, why: str = REFUSED) -> None:
        """Record that the server does not cancel the goal, report `why`, and plan the next request."""
        if self.accepted or self._stopped:
            return
        self._set_timer(self._ask, self._times.retry)
        self.trouble = why
        if why not in self._reported:
            self._reported.add(why)
            self._warn(why)

    def stop(self) -> None:
        """Send no more requests: the goal has ended, or its end is imminent."""
        self._stopped, self.trouble = True, ""
        self._set_timer(None)

    def _ask(self) -> None:
        late = f"the server does not answer the request to cancel the goal {self._times.within}"
        self._set_timer(lambda: self.refuse(late), self._times.timeout)
        self._send()

    def _set_timer(self, action: Callable[[], None] | None, seconds: float | None = None) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        if action is not None and seconds is not None:
            self._timer = self._event_loop.call_later(seconds, action)
