"""Supervised systems, the subject of findings, explanations and verification.

A system has the decision diagrams of a model, the reachable states under its supervisor, the states that allow each
event, and shortest paths. `SynthesizedSystem` is the system that the fixpoint of synthesis computes. `GuardedSystem` is
the system that a controller executes: it is read from the guards of a model's supervisor alone, so that verification
does not trust the fixpoint. `ExplainedSystem` combines both: the behavior under the model's supervisor, which may come
from any tool, and the reasons of synthesis.
"""

from __future__ import annotations

from copy import copy
from decimal import Decimal
from functools import cached_property
from typing import TYPE_CHECKING

from robosc.analysis.paths import Layers, shortest_path, trace
from robosc.analysis.wording import condition
from robosc.model import sct
from robosc.model.semantics.definition import named_state
from robosc.model.semantics.roles import Roles, plant_of
from robosc.synthesis.bdd import and_exists
from robosc.synthesis.decoding import value
from robosc.synthesis.fixpoint import Search, completed, reachable, reaching, supervise_forwards
from robosc.synthesis.relation import event_relations, goals, plant_moves, required_moves, steps, violations
from robosc.synthesis.run_to_completion import Completion, completion, internal_events

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from robosc.analysis.paths import Path, TraceStep
    from robosc.model import expression as ex
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.decoding import Value
    from robosc.synthesis.encoding import Element, Encoding
    from robosc.synthesis.fixpoint import SupervisedStates
    from robosc.synthesis.relation import EventRelation, Move

    Codes = Mapping[Element, int]

#: Effort limit for the longest run to completion, in visited nodes.
_EFFORT = 200_000_000
#: Numbers with more digits are rounded.
_DIGITS = 15


class SupervisedSystem:
    """Plants of a model under a supervisor; a single state is given by the code of each of its elements.

    `relations` holds the relation of each event, in the order of the plants. `moves` are the events that change
    something, each with its step. From a controlled state, a step may leave the controlled states if only synthesis
    forbids it.
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
        #: Events under the supervisor: those of `moves`, between controlled states.
        self.supervised_moves = moves
        self.plant_moves = plant_moves(relations.values())
        #: States that violate a requirement independently of the supervisor, reachable or not.
        self.violations = violations(model, relations.values(), encoding)
        #: States that requirements want to be reachable.
        self.goals = goals(model, encoding)

    @cached_property
    def initial(self) -> Diagram:
        """States in which the system starts: one, except for models from CIF."""
        return self.encoding.initial

    @cached_property
    def controlled(self) -> Diagram:
        """States that are reachable under the supervisor: none if it is empty."""
        return reachable(self.diagrams, steps(self.moves), self.initial, self.diagrams.true)

    @cached_property
    def uncontrolled(self) -> Diagram:
        """States that the plants reach without requirements."""
        return reachable(self.diagrams, steps(self.plant_moves), self.encoding.initial, self.diagrams.true)

    @cached_property
    def size(self) -> str:
        """Number of controlled states, in words."""
        return format_count(self.encoding.count(self.controlled), "state")

    @cached_property
    def layers(self) -> Layers:
        """Controlled states by their distance from the initial one."""
        return Layers(self.encoding, self.supervised_moves, self.initial, self.controlled)

    def layers_from(self, start: Codes) -> Layers:
        """Return the controlled states by their distance from one of them."""
        return Layers(self.encoding, self.supervised_moves, self.encoding.state(start), self.controlled)

    def path_to(self, states: Diagram) -> Path:
        """Return a shortest path from the initial state to one of these controlled states."""
        path = self.layers.path_to(states)
        assert path is not None
        return path

    def trace(self, path: Path) -> tuple[TraceStep, ...]:
        """Return the events of a path, with the values of inputs that matter."""
        return tuple(trace(self.encoding, path, self.permitted))

    def permitted(self, event: sct.Event) -> Diagram:  # noqa: ARG002 - subclasses restrict events
        """Return the states, and inputs of a command, in which the supervisor or the requirements permit an event."""
        return self.diagrams.true

    def last(self, path: Path) -> Diagram:
        """Return the state in which a path ends."""
        return self.encoding.state(path.states[-1])

    def onwards(self, codes: Codes, moves: Sequence[Move] | None = None) -> Diagram:
        """Return the states that `moves`, or all moves of the system, reach from a state, including that state."""
        possible = self.moves if moves is None else moves
        return reachable(self.diagrams, steps(possible), self.encoding.state(codes), self.diagrams.true)

    def never_marked(self, codes: Codes, moves: Sequence[Move] | None = None) -> list[sct.Plant]:
        """Return the plants that are in a marked location in no state that `onwards` returns."""
        states = self.onwards(codes, moves)
        return [plant for plant in self.model.plants if not (states & self.encoding.marked(plant)).satisfiable()]

    @property
    def violating(self) -> Diagram:
        """States that violate some invariant."""
        return self.diagrams.any_of(self.violations.values())

    def violated(self, codes: Codes) -> tuple[sct.StatedRequirement, ...]:
        """Return the requirements that a state violates."""
        return tuple(requirement for requirement, states in self.violations.items() if self.is_in(codes, states))

    def holds(self, expression: ex.Expression | None, codes: Codes) -> bool:
        """Return whether a condition is true in a state."""
        return self.is_in(codes, self.encoding.holds(expression))

    def is_in(self, codes: Codes, states: Diagram) -> bool:
        """Return whether a state is in a set."""
        return (self.encoding.state(codes) & states).satisfiable()

    @staticmethod
    def where(codes: Codes, relevant: Iterable[Element]) -> str:
        """Return the values of relevant elements that have several, such as `Lidar.free and Gauge.level = 3`."""
        chosen = dict.fromkeys(element for element in relevant if element in codes)
        return condition(
            (element, value(element, codes[element]))
            for element in chosen
            if not (isinstance(element, sct.Plant) and len(element.locations) == 1)
        )


class SynthesizedSystem(SupervisedSystem):
    """System as computed by synthesis; its moves are all events under the requirements.

    `solution` is the result of the fixpoint: the good states of each round, and those that reach a marked state.
    """

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        encoding: Encoding,
        relations: Sequence[EventRelation] | None = None,
        solution: SupervisedStates | None = None,
    ) -> None:
        """Compute `relations` and `solution` unless they are given."""
        relations = event_relations(model, encoding) if relations is None else relations
        super().__init__(
            model, encoding, {relation.event: relation for relation in relations}, required_moves(relations)
        )
        #: For each event, the states, and the inputs of a command, in which its requirements hold.
        self.required = {relation.event: relation.permitted for relation in relations}
        self.solution = solution or self._supervised()
        self.controlled = self.solution.controlled

    def without(self, requirements: AbstractSet[sct.StatedRequirement]) -> SynthesizedSystem:
        """Return the system without some requirements.

        If a requirement on an action is left out, its failure no longer cancels the action; the others still do.
        """
        other = copy(self)
        vars(other).pop("layers", None)
        other.required = {}
        for event, relation in self.relations.items():
            trigger = self.start_of(event)
            if trigger is None:
                other.required[event] = self._permitted(relation, requirements)
            else:
                other.required[event] = ~self.started_where(trigger, requirements)
        moves = ((relation, relation.step_where(other.required[event])) for event, relation in self.relations.items())
        other.moves = [(relation, step) for relation, step in moves if step is not None]
        other.supervised_moves = other.moves
        other.violations = {
            requirement: states for requirement, states in self.violations.items() if requirement not in requirements
        }
        other.goals = {required: goal for required, goal in self.goals.items() if required not in requirements}
        other.solution = other._supervised()  # noqa: SLF001  # of the same class
        other.controlled = other.solution.controlled
        return other

    def _supervised(self) -> SupervisedStates:
        search = Search(
            self.encoding, list(self.relations.values()), self.moves, self.violating, list(self.goals.values())
        )
        return completed(supervise_forwards(search))

    def violated(self, codes: Codes) -> tuple[sct.StatedRequirement, ...]:
        """Return the requirements that a state violates, else those whose states it cannot reach.

        If it reaches them, the result is about the first state that does not, on a shortest way to a marked state.
        """
        violated = super().violated(codes) or self._unreachable_goals(codes)
        if violated or not self.goals:
            return violated
        encoding, allowed = self.encoding, self.solution.reached & ~self.violating
        way = shortest_path(encoding, self.moves, encoding.state(codes), encoding.all_marked & allowed, allowed)
        unreachable = map(self._unreachable_goals, () if way is None else way.states)
        return next(filter(None, unreachable), ())

    def _unreachable_goals(self, codes: Codes) -> tuple[sct.StatedRequirement, ...]:
        """Return the requirements with a premise that holds in a state and a goal that it cannot reach."""
        here, moves = self.encoding.state(codes), steps(self.moves)
        due = {required: goal for required, goal in self.goals.items() if self.is_in(codes, goal.premise)}
        if not due:
            return ()
        onwards = reachable(self.diagrams, moves, here, self.solution.rounds.alive[0] | here)
        return tuple(
            required
            for required, goal in due.items()
            if not (onwards & goal.states).satisfiable()
            or not (here & reaching(self.diagrams, moves, goal, onwards)).satisfiable()
        )

    def stranded(self, required: sct.ReachabilityRequirement) -> Diagram:
        """Return the states with the premise of a requirement that cannot reach its goal.

        They are reachable under the requirements that restrict events.
        """
        goal, reached = self.goals[required], self.solution.reached
        return reached & goal.premise & ~reaching(self.diagrams, steps(self.moves), goal, reached)

    def permitted(self, event: sct.Event) -> Diagram:
        """Return the states, and inputs of a command, in which the requirements permit an event."""
        return self.required[event]

    def allowed(self, event: sct.Event) -> Diagram:
        """Return the controlled states in which the event can happen."""
        enabled = self.controlled & self.relations[event].allowed_by(self.required[event])
        step = next((step for relation, step in self.moves if relation.event is event), None)
        return enabled & step.preimage(self.controlled) if event.controllable and step is not None else enabled

    def group_requirements(
        self, first: Iterable[sct.StatedRequirement] = ()
    ) -> list[tuple[sct.StatedRequirement, ...]]:
        """Return the requirements grouped by their place in the text, those of `first` before the others.

        Requirements that define when an action is canceled are left out.
        """
        enforced = (requirement for requirement in self.model.requirements if self.start_of(requirement.event) is None)
        own: list[sct.StatedRequirement] = [
            *enforced,
            *self.model.invariants,
            *self.model.reachabilityRequirements,
        ]
        by_place: dict[object, list[sct.StatedRequirement]] = {}
        for requirement in dict.fromkeys([*(requirement for requirement in first if requirement in own), *own]):
            by_place.setdefault(requirement.source or requirement, []).append(requirement)
        return [tuple(requirements) for requirements in by_place.values()]

    def start_of(self, event: sct.Event) -> sct.Event | None:
        """Return the start of the action whose requirements define when `event` cancels it; None for other events.

        The requirement that defines it has the place of the action itself.
        """
        plant, requirements = plant_of(event), self.relations[event].requirements
        stands_there = plant.source is not None and [requirement.source for requirement in requirements] == [
            plant.source
        ]
        if event.kind != sct.EventKind.cancel or not stands_there:
            return None
        return next((other for other in plant.events if other.kind == sct.EventKind.trigger), None)

    def started_where(self, trigger: sct.Event, left_out: AbstractSet[sct.StatedRequirement] = frozenset()) -> Diagram:
        """Return the states in which an action is not canceled: those that satisfy its `needs` requirements.

        Orders and counts are ignored: they restrict only another start.
        """
        relation = self.relations[trigger]
        automata = {requirement for requirement in relation.requirements if requirement.automaton is not None}
        return self._of_running_goal(relation, self._permitted(relation, left_out | automata))

    def goal_satisfies(self, relation: EventRelation, requirement: sct.Requirement) -> Diagram:
        """Return the states in which the data of a running goal satisfy a requirement on its start."""
        return self._of_running_goal(relation, relation.condition_of(requirement))

    def _of_running_goal(self, relation: EventRelation, condition: Diagram) -> Diagram:
        """Return a condition on the data of a start as a condition on the variables that hold these data."""
        equal, diagrams = self.encoding.equal, self.diagrams
        copies = [
            equal(update.variable, update.value.input)
            for edge in relation.own_edges
            for update in edge.updates
            if isinstance(update.value, sct.InputReference)
        ]
        return and_exists(condition, diagrams.all_of(copies), relation.inputs) if copies else condition

    def _permitted(self, relation: EventRelation, left_out: AbstractSet[sct.StatedRequirement]) -> Diagram:
        """Return the states, and inputs of a command, in which the requirements that are not left out hold."""
        remaining = (requirement for requirement in relation.requirements if requirement not in left_out)
        return self.diagrams.all_of(map(relation.condition_of, remaining))


class GuardedSystem(SupervisedSystem):
    """System that a controller executes.

    An event happens if its plants enable it and both parts of its guard hold. These are expressions of the supervisor;
    the requirements are not evaluated. Without `guards`, the system consists of the plants alone. Raises ValueError if
    the model has no supervisor.
    """

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        encoding: Encoding,
        relations: Sequence[EventRelation] | None = None,
        *,
        guards: bool = True,
    ) -> None:
        """Compute `relations` unless they are given."""
        if model.supervisor is None:
            raise ValueError(f"{model.name} has no supervisor: synthesize it first")
        self.supervisor = model.supervisor
        self.guards = {guard.event: guard for guard in model.supervisor.guards if guards}
        known = event_relations(model, encoding) if relations is None else relations
        super().__init__(model, encoding, {relation.event: relation for relation in known}, [])
        #: States in which an event can happen, reachable or not.
        self.allowed = {event: relation.allowed_by(self.guard(event)) for event, relation in self.relations.items()}
        supervised = [
            (relation, self.allowed[event], relation.step_where(self.guard(event)))
            for event, relation in self.relations.items()
        ]
        self.moves = [(relation, step) for relation, _, step in supervised if step is not None]
        self.supervised_moves = self.moves
        self.internal = internal_events(supervised, self.guards.values())

    @cached_property
    def initial(self) -> Diagram:
        """Initial states that the supervisor allows."""
        return self.encoding.initial & self.encoding.holds(self.supervisor.initial)

    def guard(self, event: sct.Event) -> Diagram:
        """Return the states, and inputs of a command, in which the supervisor allows an event; all without a guard."""
        guard = self.guards.get(event)
        if guard is None:
            return self.diagrams.true
        return self.encoding.holds(guard.requirement) & self.encoding.holds(guard.synthesis)

    permitted = guard

    def happens(self, event: sct.Event) -> Diagram:
        """Return the states, and inputs of a command, in which an event can happen, reachable or not."""
        relation = self.relations[event]
        return (relation.happens if relation.is_decided_by_data else relation.enabled) & self.guard(event)

    @cached_property
    def completion(self) -> Completion:
        """Maximum number of consecutive internal events, and the states from which they never end."""
        return completion(self.diagrams, self.internal, self.controlled, _EFFORT)


class ExplainedSystem(SynthesizedSystem):
    """System under the supervisor of its model; `moves` and `solution` are those of synthesis nevertheless.

    Raises ValueError if the model has no supervisor.
    """

    def __init__(self, model: sct.SupervisoryControlModel, encoding: Encoding) -> None:
        relations = event_relations(model, encoding)
        super().__init__(model, encoding, relations)
        self._guarded = GuardedSystem(model, encoding, relations)
        self.supervised_moves = self._guarded.moves
        self.initial, self.controlled = self._guarded.initial, self._guarded.controlled

    def permitted(self, event: sct.Event) -> Diagram:
        """Return the states, and inputs of a command, in which the supervisor permits an event."""
        return self._guarded.guard(event)

    def allowed(self, event: sct.Event) -> Diagram:
        """Return the controlled states in which the event can happen."""
        return self.controlled & self._guarded.allowed[event]

    def without(self, requirements: AbstractSet[sct.StatedRequirement]) -> SynthesizedSystem:
        """Return the system that synthesis would compute without some requirements."""
        own = SynthesizedSystem(self.model, self.encoding, list(self.relations.values()), self.solution)
        return own.without(requirements)


def whole_state(model: sct.SupervisoryControlModel, codes: Codes) -> dict[str, Value]:
    """Return the state with these codes, as `robosc simulate` prints it."""
    return named_state(model, lambda element: value(element, codes[element]))


def format_count(number: int, what: str) -> str:
    """Return a number of things as text: `1 state`, `1,234 states`, `1.27e+30 states`."""
    return f"{format_number(number)} {what}" if number == 1 else f"{format_number(number)} {what}s"


def format_number(number: int) -> str:
    """Return a number as text for users: `1,234`, `1.27e+30`."""
    return f"{number:,}" if number < 10**_DIGITS else f"{Decimal(number):.2e}"
