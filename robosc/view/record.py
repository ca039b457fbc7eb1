"""What has happened in a run, moment by moment: events, states, and which commands are forbidden by what."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

from robosc.analysis.blocking_in_words import counterexample_in_words
from robosc.analysis.explain import explain, explored, state_given
from robosc.analysis.wording import in_words, words
from robosc.semantics.roles import Roles, event_name
from robosc.simulation.replay import Replay
from robosc.simulation.script import WAIT
from robosc.simulation.simulation import whole_state
from robosc.view.description import automata_of, commands_of, transitions_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.engine.state import State
    from robosc.simulation import Simulation, Step
    from robosc.simulation.replay import Moment

#: What an action does to a run, with what it needs.
ACTIONS = ("perform", "wait", "undo", "redo", "random", "restart", "continue")
#: So many random events one action may ask for.
_MOST_AT_ONCE = 1000
#: In seconds.
_LONGEST_WAIT = 3600


class ActionError(Exception):
    """An action that can't be done: the message says why."""


class Record:
    """The moments of a run: the first is the start. `steps` is what is played, at once; None: nothing.

    Each moment is JSON data: `time` in seconds, `event`, `words`, `data`, `by` and `reason` where it was kept from
    happening, `transitions` taken as pairs of automaton and transition, and what has changed against the moment before:
    `state`, `commands` (null: allowed, else `by` and `reason`), `enabled` (of all events), `timers` (in milliseconds).
    """

    def __init__(self, simulation: Simulation, steps: Sequence[Step] | None = None, seed: int = 0) -> None:
        self._simulation = simulation
        self._engine = simulation.engine
        self._model = simulation.engine.model
        self._seed = seed
        self._events = {event_name(event): event for event in Roles(self._model).events}
        self._commands = [event_name(event) for event in commands_of(self._model)]
        self._numbers = {
            edge: (number, position)
            for number, plant in enumerate(automata_of(self._model))
            for position, edges in enumerate(transitions_of(plant))
            for edge in edges
        }
        self._explained: dict[tuple[str, State], dict[str, Any]] = {}
        self._changed = asyncio.Condition()
        #: Where moments were taken back: how many were left, each time.
        self.cuts: list[int] = []
        self.moments: list[dict[str, Any]] = []
        self._states: list[State] = []
        self._wholes: list[dict[str, Any]] = []
        self._replay = Replay(simulation, steps, seed)
        self._add(None)
        while steps is not None and (moment := self._replay.forward()) is not None:
            self._add(moment)

    # What happens

    def do(self, action: Any) -> None:
        """Does an action: an object with `action`, one of ACTIONS, and what it needs. Raises ActionError, DataError."""
        match action:
            case {"action": "perform", "event": str(event), **rest} if event in self._events:
                self._perform(event, rest.get("inputs"), rest.get("data"))
            case {"action": "wait", "seconds": int() | float() as seconds} if 0 <= seconds <= _LONGEST_WAIT:
                self._wait(seconds)
            case {"action": "random", "number": int(number)} if 0 < number <= _MOST_AT_ONCE:
                self._replay.freely()
                self._forward(number)
            case {"action": "continue", "moment": int(moment)} if 0 <= moment < len(self.moments):
                self._back_to(moment)
            case {"action": "undo"}:
                self._undo()
            case {"action": "redo"}:
                self._redo()
            case {"action": "restart"}:
                self._back_to(0)
            case _:
                raise ActionError(f"an action is one of {', '.join(ACTIONS)}, with what it needs: {json.dumps(action)}")

    def _wait(self, seconds: float) -> None:
        for moment in self._replay.let_go_by(seconds):
            self._add(moment)

    def _undo(self) -> None:
        if self._replay.back() is not None:
            self._cut(len(self.moments) - 1)

    def _redo(self) -> None:
        if self._replay.has_future:
            self._forward(1)

    def _perform(self, event: str, inputs: object, data: object) -> None:
        """Lets an event happen, with values of its inputs by their names, or data in the shape of the event log."""
        if isinstance(inputs, dict):
            known = {one.name for one in self._events[event].inputs}
            if set(inputs) != known:
                raise ActionError(f"{event} has the inputs {', '.join(sorted(known)) or '(none)'}")
            data = self._simulation.data.shaped(event, inputs) if inputs else {}
        if not isinstance(data, dict | None):
            raise ActionError("data is an object")
        self._replay.freely()
        moment = self._replay.inject(event, data or {})
        if moment.happened:
            self._add(moment)
        else:
            assert moment.by is not None
            raise ActionError(f"{words(self._events[event])}: {self._simulation.reason(event, moment.by)}")

    def _forward(self, number: int) -> None:
        for _ in range(number):
            moment = self._replay.forward()
            if moment is None:
                return
            self._add(moment)

    def _back_to(self, moment: int) -> None:
        while len(self._replay.past) > moment:
            self._replay.back()
        self._replay.freely()
        self._cut(moment + 1)

    def _cut(self, length: int) -> None:
        del self.moments[length:], self._states[length:], self._wholes[length:]
        self.cuts.append(length)

    def _add(self, moment: Moment | None) -> None:
        now: dict[str, dict[str, Any]] = {
            "state": whole_state(self._engine),
            "commands": {command: self._verdict(command) for command in self._commands},
            "timers": dict(self._replay.timers.running),
            "enabled": dict.fromkeys(self._simulation.enabled, True),
        }
        before = self._wholes[-1] if self._wholes else {part: {} for part in now}
        told: dict[str, Any] = {"time": self._replay.timers.now / 1000}
        if moment is not None:
            told |= {"event": moment.event, "data": dict(moment.data), "words": self._words(moment)}
            told["transitions"] = [list(self._numbers[edge]) for edge in moment.edges if edge in self._numbers]
            if moment.by is not None:
                told |= {"by": str(moment.by), "reason": self._simulation.reason(moment.event, moment.by)}
        told |= {part: _changes(before[part], now[part]) for part in now}
        self.moments.append(told)
        self._states.append(self._engine.state)
        # Moments share what did not change.
        self._wholes.append({part: before[part] if before[part] == now[part] else now[part] for part in now})

    def _words(self, moment: Moment) -> str:
        return "time goes by" if moment.event == WAIT else words(self._events[moment.event]).replace("`", "")

    def _verdict(self, command: str) -> dict[str, str] | None:
        by = self._engine.blocked_by(command)
        return None if by is None else {"by": str(by), "reason": self._simulation.reason(command, by)}

    # Who looks

    async def changed(self, cuts: int, length: int) -> None:
        """Waits until there are not so many moments any more, or moments were taken back more often than `cuts`."""
        async with self._changed:
            await self._changed.wait_for(lambda: len(self.cuts) != cuts or len(self.moments) != length)

    async def tell(self) -> None:
        """Lets all know who wait for changes."""
        async with self._changed:
            self._changed.notify_all()

    def explained(self, moment: int, event: str) -> dict[str, Any]:
        """What `explain` says of an event at a moment, in words. Raises ActionError where there is no such."""
        if event not in self._events or not 0 <= moment < len(self._states):
            raise ActionError("there is no such event, or moment")
        key = event, self._states[moment]
        if key not in self._explained:
            state = json.dumps({"state": self._wholes[moment]["state"]})
            codes = state_given(self._model, state)
            told = explored(self._model, lambda system: explain(system, self._events[event], codes))
            blocking = told.counterexample
            self._explained[key] = {
                "allowed": told.allowed,
                "notes": [note.text for note in (*told.plants, *told.requirements)],
                "otherwise": "" if blocking is None else counterexample_in_words(blocking, self._model),
                "changes": [note.text for note in told.changes],
                "way": in_words(told.way, self._model) if told.way else "",
            }
        return self._explained[key]


def _changes(before: Mapping[str, Any], now: Mapping[str, Any]) -> dict[str, Any]:
    """What is new or other now; what is no longer there is false."""
    gone = dict.fromkeys((name for name in before if name not in now), False)
    return gone | {name: value for name, value in now.items() if name not in before or before[name] != value}
