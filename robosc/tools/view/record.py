"""A run that is played: by hand, at random, from a script or a log, or as the continuation of a recorded run."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from robosc.model import expression as ex
from robosc.model.semantics.failures import brings_data
from robosc.run.simulation.data import data_beside
from robosc.run.simulation.replay import Replay
from robosc.run.simulation.script import REFUSE, WAIT
from robosc.run.simulation.simulation import refusal_in_words
from robosc.tools.view.moments import ActionError, Moments

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from random import Random

    from robosc.model import rosgraph
    from robosc.run.simulation import ScriptStep, Simulation
    from robosc.run.simulation.replay import Moment
    from robosc.run.simulation.tracker import ReportedMoment

#: Names of the actions on a run.
ACTIONS = ("perform", "wait", "undo", "redo", "random", "restart", "continue")
#: Maximum number of random events per action.
_MOST_AT_ONCE = 1000
#: Maximum waiting time per action, in seconds.
_LONGEST_WAIT = 3600


class Record(Moments):
    """Moments of a run that actions extend. `steps` are played at once; None for no steps."""

    acts = True

    def __init__(
        self,
        simulation: Simulation,
        graph: rosgraph.RosGraph | None = None,
        steps: Sequence[ScriptStep] | None = None,
        seed: int = 0,
        recorded: Iterable[tuple[float, ReportedMoment]] | None = None,
    ) -> None:
        """Add the recorded reports of a node, with times in seconds, and then play the steps.

        `graph` defines the variables that only the node stores.
        """
        super().__init__(simulation, graph)
        self._seed = seed
        for time, reported in recorded or ():
            self._add_told(time, {}, reported)
        #: Number of recorded moments, which cannot be played again.
        self._recorded = max(0, len(self.moments) - 1)
        self._graph = graph
        self._replay = Replay(simulation, steps, seed, self._chosen)
        if recorded is None:
            self._keep(None)
        while steps is not None and (moment := self._replay.forward()) is not None:
            self._keep(moment)

    def do(self, action: Any) -> None:
        """Perform an action, an object with `action` (one of ACTIONS) and its parameters.

        Raises ActionError, DataError.
        """
        match action:
            case {"action": "perform", "event": str(event), **rest} if event in self.events:
                self._perform(event, rest.get("inputs"), rest.get("data"), rest.get("kept", []))
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
                raise ActionError(f"an action is one of {', '.join(ACTIONS)}, with its data: {json.dumps(action)}")

    def _wait(self, seconds: float) -> None:
        for moment in self._replay.let_go_by(seconds):
            self._keep(moment)

    def _undo(self) -> None:
        if self._replay.back() is not None:
            self._cut(len(self.moments) - 1)

    def _redo(self) -> None:
        if self._replay.has_future:
            self._forward(1)

    def _perform(self, event: str, inputs: object, data: object, stored_data: object) -> None:
        """Let an event happen, with values of its inputs by name, or with data in the shape of the event log.

        `stored_data` lists pairs: the path of fields to data that only the node stores, and that data.
        """
        if isinstance(inputs, dict):
            known = {carried.name for carried in self.events[event].inputs}
            if set(inputs) != known:
                raise ActionError(f"{event} has the inputs {', '.join(sorted(known)) or '(none)'}")
            others = _others(stored_data)
            beside = {} if self._graph is None else data_beside(self._graph, self.events[event])
            if others and set(others) != set(beside):
                raise ActionError(f"`kept` of {event} has the fields {', '.join(map('.'.join, beside)) or '(none)'}")
            data = self.simulation.data.shape(event, inputs, others) if inputs or others else {}
        if not isinstance(data, dict | None):
            raise ActionError("data is an object")
        self._replay.freely()
        moment = self._replay.inject(event, data or {})
        if moment.happened:
            self._keep(moment)
        else:
            assert moment.by is not None
            raise ActionError(f"{self.describe_event(event)}: {self.simulation.reason(event, moment.by)}")

    def _chosen(self, random: Random) -> tuple[str, dict[str, Any]] | None:
        """Return a random possible event with random data, including data that only the node stores."""
        chosen = self.simulation.random_event(random)
        if chosen is None or self._graph is None:
            return chosen
        event, data = chosen
        beside = data_beside(self._graph, self.events[event])
        others = {path: _any(kind, random) for path, kind in beside.items()}
        inputs = self.simulation.data.inputs(event, data)
        if not brings_data(self.events[event], data.get("reason")):
            return event, data
        return event, self.simulation.data.shape(event, inputs, others) if others else data

    def _forward(self, number: int) -> None:
        for _ in range(number):
            moment = self._replay.forward()
            if moment is None:
                return
            self._keep(moment)

    def _back_to(self, moment: int) -> None:
        while self._replay.past and len(self._replay.past) > moment - self._recorded:
            self._replay.back()
        if moment < self._recorded:
            # Recorded moments cannot be undone step by step: the run is played from this state on.
            self.engine.state = self._states[moment]
            self._replay = Replay(self.simulation, None, self._seed, self._chosen)
            self._recorded = moment
        self._replay.freely()
        self._cut(moment + 1)

    def _words(self, moment: Moment) -> str:
        if moment.event == REFUSE:
            return refusal_in_words(self.engine, moment.data["of"]).replace("`", "")
        return "time passes" if moment.event == WAIT else self.describe_event(moment.event)

    def _keep(self, moment: Moment | None) -> None:
        entries: dict[str, Any] = {}
        if moment is not None:
            entries = {"event": moment.event, "data": dict(moment.data), "words": self._words(moment)}
            if moment.by is not None:
                entries |= {"by": str(moment.by), "reason": self.simulation.reason(moment.event, moment.by)}
        timers, stored = self._replay.timers, self._kept_last
        if moment is not None and moment.happened:
            stored = self._node.after(stored, moment.event, moment.data, moment.before)
        self._add(timers.now / 1000, timers.running, entries, () if moment is None else moment.edges, stored)


def _any(kind: ex.Type, random: Random) -> bool | int | float | str:
    match kind:
        case ex.StringType():
            return random.choice("abc")
        case ex.BooleanType():
            return random.random() < 0.5
        case ex.IntegerType():
            return random.randint(-100, 100)
    return random.randint(-1000, 1000) / 100


def _others(pairs: object) -> dict[tuple[str, ...], Any]:
    """Return data by its path of fields. Raises ActionError if `pairs` is malformed."""
    by_path: dict[tuple[str, ...], Any] = {}
    for pair in pairs if isinstance(pairs, list) else [None]:
        match pair:
            case [list(path), bool() | int() | float() | str() as value] if all(isinstance(name, str) for name in path):
                by_path[tuple(path)] = value
            case _:
                raise ActionError("`kept` is a list of pairs of fields and data")
    return by_path
