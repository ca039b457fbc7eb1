"""The control loop by script: incoming events as batches of one or more, and ticks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.engine import ControlLoop, Hooks, Settings
from robosc.simulation.data import EventData
from robosc.simulation.simulation import whole_state
from robosc.simulation.unread import Unread

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.engine import Blocked
    from robosc.metamodel import rosgraph, sct

#: What a script may say beside events: the period is over; a message from the robot with several events begins, ends.
TICK, BEGIN, END = "tick", "begin", "end"


class LoopSimulation:
    """Runs a model's control loop, step by step."""

    OWN = (TICK, BEGIN, END)

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        graph: rosgraph.RosGraph | None = None,
        settings: Settings | None = None,
    ) -> None:
        self._happened: list[str] = []
        self._loop = ControlLoop(model, settings, Hooks(after=self._happened.append, livelock=self._livelock))
        self.data = EventData(self._loop.engine, graph)
        self._in_batch = False

    @property
    def events(self) -> list[str]:
        """What a script may name: what comes from the robot, and the loop's own steps."""
        incoming = self._loop.engine.roles.incoming
        return [*(f"{each.eContainer().name}.{each.name}" for each in incoming), *self.OWN]

    def step(self, event: str, data: Mapping[str, Any]) -> dict[str, Any]:
        """What came of a step: the object that `simulate --loop --script` prints. Raises DataError."""
        inputs = {} if event in self.OWN else self.data.inputs(event, data)
        self._happened.clear()
        by: Blocked | Unread | None = None
        if event in self.OWN:
            self._in_batch = event == BEGIN
            getattr(self._loop, event)()
        else:
            if not self._in_batch:
                self._loop.begin()
            by = self._loop.engine.blocked_by(event) or self.data.unread(event, data)
            if not isinstance(by, Unread):
                self._loop.perform(event, inputs)
            elif by.error is not None:
                self._loop.perform(by.error)
            if not self._in_batch:
                self._loop.end()
        return {
            "event": event,
            "accepted": by is None,
            "by": None if by is None else str(by),
            "happened": list(self._happened),
            "state": whole_state(self._loop.engine),
        }

    def _livelock(self) -> None:
        self._happened.append("livelock")
