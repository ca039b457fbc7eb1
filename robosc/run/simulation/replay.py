"""Run of a robot by a script, an event log or a trace, or at random, forwards and backwards."""

from __future__ import annotations

from dataclasses import dataclass, replace
from random import Random
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.engine.timers import Timers
from robosc.engine.transitions import Transitions
from robosc.run.simulation.script import REFUSE, WAIT
from robosc.run.simulation.simulation import refusal

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.engine import Blocked
    from robosc.engine.state import State
    from robosc.model import sct
    from robosc.run.simulation import ScriptStep, Simulation
    from robosc.run.simulation.unreadable import Unreadable


class _Position(NamedTuple):
    """Position in a script: the next step, the end of its wait, and the timers."""

    next: int
    until: int | None
    timers: tuple[int, Mapping[int, int]]


_START = _Position(0, None, (0, {}))


@dataclass(frozen=True)
class Moment:
    """Step of the run: an event that happened or was blocked (`by`), a passage of time, or a refusal to cancel.

    `line` is that of the script; `edges` are the transitions that components took.
    """

    event: str
    data: Mapping[str, Any]
    before: State
    after: State
    line: int | None = None
    by: Blocked | Unreadable | None = None
    edges: tuple[sct.Edge, ...] = ()
    start: _Position = _START
    end: _Position = _START

    @property
    def happened(self) -> bool:
        """Whether an event happened."""
        return self.by is None and self.event not in (WAIT, REFUSE)


class Replay:
    """Player of the `steps` of a script; None means random events, the same for the same seed.

    Steps that were taken back are played again first, unless another event was injected meanwhile.
    """

    def __init__(
        self,
        simulation: Simulation,
        steps: Sequence[ScriptStep] | None = None,
        seed: int = 0,
        choose: Callable[[Random], tuple[str, dict[str, Any]] | None] | None = None,
    ) -> None:
        """`choose` returns a random event with its data; the default is the choice of the simulation."""
        self.simulation = simulation
        self._choose = choose or simulation.random_event
        self.engine = self.simulation.engine
        self.timers = Timers(self.engine, 0)
        self.steps = steps
        self.past: list[Moment] = []
        self._future: list[Moment] = []
        self._random = Random(seed)  # noqa: S311
        self._next = 0
        #: End of the present wait; None outside of a wait.
        self._until: int | None = None
        self._transitions = Transitions(self.engine)
        self._started = next((step.time for step in steps or () if step.time is not None), 0.0)

    @property
    def is_over(self) -> bool:
        """Whether all of the script has been played."""
        return self.steps is not None and self._next == len(self.steps) and not self._future

    @property
    def next_line(self) -> int | None:
        """The line of the next step of the script; None if there is none."""
        if self._future:
            return self._future[-1].line
        return self.steps[self._next].line if self.steps is not None and self._next < len(self.steps) else None

    @property
    def has_future(self) -> bool:
        """Whether steps were taken back that can be played again."""
        return bool(self._future)

    def freely(self) -> None:
        """Leave the script and the steps taken back: injected or random events follow."""
        self.steps, self._until = None, None
        self._future.clear()

    def forward(self) -> Moment | None:
        """Play the next step and return it; None if no step is left, or nothing can happen."""
        if self._future:
            again = self._future.pop()
            if again.happened:
                self._perform(again.event, again.data)
            self._go_to(again.end)
            self.past.append(again)
            return again
        if self.steps is not None:
            return self._scripted(self.steps)
        chosen = self._choose(self._random)
        return None if chosen is None else self._keep(self._here, self._perform(*chosen))

    def back(self) -> Moment | None:
        """Take the last step back and return it; None if there is none."""
        if not self.past:
            return None
        moment = self.past.pop()
        if moment.happened:
            self.simulation.undo()
        self._go_to(moment.start)
        self._future.append(moment)
        return moment

    def inject(self, event: str, data: Mapping[str, Any]) -> Moment:
        """Perform an event outside of the script if it is enabled, else change nothing. Raises DataError."""
        self.simulation.data.check(event, data)
        here = self._here
        moment = self._perform(event, data)
        if not moment.happened:
            return moment
        self._future.clear()
        return self._keep(here, moment)

    def let_go_by(self, seconds: float) -> list[Moment]:
        """Let time pass; timers that expire on the way fire at their time. A wait of the script keeps its end."""
        self._future.clear()
        scripted, self._until = self._until, self.timers.now + _milliseconds(seconds)
        moments: list[Moment] = []
        while not moments or moments[-1].event != WAIT:
            assert self._until is not None
            here, moment = self._here, self._wait(self._until)
            if moment.event == WAIT and scripted is not None:
                is_over = scripted <= self.timers.now
                self._next += is_over
                self._until = None if is_over else scripted
            moments.append(self._keep(here, moment))
        return moments

    def _scripted(self, steps: Sequence[ScriptStep]) -> Moment | None:
        if self._next == len(steps):
            return None
        step, here = steps[self._next], self._here
        if step.event == WAIT:
            if self._until is None:
                self._until = self.timers.now + _milliseconds(step.data["seconds"])
            moment = self._wait(self._until, step.line)
            self._next += self._until is None
            return self._keep(here, moment)
        if step.time is not None:
            self.timers.at(max(self.timers.now, _milliseconds(step.time - self._started)))
        self._next += 1
        return self._keep(here, self._perform(step.event, step.data, step.line))

    def _wait(self, until: int, line: int | None = None) -> Moment:
        """Let time pass to the next expiry, else to `until`, which ends the wait."""
        wait = self.timers.wait
        if wait is not None and self.timers.now + wait <= until:
            self.timers.at(self.timers.now + wait)
            event = self.timers.expire()
            assert event is not None
            return self._perform(event, {}, line)
        self.timers.at(until)
        self._until = None
        return Moment(WAIT, {}, self.engine.state, self.engine.state, line)

    def _perform(self, event: str, data: Mapping[str, Any], line: int | None = None) -> Moment:
        before = self.engine.state
        if event == REFUSE:
            return Moment(event, dict(data), before, before, line, refusal(self.engine, data["of"]))
        self.engine.set_inputs(event, self.simulation.data.inputs(event, data))
        by = (
            self.engine.blocked_by(event)
            or self.engine.inputs_blocked_by(event)
            or self.simulation.data.unreadable(event, data)
        )
        edges: tuple[sct.Edge, ...] = ()
        if by is None:
            edges = self._transitions.taken_transitions(event)
            self.timers.before(event)
            self.simulation.perform(event, data)
        return Moment(event, dict(data), before, self.engine.state, line, by, edges)

    def _keep(self, start: _Position, moment: Moment) -> Moment:
        self.past.append(replace(moment, start=start, end=self._here))
        return self.past[-1]

    @property
    def _here(self) -> _Position:
        return _Position(self._next, self._until, self.timers.saved)

    def _go_to(self, position: _Position) -> None:
        self._next, self._until = position.next, position.until
        self.timers.restore(position.timers)


def _milliseconds(seconds: float) -> int:
    return round(seconds * 1000)
