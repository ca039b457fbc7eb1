"""One run of a supervised robot that can be undone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robosc.engine import Engine
from robosc.metamodel import expression as ex
from robosc.semantics.roles import event_name
from robosc.simulation.data import EventData

if TYPE_CHECKING:
    from collections.abc import Mapping
    from random import Random

    from robosc.engine import Blocked
    from robosc.engine.state import State, Value
    from robosc.metamodel import rosgraph, sct
    from robosc.simulation.unread import Unread


def whole_state(engine: Engine) -> dict[str, Value]:
    """The location of every plant, also of one that has no other, and the values of variables, by their names."""
    state: dict[str, Value] = {}
    for plant in engine.model.plants:
        state[plant.name] = plant.locations[engine.location(plant)].name
        for variable in plant.variables:
            state[f"{plant.origin or plant.name}.{variable.name}"] = engine.value(variable)
    return state


@dataclass(frozen=True)
class Happened:
    """An event that was asked for: whether it happened, else what kept it from happening, and the state afterwards."""

    event: str
    data: Mapping[str, Any]
    by: Blocked | Unread | None
    state: Mapping[str, Value]

    @property
    def accepted(self) -> bool:
        """Whether it happened."""
        return self.by is None

    def answer(self) -> dict[str, Any]:
        """The object that `simulate --script` prints."""
        by = None if self.by is None else str(self.by)
        return {"event": self.event, "accepted": self.accepted, "by": by, "state": dict(self.state)}


class Simulation:
    """The supervised automaton of a model: only what is asked for happens. `trace` is what has happened."""

    def __init__(self, model: sct.SupervisoryControlModel, graph: rosgraph.RosGraph | None = None) -> None:
        self.engine = Engine(model)
        self.data = EventData(self.engine, graph)
        self.trace: list[Happened] = []
        self._before: list[State] = []
        self._inputs = {event_name(each): list(each.inputs) for each in self.engine.roles.events}

    @property
    def enabled(self) -> list[str]:
        """The events that can happen now, in the order of the model."""
        return [each for each in self.engine.events if self.engine.enabled(each)]

    def perform(self, event: str, data: Mapping[str, Any] | None = None) -> Happened:
        """Lets an event happen with data in the shape of the event log, if it can; else nothing changes.

        Raises DataError, and KeyError where there is no such event.
        """
        inputs = self.data.inputs(event, data or {})
        before = self.engine.state
        by = self.engine.blocked_by(event) or self.data.unread(event, data or {})
        if by is None:
            self.engine.perform(event, inputs)
        happened = Happened(event, data or {}, by, whole_state(self.engine))
        if by is None:
            self._before.append(before)
            self.trace.append(happened)
        return happened

    def undo(self) -> Happened | None:
        """Takes the last event back that happened; None where there is none."""
        if not self.trace:
            return None
        self.engine.state = self._before.pop()
        return self.trace.pop()

    def random_step(self, random: Random) -> Happened | None:
        """Lets one of the enabled events happen, with random data; None where none is enabled."""
        enabled = self.enabled
        if not enabled:
            return None
        event = random.choice(enabled)
        values = {each.name: _any(each.type, random) for each in self._inputs[event]}
        return self.perform(event, self.data.shaped(event, values))


def _any(kind: ex.Type, random: Random) -> Value:
    match kind:
        case ex.BooleanType():
            return random.random() < 0.5
        case ex.IntegerType(minimum=int(low), maximum=int(high)):
            return random.randint(low, high)
    assert isinstance(kind, ex.EnumerationType)
    return str(random.choice(list(kind.enumeration.literals)).name)
