"""Timers of a model on the clock of a node, and the one alarm for the next of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.engine.timers import Timers
    from robosc.run.runtime.core.event_loop import EventLoop, Timer

#: The clock is read in whole milliseconds, rounded down.
RESOLUTION_MS = 1


class Times:
    """Set the control loop's clock on entry of a `with` block, and the alarm for its next timer on exit.

    The alarm calls `expire`. A clock that stands at 0 has not begun; its first other time starts all timers.
    """

    def __init__(self, timers: Timers, event_loop: EventLoop, expire: Callable[[], None]) -> None:
        self._timers = timers
        self._event_loop = event_loop
        self._expire = expire
        self._alarm: Timer | None = None
        self._up = 0
        self._begun = False

    def start(self) -> None:
        """Start all timers as the node begins to work."""
        self._begun = False
        self._go_on()
        self._event_loop.at_start(self._go_on)

    def _go_on(self) -> None:
        with self:
            pass

    def __enter__(self) -> None:
        if not self._timers.exist:
            return
        self._timers.at(int(self._event_loop.clock() * 1000))
        if not self._begun:
            self._timers.restart()
            self._begun = self._timers.now != 0

    def __exit__(self, *_: object) -> None:
        wait = self._timers.wait
        if wait is None:
            return
        up = self._timers.now + wait
        if self._alarm is None or up < self._up:
            if self._alarm is not None:
                self._alarm.cancel()
            self._up = up
            self._alarm = self._event_loop.call_later(wait / 1000, self._ring)

    @property
    def due(self) -> bool:
        """Whether a timer has expired by now, even if the event loop has not called for it yet."""
        with self:
            return self._timers.wait == 0

    def _ring(self) -> None:
        self._alarm = None
        self._expire()
