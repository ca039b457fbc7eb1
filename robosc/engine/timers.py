"""Running timers of a model: expired ones, and the time of the next."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.engine.interpreter import Engine
    from robosc.model import sct


class Timers:
    """Timers of an engine's model, on the caller's clock in milliseconds.

    `resolution` is the clock error in milliseconds. It is added to every timer so that none expires early.
    """

    def __init__(self, engine: Engine, resolution: int) -> None:
        self.now = 0
        self._resolution = resolution
        timers = list(engine.executed.timers)
        number = {timer: position for position, timer in enumerate(timers)}
        #: Whether the model has timers.
        self.exist = bool(timers)
        self._events = [timer.event.name for timer in timers]
        self._of = {event: position for position, event in enumerate(self._events)}
        self._length = [timer.milliseconds for timer in timers]
        self._set = {
            duration: [place for place, timer in enumerate(timers) if timer.duration is duration]
            for duration in engine.executed.model.durations
        }
        self._plant = [None if timer.location is None else timer.location.eContainer() for timer in timers]
        self._restarts = {
            event.name: [
                (
                    None if restart.condition is None else engine.condition(restart.condition),
                    restart.left,
                    [number[timer] for timer in restart.starts],
                )
                for restart in event.restarts
            ]
            for event in engine.executed.events
            if event.restarts
        }
        #: Expiry time of each running timer, by its number in the order of the text.
        self._up: dict[int, int] = {}
        for timer in timers:
            if timer.initial:
                self._start(number[timer])

    def at(self, now: int) -> None:
        """Set the time. If the clock went back, restart all running timers."""
        anew, self.now = now < self.now, now
        if anew:
            self.restart()

    def restart(self) -> None:
        """Restart all running timers."""
        for number in self._up:
            self._start(number)

    def set_duration(self, duration: sct.Duration, milliseconds: int) -> None:
        """Set the length of timers with a duration from a parameter, in milliseconds.

        Running timers are not affected.
        """
        for number in self._set[duration]:
            self._length[number] = milliseconds

    def before(self, event: str) -> None:
        """Start and stop timers for an event that is about to happen."""
        self._up.pop(self._of.get(event, -1), None)
        for holds, left, starts in self._restarts.get(event, ()):
            if holds is None or holds():
                if left is not None:
                    self._up = {number: up for number, up in self._up.items() if self._plant[number] is not left}
                for number in starts:
                    self._start(number)

    @property
    def saved(self) -> tuple[int, Mapping[int, int]]:
        """Time, and expiry times of the running timers. `restore` accepts them."""
        return self.now, dict(self._up)

    def restore(self, saved: tuple[int, Mapping[int, int]]) -> None:
        """Restore the time and the timers from `saved`."""
        self.now, self._up = saved[0], dict(saved[1])

    def expire(self) -> str | None:
        """Stop the timer that expired first and return its event, or None."""
        wait, number = self._next
        if wait is None or wait > 0:
            return None
        del self._up[number]
        return self._events[number]

    @property
    def wait(self) -> int | None:
        """Milliseconds until the next timer expires; 0 if one has expired. None if none runs."""
        wait, _ = self._next
        return None if wait is None else max(wait, 0)

    @property
    def running(self) -> dict[str, int]:
        """Events of the running timers in the order of the text, each with the remaining milliseconds."""
        return {self._events[number]: max(self._up[number] - self.now, 0) for number in sorted(self._up)}

    @property
    def _next(self) -> tuple[int | None, int]:
        if not self._up:
            return None, 0
        up, number = min((up, number) for number, up in self._up.items())
        return up - self.now, number

    def _start(self, number: int) -> None:
        self._up[number] = self.now + self._resolution + self._length[number]
