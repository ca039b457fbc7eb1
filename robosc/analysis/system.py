"""The supervised system: what findings, explanations and verification are all about.

It has the decision diagrams of a model, the states that can be reached under its supervisor, where each event can
happen in them, and shortest paths through them. There are two ways to come by one. `SynthesizedSystem` is the system as
the fixpoint of synthesis found it. `GuardedSystem` is the system that a controller executes: it is read from the guards
of a model's supervisor alone, so that verification does not trust the fixpoint. `ExplainedSystem` has both: what the
supervisor of a model does, whichever tool found it, and why synthesis forbids what it forbids.
"""

from __future__ import annotations

from copy import copy
from decimal import Decimal
from functools import cached_property
from typing import TYPE_CHECKING

from robosc.analysis.paths import Layers, trace
from robosc.analysis.wording import condition
from robosc.metamodel import sct
from robosc.semantics.definition import named_state
from robosc.semantics.roles import Roles, plant_of
from robosc.synthesis.decoding import value
from robosc.synthesis.fixpoint import reachable, supervise
from robosc.synthesis.relation import event_relations, plant_moves, required_moves, steps, violations
from robosc.synthesis.run_to_completion import Completion, completion, internal_events

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from robosc.analysis.paths import Path, TraceStep
    from robosc.metamodel import expression as ex
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.decoding import Value
    from robosc.synthesis.encoding import Element, Encoding
    from robosc.synthesis.fixpoint import SupervisedStates
    from robosc.synthesis.relation import EventRelation, Move

    Codes = Mapping[Element, int]

#: What finding the longest run to completion may cost, in nodes looked at.
_EFFORT = 200_000_000
#: Numbers of more digits are rounded.
_DIGITS = 15


class SupervisedSystem:
    """The plants of a model under a supervisor; a single state is given by the code of each of its elements.

    `relations` has the relation of each event, in the order of the plants. `moves` are the events that change
    something, each with its step; from a controlled state, a step may lead out of the controlled states where only
    synthesis forbids it.
    """

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        encoding: Encoding,
        relations: Mapping[sct.Event, EventRelation],
        moves: Sequence[Move],
    ) -> None:
        self.model = model
        self.roles = Roles(model)
        self.encoding = encoding
        self.diagrams = encoding.diagrams
        self.relations = relations
        self.moves = moves
        #: The events that happen under the supervisor: those of `moves`, where they lead from and to controlled states.
        self.supervised_moves = moves
        self.plant_moves = plant_moves(relations.values())
        #: The states that violate a requirement whatever a supervisor does, reachable or not.
        self.violations = violations(model, relations.values(), encoding)

    @cached_property
    def initial(self) -> Diagram:
        """The states in which the system starts: one, but for models from CIF."""
        return self.encoding.initial

    @cached_property
    def controlled(self) -> Diagram:
        """The states that are reachable under the supervisor: none if it is empty."""
        return reachable(self.diagrams, steps(self.moves), self.initial, self.diagrams.true)

    @cached_property
    def uncontrolled(self) -> Diagram:
        """The states that the plants reach without requirements."""
        return reachable(self.diagrams, steps(self.plant_moves), self.encoding.initial, self.diagrams.true)

    @cached_property
    def size(self) -> str:
        """The number of controlled states, in words."""
        return counted(self.encoding.count(self.controlled), "state")

    @cached_property
    def layers(self) -> Layers:
        """The controlled states by their distance from the initial one."""
        return Layers(self.encoding, self.supervised_moves, self.initial, self.controlled)

    def layers_from(self, start: Codes) -> Layers:
        """The controlled states by their distance from one of them."""
        return Layers(self.encoding, self.supervised_moves, self.encoding.state(start), self.controlled)

    def path_to(self, states: Diagram) -> Path:
        """A shortest path from the initial state to one of these controlled states."""
        path = self.layers.path_to(states)
        assert path is not None
        return path

    def trace(self, path: Path) -> tuple[TraceStep, ...]:
        """The events of a path, with the values of inputs that matter."""
        return tuple(trace(self.encoding, path))

    def last(self, path: Path) -> Diagram:
        """The state in which a path ends."""
        return self.encoding.state(path.states[-1])

    def onwards(self, codes: Codes, moves: Sequence[Move] | None = None) -> Diagram:
        """The states that `moves`, else all moves of the system, reach from a state, that one included."""
        possible = self.moves if moves is None else moves
        return reachable(self.diagrams, steps(possible), self.encoding.state(codes), self.diagrams.true)

    def never_marked(self, codes: Codes, moves: Sequence[Move] | None = None) -> list[sct.Plant]:
        """The plants that are in no marked location in any state that can follow the given one, as `onwards` says."""
        states = self.onwards(codes, moves)
        return [plant for plant in self.model.plants if not (states & self.encoding.marked(plant)).satisfiable()]

    @property
    def violating(self) -> Diagram:
        """The states that violate some invariant."""
        return self.diagrams.any_of(self.violations.values())

    def violated(self, codes: Codes) -> tuple[sct.StatedRequirement, ...]:
        """What a state violates."""
        return tuple(requirement for requirement, states in self.violations.items() if self.is_in(codes, states))

    def holds(self, expression: ex.Expression | None, codes: Codes) -> bool:
        """Whether a condition is true in a state."""
        return self.is_in(codes, self.encoding.holds(expression))

    def is_in(self, codes: Codes, states: Diagram) -> bool:
        """Whether a state is one of these."""
        return (self.encoding.state(codes) & states).satisfiable()

    @staticmethod
    def where(codes: Codes, relevant: Iterable[Element]) -> str:
        """The values of those relevant elements that have several, such as `Lidar.free and Gauge.level = 3`."""
        chosen = dict.fromkeys(element for element in relevant if element in codes)
        return condition(
            (element, value(element, codes[element]))
            for element in chosen
            if not (isinstance(element, sct.Plant) and len(element.locations) == 1)
        )


class SynthesizedSystem(SupervisedSystem):
    """The system as synthesis finds it; its moves are all events under the requirements.

    `found` is the result of the fixpoint: of each round the states still held to be good, and those of them from which
    a marked state can be reached.
    """

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        encoding: Encoding,
        relations: Sequence[EventRelation] | None = None,
        found: SupervisedStates | None = None,
    ) -> None:
        """Without `relations` and `found` they are made anew."""
        relations = event_relations(model, encoding) if relations is None else relations
        super().__init__(
            model, encoding, {relation.event: relation for relation in relations}, required_moves(relations)
        )
        self.required = {relation.event: relation.requirement for relation in relations}
        self.found = supervise(encoding, self.moves, self.violating) if found is None else found
        self.controlled = self.found.controlled

    def without(self, requirements: AbstractSet[sct.StatedRequirement]) -> SynthesizedSystem:
        """The system that there would be without some requirements.

        An action that is cancelled where a requirement on it no longer holds is then cancelled for the others alone.
        """
        other = copy(self)
        vars(other).pop("layers", None)
        other.required = {}
        for event, relation in self.relations.items():
            trigger = self.start_of(event)
            if trigger is None:
                other.required[event] = self._asked(relation, requirements)
            else:
                other.required[event] = ~self.started_where(trigger, requirements)
        moves = ((relation, relation.step_where(other.required[event])) for event, relation in self.relations.items())
        other.moves = [(relation, step) for relation, step in moves if step is not None]
        other.supervised_moves = other.moves
        other.violations = {
            requirement: states for requirement, states in self.violations.items() if requirement not in requirements
        }
        other.found = supervise(self.encoding, other.moves, other.violating)
        other.controlled = other.found.controlled
        return other

    def allowed(self, event: sct.Event) -> Diagram:
        """The controlled states in which the event can happen."""
        enabled = self.controlled & self.relations[event].enabled & self.required[event]
        step = next((step for relation, step in self.moves if relation.event is event), None)
        return enabled & step.preimage(self.controlled) if event.controllable and step is not None else enabled

    def stated(self, first: Iterable[sct.StatedRequirement] = ()) -> list[tuple[sct.StatedRequirement, ...]]:
        """The requirements by the place in the text that they come from, those of `first` before the others.

        Those are not among them that say when an action is cancelled.
        """
        asked = (requirement for requirement in self.model.requirements if self.start_of(requirement.event) is None)
        own: list[sct.StatedRequirement] = [*asked, *self.model.invariants]
        by_place: dict[object, list[sct.StatedRequirement]] = {}
        for requirement in dict.fromkeys([*(requirement for requirement in first if requirement in own), *own]):
            by_place.setdefault(requirement.source or requirement, []).append(requirement)
        return [tuple(requirements) for requirements in by_place.values()]

    def start_of(self, event: sct.Event) -> sct.Event | None:
        """The start of the action whose requirements say when `event` cancels it; None for any other event.

        The requirement that says so stands at the action itself.
        """
        plant, requirements = plant_of(event), self.relations[event].requirements
        stands_there = plant.source is not None and [requirement.source for requirement in requirements] == [
            plant.source
        ]
        if event.kind != sct.EventKind.cancel or not stands_there:
            return None
        return next((other for other in plant.events if other.kind == sct.EventKind.trigger), None)

    def started_where(self, trigger: sct.Event, left_out: AbstractSet[sct.StatedRequirement] = frozenset()) -> Diagram:
        """Where an action is not cancelled: what it `needs` holds, whatever orders and counts say of another start."""
        asked = self.relations[trigger].asked.items()
        return self.diagrams.all_of(
            holds for requirement, holds in asked if requirement.automaton is None and requirement not in left_out
        )

    def _asked(self, relation: EventRelation, left_out: AbstractSet[sct.StatedRequirement]) -> Diagram:
        """Where the requirements on an event hold but for those left out."""
        kept = [asked for requirement, asked in relation.asked.items() if requirement not in left_out]
        return self.diagrams.all_of(kept)


class GuardedSystem(SupervisedSystem):
    """The system that a controller executes.

    An event happens where its plants enable it and both parts of its guard hold: these are expressions of the
    supervisor, and the requirements are not asked. Without `guards` the system are the plants alone. Raises ValueError
    where the model has no supervisor.
    """

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        encoding: Encoding,
        relations: Sequence[EventRelation] | None = None,
        *,
        guards: bool = True,
    ) -> None:
        """Without `relations` they are made anew."""
        if model.supervisor is None:
            raise ValueError(f"{model.name} has no supervisor: synthesize it first")
        self.supervisor = model.supervisor
        self.guards = {guard.event: guard for guard in model.supervisor.guards if guards}
        known = event_relations(model, encoding) if relations is None else relations
        super().__init__(model, encoding, {relation.event: relation for relation in known}, [])
        #: Where an event can happen, in reachable states and in all others.
        self.allowed = {event: relation.enabled & self.guard(event) for event, relation in self.relations.items()}
        supervised = [
            (self.relations[event], allowed, self.relations[event].step_where(allowed))
            for event, allowed in self.allowed.items()
        ]
        self.moves = [(relation, step) for relation, _, step in supervised if step is not None]
        self.supervised_moves = self.moves
        self.internal = internal_events(supervised, self.guards.values())

    @cached_property
    def initial(self) -> Diagram:
        """The initial states that the supervisor leaves."""
        return self.encoding.initial & self.encoding.holds(self.supervisor.initial)

    def guard(self, event: sct.Event) -> Diagram:
        """Where the supervisor lets an event happen: everywhere, if it has no guard for the event."""
        guard = self.guards.get(event)
        if guard is None:
            return self.diagrams.true
        return self.encoding.holds(guard.requirement) & self.encoding.holds(guard.synthesis)

    @cached_property
    def completion(self) -> Completion:
        """How many internal events can happen in a row, and where there is no end to them."""
        return completion(self.diagrams, self.internal, self.controlled, _EFFORT)


class ExplainedSystem(SynthesizedSystem):
    """The system under the supervisor that its model has; `moves` and `found` are those of synthesis all the same.

    Raises ValueError where the model has no supervisor.
    """

    def __init__(self, model: sct.SupervisoryControlModel, encoding: Encoding) -> None:
        relations = event_relations(model, encoding)
        super().__init__(model, encoding, relations)
        self._guarded = GuardedSystem(model, encoding, relations)
        self.supervised_moves = self._guarded.moves
        self.initial, self.controlled = self._guarded.initial, self._guarded.controlled

    def allowed(self, event: sct.Event) -> Diagram:
        """The controlled states in which the event can happen."""
        return self.controlled & self._guarded.allowed[event]

    def without(self, requirements: AbstractSet[sct.StatedRequirement]) -> SynthesizedSystem:
        """The system that synthesis would find without some requirements."""
        own = SynthesizedSystem(self.model, self.encoding, list(self.relations.values()), self.found)
        return own.without(requirements)


def whole_state(model: sct.SupervisoryControlModel, codes: Codes) -> dict[str, Value]:
    """The state with these codes, as `robosc simulate` prints it."""
    return named_state(model, lambda element: value(element, codes[element]))


def counted(number: int, what: str) -> str:
    """A number of things: `1 state`, `1,234 states`, `1.27e+30 states`."""
    return f"{grouped(number)} {what}" if number == 1 else f"{grouped(number)} {what}s"


def grouped(number: int) -> str:
    """A number for people: `1,234`, `1.27e+30`."""
    return f"{number:,}" if number < 10**_DIGITS else f"{Decimal(number):.2e}"
