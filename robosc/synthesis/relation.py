"""Transition relations of the events, each over only the elements that the event touches."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from robosc.model import sct
from robosc.model.semantics.edges import edges_by_event
from robosc.synthesis import arithmetic
from robosc.synthesis.bdd import Diagram, and_exists
from robosc.synthesis.encoding import referenced_elements

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.model import expression as ex
    from robosc.synthesis.encoding import Element, Encoding

    Move = tuple["EventRelation", "SymbolicStep"]


class Goal(NamedTuple):
    """States that must stay reachable from each state with the premise. The marked states are one for all states.

    Each state of the path, both ends included, is in `along`; None: all states. `bound` is its maximum number of
    events; None: any number.
    """

    premise: Diagram
    states: Diagram
    along: Diagram | None = None
    bound: int | None = None


@dataclass(frozen=True)
class SymbolicStep:
    """All moves of an event under a condition.

    The inputs of the event are quantified: each of their values may occur. `relation` is over present and next values.
    `present` and `following` are the variables of the changed elements. `same` states that these are equal: renaming by
    conjunction, unlike substitution, does not touch the diagram below. `changed` are the changed elements. `touched`
    are these and the elements that the plants read. It is empty unless some integer is wide. `events` are the events of
    the moves.
    """

    level: int
    relation: Diagram
    present: Diagram
    following: Diagram
    same: Diagram
    encoding: Encoding
    changed: tuple[Element, ...]
    touched: tuple[Element, ...]
    events: tuple[sct.Event, ...] = ()

    def image(self, states: Diagram) -> Diagram:
        """Return the states after the event in one of `states`."""
        apart = self.apart
        moved = and_exists(states, self.relation if apart is None else apart[0], self.present)
        # Most images are empty.
        if not moved.satisfiable():
            return moved
        return and_exists(moved, self.same, self.following) if apart is None else moved & apart[1]

    def preimage(self, states: Diagram) -> Diagram:
        """Return the states in which the event can lead to one of `states`."""
        apart = self.apart
        moved = and_exists(states, self.same if apart is None else apart[1], self.present)
        if not moved.satisfiable():
            return moved
        return and_exists(moved, self.relation, self.following) if apart is None else moved & apart[0]

    @cached_property
    def apart(self) -> tuple[Diagram, Diagram] | None:
        """Source and target as sets of states, or None if the target depends on the source.

        Most events are `apart`. Following such an event takes no next values, and a second time adds no state.
        """
        source, target = self.relation.exists(self.following), self.relation.exists(self.present)
        if source & target != self.relation:
            return None
        return source, and_exists(target, self.same, self.following)


def join_steps(first: SymbolicStep, second: SymbolicStep) -> SymbolicStep:
    """Return a step that does one of the two, at the level of the first; neither touches a wide integer."""

    def framed(step: SymbolicStep) -> Diagram:
        # From the bottom: each conjunction rebuilds the diagram above it.
        unchanged = sorted(set(changed) - set(step.changed), key=lambda element: domains[element].levels, reverse=True)
        return all_of(map(encoding.keeps, unchanged)) & step.relation

    encoding = first.encoding
    all_of, domains = encoding.diagrams.all_of, encoding.layout.domains
    changed = tuple(dict.fromkeys((*first.changed, *second.changed)))
    return replace(
        first,
        relation=framed(first) | framed(second),
        present=first.present & second.present,
        following=first.following & second.following,
        same=first.same & second.same,
        changed=changed,
        events=(*first.events, *second.events),
    )


class EventRelation:
    """Relation of one event: the states in which plants enable it and requirements allow it, and its changes."""

    def __init__(
        self,
        event: sct.Event,
        edges: Sequence[Sequence[sct.Edge]],
        requirements: Sequence[sct.Requirement],
        encoding: Encoding,
    ) -> None:
        """Compute the conditions of the event from its edges, grouped by plant, and its requirements.

        `enabled_by` maps each of these plants to the states in which it enables the event. `permissions` maps each
        requirement to the states in which it allows the event, and `requirement` is the conjunction. If the event is a
        command with inputs, the sets hold the states in which this is true for some of its data. `permitted` is then a
        condition on states and inputs; for other events, it is `requirement`.
        """
        self.event = event
        self.requirements = requirements
        self._encoding = encoding
        self._edges = edges
        changed = [element for edges in self._edges for element in _changed(edges)]
        self.changed = tuple(element for element in changed if encoding.layout.domains[element].size > 1)
        self.enabled_by = {edges[0].target.eContainer(): self.states_taking(edges) for edges in self._edges}
        self.enabled = (
            self.happens.exists(self.inputs) if self.is_decided_by_data else self._all_of(self.enabled_by.values())
        )
        self.permissions = {requirement: self._permitted(requirement) for requirement in requirements}
        if self.has_data:
            self.permitted = self._all_of(map(self.condition_of, requirements))
            self.requirement = ~self.enabled | self.allowed_by(self.permitted)
        else:
            self.permitted = self.requirement = self._all_of(self.permissions.values())

    @property
    def has_data(self) -> bool:
        """Whether the supervisor decides with the inputs: the event is a command that carries them."""
        return self.event.controllable and bool(self.event.inputs)

    @property
    def is_decided_by_data(self) -> bool:
        """Whether the event may be impossible because of its inputs: a command, or a goal that is rejected."""
        return bool(self.event.inputs) and (self.event.controllable or self.event.kind == sct.EventKind.request)

    @cached_property
    def happens(self) -> Diagram:
        """States and inputs for which all plants have an edge for the event."""
        encoding = self._encoding
        taking = (
            encoding.diagrams.any_of(encoding.source(edge) & encoding.holds(edge.guard) for edge in edges)
            for edges in self._edges
        )
        return self._all_of([encoding.whole(self.event.inputs), *taking])

    @cached_property
    def available(self) -> Diagram:
        """States in which each plant has an edge for the event that data might enable."""
        encoding = self._encoding
        return self._all_of(
            encoding.diagrams.any_of(
                encoding.source(edge) & encoding.holds(None if reads_inputs(edge.guard) else edge.guard)
                for edge in edges
            )
            for edges in self._edges
        )

    def allowed_by(self, condition: Diagram) -> Diagram:
        """Return the states in which the event can happen under a condition, which may read the inputs of a command."""
        if not self.has_data:
            return self.enabled & condition
        return and_exists(self.happens, condition, self.inputs)

    def leading_to(self, states: Diagram) -> Diagram:
        """Return the states and inputs with which a command leads to one of `states`."""
        if not self.changed:
            return states
        domains, diagrams = self._encoding.layout.domains, self._encoding.diagrams
        present = diagrams.cube(level for element in self.changed for level in domains[element].levels)
        following = diagrams.cube(level for element in self.changed for level in domains[element].next_levels)
        same = diagrams.all_of(self._encoding.keeps(element) for element in self.changed)
        return and_exists(self.with_inputs(), and_exists(states, same, present), following)

    def _all_of(self, diagrams: Iterable[Diagram]) -> Diagram:
        return self._encoding.diagrams.all_of(diagrams)

    def condition_of(self, requirement: sct.Requirement) -> Diagram:
        """Return the states in which a requirement allows the event, and the inputs if it is a command with data."""
        return self._encoding.permits(requirement) if self.has_data else self.permissions[requirement]

    @property
    def own_edges(self) -> Sequence[sct.Edge]:
        """Edges of the event in its own plant."""
        return next((edges for edges in self._edges if edges[0].target.eContainer() is self.event.eContainer()), ())

    def _permitted(self, requirement: sct.Requirement) -> Diagram:
        """Return the states in which a requirement allows the event.

        It allows an event of the robot if it holds with all inputs for which the plants enable the event, and a command
        if it holds with some of them.
        """
        permits = self._encoding.permits(requirement)
        if not reads_inputs(requirement.condition):
            return permits
        if self.has_data:
            return ~self.enabled | self.allowed_by(permits)
        return ~(self.happens & ~permits).exists(self.inputs)

    def with_inputs(self) -> Diagram:
        """Return the relation over present values, inputs and next values, without the requirements."""
        return self._encoding.diagrams.all_of(
            [
                *(self._encoding.in_domain(parameter) for parameter in self.event.inputs),
                *(self._moves(edges) for edges in self._edges),
            ]
        )

    def between(
        self, before: Mapping[Element, int], after: Mapping[Element, int], condition: Diagram | None = None
    ) -> Diagram:
        """Return the input values with which the event leads from one state to another, both given by codes.

        `condition` is a further condition on the state before and the inputs.
        """
        encoding = self._encoding
        result = self.with_inputs() & encoding.state(before)
        if condition is not None:
            result &= condition
        for element in self.changed:
            result &= encoding.becomes(element, arithmetic.constant(encoding.diagrams, after[element]))
        domains = encoding.layout.state
        levels = [level for domain in domains for level in (*domain.levels, *domain.next_levels)]
        return result.exists(encoding.diagrams.cube(levels))

    def forbidding(self, before: Mapping[Element, int], after: Mapping[Element, int]) -> tuple[sct.Requirement, ...]:
        """Return the requirements that keep the event from leading from one state to another, with any data.

        If each permits some data that lead there, but none permits all at once, these are all requirements.
        """
        if not self.has_data:
            here = self._encoding.state(before)
            return tuple(own for own, permits in self.permissions.items() if not (here & permits).satisfiable())
        alone = (
            own for own in self.requirements if not self.between(before, after, self.condition_of(own)).satisfiable()
        )
        return tuple(alone) or (
            () if self.between(before, after, self.permitted).satisfiable() else tuple(self.requirements)
        )

    def forbidden_by(self, requirement: sct.Requirement) -> Diagram:
        """Return the states in which the plants enable the event and a requirement forbids it, or some of its data."""
        return self.allowed_by(~self.condition_of(requirement))

    def may_lead_to(self, codes: Mapping[Element, int]) -> bool:
        """Return whether the event can lead to a state with these codes. Checks only the plants' locations.

        The answer may be True for a state that the event does not lead to; False is exact.
        """
        return all(codes[plant] in targets for plant, targets in self._targets)

    @cached_property
    def _targets(self) -> list[tuple[sct.Plant, frozenset[int]]]:
        """For each plant that takes part, the codes of the target locations of the event."""
        return [
            (plant, frozenset(self._encoding.location_code(edge.target) for edge in edges))
            for plant, edges in zip(self.enabled_by, self._edges, strict=True)
        ]

    @cached_property
    def plant_step(self) -> SymbolicStep | None:
        """Step of the event in the states in which the plants enable it; None if it changes nothing."""
        return self.step_where(self._encoding.diagrams.true)

    @cached_property
    def step(self) -> SymbolicStep | None:
        """Step of the event in the states in which the requirements allow it, too."""
        return self.plant_step if self.permitted.valid() else self.step_where(self.permitted)

    @cached_property
    def touched(self) -> frozenset[Element]:
        """Elements that the plants read or change during the event, or read to enable it."""
        touched = {*self.enabled_by, *self.changed}
        for edge in (edge for edges in self._edges for edge in edges):
            touched.update(referenced_elements(edge.guard))
            for update in edge.updates:
                touched.update(referenced_elements(update.value))
        return frozenset(touched)

    @cached_property
    def concerned(self) -> frozenset[Element]:
        """The elements of `touched` and those that the requirements read."""
        return self.touched.union(*(referenced_elements(requirement.condition) for requirement in self.requirements))

    def step_where(self, condition: Diagram) -> SymbolicStep | None:
        """Return the step of the event under a condition on states and inputs; None if the event changes nothing."""
        if not self.changed:
            return None
        domains = self._encoding.layout.domains
        diagrams = self._encoding.diagrams
        relation = and_exists(self.with_inputs(), condition, self.inputs)
        present = [level for element in self.changed for level in domains[element].levels]
        following = [level for element in self.changed for level in domains[element].next_levels]
        return SymbolicStep(
            level=min([*present, *_support_top(relation)]),
            relation=relation,
            present=diagrams.cube(present),
            following=diagrams.cube(following),
            same=diagrams.all_of(self._encoding.keeps(element) for element in self.changed),
            encoding=self._encoding,
            changed=self.changed,
            touched=tuple(sorted(self.touched, key=lambda element: domains[element].rank))
            if self._encoding.layout.wide
            else (),
            events=(self.event,),
        )

    @property
    def inputs(self) -> Diagram:
        """Variables of the inputs of the event."""
        domains = self._encoding.layout.domains
        return self._encoding.diagrams.cube(
            level for parameter in self.event.inputs for level in domains[parameter].levels
        )

    def states_taking(self, edges: Sequence[sct.Edge]) -> Diagram:
        """Return the states in which one of these edges of a plant can be taken with some inputs."""
        encoding = self._encoding
        enabled = encoding.diagrams.any_of(encoding.source(edge) & encoding.holds(edge.guard) for edge in edges)
        if not any(edge.guard is not None for edge in edges):
            return enabled
        return and_exists(enabled, encoding.whole(self.event.inputs), self.inputs)

    def overlapping_edges(self) -> list[sct.Edge]:
        """Return the edges that overlap with an earlier edge of the same plant."""
        overlaps = []
        for edges in self._edges:
            if len(edges) > len({edge.eContainer() for edge in edges}):
                before = self._encoding.diagrams.false
                for edge in edges:
                    taken = self._encoding.source(edge) & self._encoding.holds(edge.guard)
                    taken &= self._encoding.whole(referenced_elements(edge.guard))
                    if (taken & before & self.enabled).satisfiable():
                        overlaps.append(edge)
                    before |= taken
        return overlaps

    def _moves(self, edges: Sequence[sct.Edge]) -> Diagram:
        """Return the part of one plant in the relation."""
        encoding = self._encoding
        result = encoding.diagrams.false
        changed = _changed(edges)
        for edge in edges:
            values = {update.variable: update.value for update in edge.updates}
            move = encoding.source(edge) & encoding.holds(edge.guard)
            for element in changed:
                if element in values:
                    assert isinstance(element, sct.DiscreteVariable)
                    move &= encoding.becomes(element, encoding.code(values[element], element))
                elif isinstance(element, sct.Plant):
                    move &= encoding.next_location(edge.target)
                else:
                    move &= encoding.keeps(element)
            result |= move
        return result


def event_relations(model: sct.SupervisoryControlModel, encoding: Encoding) -> list[EventRelation]:
    """Return the relations of all events, in the order of the plants."""
    edges, requirements = edges_by_event(model.plants), requirements_by_event(model.requirements)
    return [
        EventRelation(event, list(edges.get(event, {}).values()), requirements.get(event, []), encoding)
        for plant in model.plants
        for event in plant.events
    ]


def violations(
    model: sct.SupervisoryControlModel, relations: Iterable[EventRelation], encoding: Encoding
) -> dict[sct.StatedRequirement, Diagram]:
    """Return, for each requirement, the states that violate it independently of the supervisor.

    These are the states in which an invariant does not hold, and those in which a forbidden uncontrollable event can
    happen.
    """
    violating: dict[sct.StatedRequirement, Diagram] = {
        invariant: ~encoding.holds(invariant.condition) for invariant in model.invariants
    }
    for relation in relations:
        if not relation.event.controllable:
            violating.update(
                (requirement, relation.enabled & ~permission)
                for requirement, permission in relation.permissions.items()
            )
    return violating


def goals(model: sct.SupervisoryControlModel, encoding: Encoding) -> dict[sct.ReachabilityRequirement, Goal]:
    """Return the goal of each requirement that demands one."""
    return {required: goal(required, encoding) for required in model.reachabilityRequirements}


def goal(required: sct.ReachabilityRequirement, encoding: Encoding) -> Goal:
    """Return the goal of a requirement. It concerns only states that satisfy the condition of its path."""
    premise, states = encoding.holds(required.premise), encoding.holds(required.condition)
    if required.pathCondition is None:
        return Goal(premise, states, bound=required.bound)
    along = encoding.holds(required.pathCondition)
    return Goal(premise & along, states, along, required.bound)


def requirements_by_event(requirements: Iterable[sct.Requirement]) -> dict[sct.Event, list[sct.Requirement]]:
    """Return the requirements of each event that has any."""
    by_event: dict[sct.Event, list[sct.Requirement]] = {}
    for requirement in requirements:
        by_event.setdefault(requirement.event, []).append(requirement)
    return by_event


def plant_moves(relations: Iterable[EventRelation]) -> list[Move]:
    """Return the events that change something, with their steps under the plants."""
    return [(relation, relation.plant_step) for relation in relations if relation.plant_step is not None]


def required_moves(relations: Iterable[EventRelation]) -> list[Move]:
    """Return the events that change something, with their steps under plants and requirements."""
    return [(relation, relation.step) for relation in relations if relation.step is not None]


def steps(moves: Iterable[Move]) -> list[SymbolicStep]:
    """Return the steps of the events."""
    return [step for _, step in moves]


def reads_inputs(condition: ex.Expression | None) -> bool:
    """Return whether a condition reads inputs."""
    return any(isinstance(element, sct.Input) for element in referenced_elements(condition))


def _changed(edges: Sequence[sct.Edge]) -> list[Element]:
    """Return the plant if some edge leaves its location, and the variables that some edge updates."""
    changed: dict[Element, None] = {}
    for edge in edges:
        if edge.target is not edge.eContainer():
            changed[edge.target.eContainer()] = None
    for edge in edges:
        changed.update((update.variable, None) for update in edge.updates)
    return list(changed)


def _support_top(diagram: Diagram) -> list[int]:
    level = diagram.node_level()
    return [] if level is None else [level]
