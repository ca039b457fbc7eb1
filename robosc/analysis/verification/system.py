"""The system that the properties are about: the plants of a model under the guards of its supervisor."""

from __future__ import annotations

from decimal import Decimal
from functools import cached_property
from typing import TYPE_CHECKING

from robosc.analysis.supervision.wording import condition, name
from robosc.analysis.verification.loop import ControlLoop
from robosc.metamodel import sct
from robosc.semantics.roles import Roles, event_name
from robosc.synthesis.decoding import value
from robosc.synthesis.fixpoint import reachable
from robosc.synthesis.paths import Layers, TraceStep, trace
from robosc.synthesis.relation import event_relations
from robosc.synthesis.settling import Settling, settling, silent_events

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element, Encoding
    from robosc.synthesis.paths import Move, Path
    from robosc.synthesis.relation import EventRelation, Step

#: What is spent on the settling bound, in nodes looked at.
_EFFORT = 200_000_000
#: Numbers of more digits are rounded.
_DIGITS = 15


class SupervisedSystem:
    """What a model with a supervisor does, as the controller runs it.

    An event happens where its plants enable it and both parts of its guard hold: what the supervisor says is taken from
    these expressions, and the requirements are not asked. Without `guards` they are the plants alone. Raises ValueError
    where the model has no supervisor.
    """

    def __init__(self, model: sct.SupervisoryControlModel, encoding: Encoding, *, guards: bool = True) -> None:
        if model.supervisor is None:
            raise ValueError(f"{model.name} has no supervisor: synthesize it first")
        self.model = model
        self.roles = Roles(model)
        self.supervisor = model.supervisor
        self.encoding = encoding
        self.diagrams = encoding.diagrams
        self.relations = event_relations(model, encoding)
        self.guards = {each.event: each for each in model.supervisor.guards if guards}
        #: Where an event can happen, be the state reachable or not.
        self.allowed = {each: each.enabled & self.guard(each.event) for each in self.relations}
        supervised = [(each, allowed, each.step_where(allowed)) for each, allowed in self.allowed.items()]
        #: The events that change something.
        self.moves = [(each, step) for each, _, step in supervised if step is not None]
        self.silent = silent_events(supervised, self.guards.values())

    def guard(self, event: sct.Event) -> Diagram:
        """Where the supervisor lets an event happen; everywhere, if it has no guard for it."""
        guard = self.guards.get(event)
        if guard is None:
            return self.diagrams.true
        return self.encoding.holds(guard.requirement) & self.encoding.holds(guard.synthesis)

    @cached_property
    def reachable(self) -> Diagram:
        """The states that the system can come to."""
        return reachable(self.diagrams, steps(self.moves), self.encoding.initial, self.diagrams.true)

    @cached_property
    def settling(self) -> Settling:
        """Whether silent events come to rest, and when."""
        return settling(self.diagrams, self.silent, self.reachable, _EFFORT)

    @cached_property
    def loop(self) -> ControlLoop:
        """What the control loop makes of it."""
        return ControlLoop(self)

    @cached_property
    def size(self) -> str:
        """How many states can be reached, as evidence."""
        return counted(self.encoding.count(self.reachable), "state")

    def path_to(self, states: Diagram) -> Path:
        """A shortest way from the initial state to one of these reachable states."""
        path = self._layers.path_to(states)
        assert path is not None
        return path

    def trace(self, path: Path) -> tuple[TraceStep, ...]:
        """The events of a path."""
        return tuple(trace(self.encoding, path))

    def last(self, path: Path) -> Diagram:
        """The state in which a path ends."""
        return self.encoding.state(path.states[-1])

    @cached_property
    def _layers(self) -> Layers:
        return Layers(self.encoding, self.moves, self.encoding.initial, self.diagrams.true)

    @staticmethod
    def where(codes: Mapping[Element, int], relevant: Iterable[Element]) -> str:
        """What a state says of elements with several values, such as `Lidar.free and Gauge.level = 3`."""
        chosen = dict.fromkeys(each for each in relevant if each in codes)
        return condition(
            (each, value(each, codes[each]))
            for each in chosen
            if not (isinstance(each, sct.Plant) and len(each.locations) == 1)
        )


def steps(moves: Sequence[Move]) -> list[Step]:
    """What the events do."""
    return [step for _, step in moves]


def happening(relation: EventRelation) -> TraceStep:
    """The event as the end of a trace, where nothing matters that comes with it."""
    return TraceStep(event_name(relation.event))


def stuck(plants: Sequence[sct.Plant], codes: Mapping[Element, int]) -> str:
    """That these plants, or all of them together, are never marked again."""
    if not plants:
        return "the marked states of all components can't be reached together any more"
    places = (f"`{name(each)}`" + _location(each, codes) for each in plants)
    return f"{', '.join(places)} can't get back to a marked state"


def _location(plant: sct.Plant, codes: Mapping[Element, int]) -> str:
    return f" in `{plant.locations[codes[plant]].name}`" if len(plant.locations) > 1 else ""


def counted(number: int, what: str) -> str:
    """A number of things: `1 state`, `1,234 states`, `1.27e+30 states`."""
    text = f"{number:,}" if number < 10**_DIGITS else f"{Decimal(number):.2e}"
    return f"{text} {what}" if number == 1 else f"{text} {what}s"
