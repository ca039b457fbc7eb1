"""Moments of a run as JSON for the page: each has the changes since the one before."""

from __future__ import annotations

import asyncio
import json
from typing import TYPE_CHECKING, Any

from robosc.analysis.explain import data_in_short, explain, explore, parse_state
from robosc.analysis.wording import words
from robosc.model.semantics.roles import Roles, event_name
from robosc.run.simulation.simulation import whole_state
from robosc.run.simulation.stored_variables import StoredVariables
from robosc.tools.view.description import automata_of, commands_of, transitions_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.engine.state import State
    from robosc.model import rosgraph, sct
    from robosc.run.simulation import Simulation
    from robosc.run.simulation.stored_variables import Values
    from robosc.run.simulation.tracker import ReportedMoment


#: Maximum number of cached answers of `explain`.
_MOST_EXPLAINED = 1000


class ActionError(Exception):
    """An action that is impossible; the message explains why."""


class Moments:
    """Moments of a run: the first is the start, or the oldest that is still stored.

    Each is JSON data with `time` in seconds, `event`, `words` and `data`. A blocked event has `by` and `reason`.
    `transitions` lists the transitions taken, as pairs of automaton and transition. The changes since the moment before
    are `state`, `commands` (null if allowed, else `by` and `reason`), `enabled` (of all events), and `timers` (in
    milliseconds). A moment that is `whole` has the complete values of these.
    """

    #: Whether `do` supports any action.
    acts = False

    def __init__(self, simulation: Simulation, graph: rosgraph.RosGraph | None = None, most: int | None = None) -> None:
        """Start with no moments; beyond `most` of them the older half is dropped (None: no limit).

        `graph` defines the variables that only the node stores.
        """
        self.simulation = simulation
        self.engine = simulation.engine
        self.events = {event_name(event): event for event in Roles(self.engine.model).events}
        self._model = self.engine.model
        self._most = most
        self._numbers = {
            edge: (number, position)
            for number, plant in enumerate(automata_of(self._model))
            for position, edges in enumerate(transitions_of(plant))
            for edge in edges
        }
        self._commands = {event_name(event) for event in commands_of(self._model)}
        self._readers: dict[sct.Plant | sct.DiscreteVariable, list[str]] = {}
        for event in self.events:
            for element in self.engine.reads(event):
                self._readers.setdefault(element, []).append(event)
        self._explained: dict[tuple[str, State], dict[str, Any]] = {}
        self._changed = asyncio.Condition()
        #: Numbers of moments left after each time that moments were removed from the end.
        self.cuts: list[int] = []
        #: Message of the page about the source of the moments.
        self.status = ""
        #: Number of the first of `moments`.
        self.first = 0
        self.moments: list[dict[str, Any]] = []
        self._states: list[State] = []
        self._running: list[Mapping[str, int]] = []
        self._node = StoredVariables(self.engine, graph)
        #: Variables that only the node stores, at each moment.
        self._stored: list[Values] = []
        self._verdicts: dict[str, dict[str, str] | None] = {}

    @property
    def length(self) -> int:
        """Number of moments so far, including those that were dropped."""
        return self.first + len(self.moments)

    def do(self, action: Any) -> None:
        """Perform an action of the page. Raises ActionError."""
        raise ActionError(f"no action is possible here: {json.dumps(action)}")

    # Adding and removing moments

    def _add(
        self,
        time: float,
        running: Mapping[str, int],
        entries: Mapping[str, Any],
        edges: Iterable[sct.Edge],
        stored: Values,
    ) -> None:
        """Add a moment with the present state of the engine.

        `running` has the milliseconds left of timers.
        """
        moment: dict[str, Any] = {"time": time, **entries}
        if "event" in entries:
            moment["transitions"] = [list(self._numbers[edge]) for edge in edges if edge in self._numbers]
        state = self.engine.state
        if self._states:
            moment |= self._changes(self._states[-1], state)
            moment["timers"] = _changed(self._running[-1], running)
            before = self._stored[-1]
            moment["state"] |= {name: value for name, value in stored.items() if value != before[name]}
        else:
            moment |= self._whole(running, stored)
        self.moments.append(moment)
        self._states.append(state)
        self._running.append(dict(running))
        self._stored.append(stored)
        if self._most is not None and len(self.moments) > self._most:
            self._forget(len(self.moments) // 2)

    @property
    def _kept_last(self) -> Values:
        """Variables that only the node stores, at the last moment."""
        return self._stored[-1] if self._stored else self._node.initial

    def _add_told(self, time: float, running: Mapping[str, int], report: ReportedMoment) -> None:
        """Add a moment that a node has reported."""
        entries = (
            {"words": "state of the node"}
            if report.event is None
            else {"event": report.event, "words": self.describe_event(report.event)}
        )
        self._add(time, running, entries, report.edges, self._node.update(self._kept_last, report.variables))

    def _changes(self, before: State, now: State) -> dict[str, Any]:
        """Return the changes between two states; the engine must be in the second."""
        concerned: dict[str, None] = {}
        state = {}
        for cell, (name, element) in enumerate(now.layout.elements):
            if before.cells[cell] != now.cells[cell]:
                state[name] = now.layout.domains[cell].external(now.cells[cell])
                concerned |= dict.fromkeys(self._readers.get(element, ()))
        commands, enabled = {}, {}
        for event in self.events:
            if event in concerned:
                verdict = self._verdict(event)
                if (verdict is None) != (self._verdicts[event] is None):
                    enabled[event] = verdict is None
                if event in self._commands and verdict != self._verdicts[event]:
                    commands[event] = verdict
                self._verdicts[event] = verdict
        return {"state": state, "commands": commands, "enabled": enabled}

    def _whole(self, running: Mapping[str, int], stored: Values) -> dict[str, Any]:
        """Return the complete values of a moment in the engine's present state."""
        self._look()
        return {
            "whole": True,
            "state": {**whole_state(self.engine), **stored},
            "commands": {event: self._verdicts[event] for event in self.events if event in self._commands},
            "enabled": {event: True for event, verdict in self._verdicts.items() if verdict is None},
            "timers": dict(running),
        }

    def _look(self) -> None:
        self._verdicts = {event: self._verdict(event) for event in self.events}

    def _verdict(self, event: str) -> dict[str, str] | None:
        by = self.engine.blocked_by(event)
        if by is None:
            return None
        return {"by": str(by), "reason": self.simulation.reason(event, by) if event in self._commands else ""}

    def _cut(self, length: int) -> None:
        """Remove moments until `length` are left; the engine must be in the state of the last of them."""
        remaining = length - self.first
        del self.moments[remaining:], self._states[remaining:], self._running[remaining:], self._stored[remaining:]
        self.cuts.append(length)
        self._look()

    def _forget(self, number: int) -> None:
        """Drop the oldest moments, and give the new first one its complete values."""
        now = self.engine.state
        self.engine.state = self._states[number]
        first = self.moments[number] | self._whole(self._running[number], self._stored[number])
        self.engine.state = now
        self._look()
        self.moments[: number + 1] = [first]
        del self._states[:number], self._running[:number], self._stored[:number]
        self.first += number

    def describe_event(self, event: str) -> str:
        """Return an event in the words of the model."""
        return words(self.events[event]).replace("`", "")

    # Listeners and explanations

    async def wait_for_change(self, cuts: int, length: int, status: str) -> None:
        """Wait until moments are added or removed, or the status changes, compared to the arguments."""

        def is_other() -> bool:
            return len(self.cuts) != cuts or self.length != length or self.status != status

        async with self._changed:
            await self._changed.wait_for(is_other)

    async def tell(self) -> None:
        """Notify all that wait for changes."""
        async with self._changed:
            self._changed.notify_all()

    def explain(self, number: int, event: str) -> dict[str, Any]:
        """Return the explanation of an event at a moment, in words.

        Raises ActionError if there is no such event.
        """
        if event not in self.events or not self.first <= number < self.length:
            raise ActionError("unknown event or moment")
        state = self._states[number - self.first]
        key = event, state
        if key not in self._explained:
            if len(self._explained) == _MOST_EXPLAINED:
                self._explained.clear()
            codes = parse_state(self._model, json.dumps({"state": dict(state)}))
            explanation = explore(self._model, lambda system: explain(system, self.events[event], codes))
            self._explained[key] = data_in_short(explanation, self._model)
        return self._explained[key]


def _changed(before: Mapping[str, int], now: Mapping[str, int]) -> dict[str, int | bool]:
    """Return the new and changed timers; those that have stopped map to False."""
    gone: dict[str, int | bool] = dict.fromkeys((name for name in before if name not in now), False)
    return gone | {name: value for name, value in now.items() if before.get(name) != value}
