"""Requests to cancel a goal: repeated until the server accepts one."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.runtime.core.event_loop import EventLoop, Timer

#: Seconds that the end of a node waits for the end of a goal whose server has accepted to cancel it.
FAREWELL = 0.5
REFUSED = "the server refuses to cancel the goal"
CANCELING = "the server cancels the goal"


@dataclass(frozen=True)
class GoalTimes:
    """Seconds that a goal may take, but for its work.

    `timeout` bounds the search for a server together with the wait for acceptance, the wait for the answer to a cancel,
    and the wait for the result of a goal that has ended. A refused cancel is repeated after `retry`.
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
        #: Why the goal is not being canceled; empty where the server has accepted, or may still.
        self.trouble = ""

    @property
    def waits(self) -> bool:
        """Whether the end of the node waits: for an answer, then a little for the end of the goal."""
        return self.sent and not self._stopped and time.monotonic() < self._until

    def extend(self) -> None:
        """The end of the node waits for the answer as long as for one to a first request."""
        if not self.accepted:
            self._until = time.monotonic() + self._times.timeout

    def ask(self) -> None:
        """Sends a request, unless one was sent."""
        if not self.sent and not self.accepted and not self._stopped:
            self.sent = True
            self.extend()
            self._ask()

    def accept(self) -> None:
        """The server cancels the goal."""
        self._set_timer(None)
        self.accepted, self.trouble = True, ""
        self._until = time.monotonic() + FAREWELL

    def refuse(self, why: str = REFUSED) -> None:
        """The server does not cancel the goal; `why` is reported."""
        if self.accepted or self._stopped:
            return
        self._set_timer(self._ask, self._times.retry)
        self.trouble = why
        if why not in self._reported:
            self._reported.add(why)
            self._warn(why)

    def stop(self) -> None:
        """The goal has ended, or its end is known to come."""
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
