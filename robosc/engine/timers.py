"""The times of a model that run: what is up, and what comes next."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.engine.interpreter import Engine
    from robosc.metamodel import sct


class Timers:
    """The timers of an engine's model on a clock of milliseconds that its caller reads.

    `resolution` is how much later than `now` it may really be: what starts counts from then, so that nothing is early.
    """

    def __init__(self, engine: Engine, resolution: int) -> None:
        self.now = 0
        self._resolution = resolution
        timers = list(engine.executed.timers)
        number = {timer: position for position, timer in enumerate(timers)}
        #: Whether the model has any.
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
        #: When each that runs is up, the numbers in the order of the text.
        self._up: dict[int, int] = {}
        for timer in timers:
            if timer.initial:
                self._start(number[timer])

    def at(self, now: int) -> None:
        """What follows happens at this time; where that is before what was said last, all that run start anew."""
        anew, self.now = now < self.now, now
        if anew:
            self.restart()

    def restart(self) -> None:
        """Starts all that run anew."""
        for number in self._up:
            self._start(number)

    def set_duration(self, duration: sct.Duration, milliseconds: int) -> None:
        """How long timers run that are started from now on, where that is set on the robot."""
        for number in self._set[duration]:
            self._length[number] = milliseconds

    def before(self, event: str) -> None:
        """Starts and stops timers as an event does that is about to happen."""
        self._up.pop(self._of.get(event, -1), None)
        for holds, left, starts in self._restarts.get(event, ()):
            if holds is None or holds():
                if left is not None:
                    self._up = {number: up for number, up in self._up.items() if self._plant[number] is not left}
                for number in starts:
                    self._start(number)

    @property
    def saved(self) -> tuple[int, Mapping[int, int]]:
        """What is the time, and what runs until when: `restore` goes back there."""
        return self.now, dict(self._up)

    def restore(self, saved: tuple[int, Mapping[int, int]]) -> None:
        """Goes back to what `saved` was."""
        self.now, self._up = saved[0], dict(saved[1])

    def expire(self) -> str | None:
        """The event of what is up, that which was up first, and which runs no longer; None where nothing is."""
        wait, number = self._next
        if wait is None or wait > 0:
            return None
        del self._up[number]
        return self._events[number]

    @property
    def wait(self) -> int | None:
        """How long until the next is up, 0 where one is; None where none runs."""
        wait, _ = self._next
        return None if wait is None else max(wait, 0)

    @property
    def running(self) -> dict[str, int]:
        """The events of those that run, in the order of the text, each with the time left."""
        return {self._events[number]: max(self._up[number] - self.now, 0) for number in sorted(self._up)}

    @property
    def _next(self) -> tuple[int | None, int]:
        if not self._up:
            return None, 0
        up, number = min((up, number) for number, up in self._up.items())
        return up - self.now, number

    def _start(self, number: int) -> None:
        self._up[number] = self.now + self._resolution + self._length[number]
