"""Suspicious properties of a nonempty supervisor: unintended freedom, impossible events, unreachable states."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum, auto
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, TypeVar

from robosc.analysis.blocking import BlockingCounterexample, blocking_counterexample, never_ready, requirements_at_fault
from robosc.analysis.given_supervisor import flaws
from robosc.analysis.paths import Layers, Path
from robosc.model import sct
from robosc.model.semantics.communication import ANSWERS, RUNNING
from robosc.model.semantics.roles import assumptions, plant_of, provide_numbers
from robosc.synthesis.decoding import Value, value
from robosc.synthesis.encoding import pick
from robosc.synthesis.fixpoint import coreachable
from robosc.synthesis.relation import steps

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.analysis.given_supervisor import Flaw
    from robosc.analysis.paths import TraceStep
    from robosc.analysis.system import SynthesizedSystem
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element
    from robosc.synthesis.guards import Permission
    from robosc.synthesis.relation import EventRelation

_Key = TypeVar("_Key", sct.Event, sct.Plant)
_CALLS = (sct.PlantKind.service, sct.PlantKind.action)
#: Effort limits for the counterexamples of all guards: the search, in visited nodes, and the total number of steps.
_EFFORT = 1_000_000
_STEPS = 400
#: Effort limit for counting the states in which requirements matter, in visited nodes.
_WEIGHING = 20_000_000
_FOLLOWS_THE_ROBOT = (sct.EventKind.tau, sct.EventKind.reset, sct.EventKind.cancel)


class Forbidden(Enum):
    """First cause in this order that makes an event impossible."""

    BY_PLANTS = auto()
    BY_REQUIREMENTS = auto()
    BY_SYNTHESIS = auto()


@dataclass(frozen=True)
class NeverEnabled:
    """Trigger, answer or tau event that is allowed in no controlled state.

    `plants` each disable it in every controlled state. `requirements` disable it in all states in which the plants
    enable it, even if these are outside of the controlled states: see `requirements_at_fault`. `trace` is then a
    shortest path of the plants to one of these states, if an order, a count or an automaton is among the requirements.

    If `kept_away`, the plants disable the event only because the supervisor keeps the robot away from the states that
    enable it. A shortest path of the plants to such a state contains an event that the supervisor holds back. The
    reason is either `requirements` on `needed`, the last event of `trace`, or `counterexample`; neither is given if the
    search exceeds its effort limit. `counterexample` is also given if synthesis forbids the event itself.
    """

    event: sct.Event
    forbidden: Forbidden
    plants: tuple[sct.Plant, ...] = ()
    requirements: tuple[sct.Requirement, ...] = ()
    kept_away: bool = False
    counterexample: BlockingCounterexample | None = None
    trace: tuple[TraceStep, ...] | None = None
    needed: sct.Event | None = None


@dataclass(frozen=True)
class NeverEnding:
    """Service or action that the controller serves, with a request or goal that can never end after `trace`."""

    plant: sct.Plant
    trace: tuple[TraceStep, ...]


@dataclass(frozen=True)
class SilentRestricted:
    """Tau, reset or cancel event that synthesis restricts."""

    event: sct.Event
    counterexample: BlockingCounterexample


@dataclass(frozen=True)
class ForbiddenCancel:
    """Cancel that is due but forbidden by an order, a count or an automaton after `trace`."""

    event: sct.Event
    requirement: sct.Requirement
    trace: tuple[TraceStep, ...]


@dataclass(frozen=True)
class SharedServer:
    """Services or actions of one ROS name that can run at the same time: `second`, and the first before it.

    `trace` leads to such a state. `others` are further ones before `second` that can run at the same time as it.
    """

    first: sct.Plant
    second: sct.Plant
    trace: tuple[TraceStep, ...]
    others: tuple[sct.Plant, ...] = ()


@dataclass(frozen=True)
class SelfCancelling:
    """Action, given by its trigger, whose requirement holds in no state directly after its start.

    `requirements` are the requirements on it that hold in none of these states: see `requirements_at_fault`.
    """

    event: sct.Event
    requirements: tuple[sct.Requirement, ...]


@dataclass(frozen=True)
class Example:
    """A controlled state: the location of every plant by name, the value of every variable.

    `quiescent`: no internal event is allowed in the state. An example that is not quiescent is used only if none is.
    """

    state: Mapping[Element, Value]
    quiescent: bool


@dataclass(frozen=True)
class ProvideGap:
    """Trigger that is allowed in a state in which no condition of its data holds.

    `data` is the plant with these conditions. `example` is such a state.
    """

    event: sct.Event
    data: sct.Plant
    example: Example


@dataclass(frozen=True)
class SharedTopicConflict:
    """Commands to one topic that can be sent in the same state: `second`, and the first before it, with an example.

    `others` are further ones before `second` that can be sent together with it.
    """

    first: sct.Event
    second: sct.Event
    example: Example
    others: tuple[sct.Event, ...] = ()


@dataclass(frozen=True)
class Hindrance:
    """Reason why a transition to a state from another is never taken.

    `forbidden` is None if the source state is never reached. `plants` are those that are never ready for the transition
    in the source state, possibly its own plant; none if each is ready but never all at once. `requirements` forbid it
    there: see `requirements_at_fault`. `counterexample` is given if synthesis forbids it.
    """

    edge: sct.Edge
    forbidden: Forbidden | None
    plants: tuple[sct.Plant, ...] = ()
    requirements: tuple[sct.Requirement, ...] = ()
    counterexample: BlockingCounterexample | None = None


@dataclass(frozen=True)
class UnreachableState:
    """Location of a component in no controlled state, and the reason for each transition to it."""

    location: sct.Location
    hindrances: tuple[Hindrance, ...]


@dataclass(frozen=True)
class Weight:
    """A requirement of the text, as requirements of the model, and the number of states in which it matters.

    If it restricts the controller, these are the controlled states in which the plants allow an event that it forbids.
    Otherwise, they are the states that it forbids among those reachable under the requirements that restrict the
    controller. For one about reachable states, these are the states that cannot reach its condition.
    """

    requirements: tuple[sct.StatedRequirement, ...]
    states: int


@dataclass(frozen=True)
class Observations:
    """All observations of a supervisor, each kind in the order of the model.

    `unrestricted_calls` are triggers of services and actions that can happen, have no requirement, and involve no other
    plant than their own. `unused_assumptions` are those that none of their events could violate, one for each text.
    `rejected_goals` are the requests of actions whose every goal is rejected. `counterexamples` explain events that
    synthesis restricts; large models may lack some of them. `flaws` are those of a supervisor that the model already
    has.
    """

    never_enabled: tuple[NeverEnabled, ...]
    silent_restricted: tuple[SilentRestricted, ...]
    self_cancelling: tuple[SelfCancelling, ...]
    forbidden_cancels: tuple[ForbiddenCancel, ...]
    shared_servers: tuple[SharedServer, ...]
    provide_gaps: tuple[ProvideGap, ...]
    shared_topic_conflicts: tuple[SharedTopicConflict, ...]
    unrestricted_calls: tuple[sct.Event, ...]
    unreachable_states: tuple[UnreachableState, ...]
    unused_assumptions: tuple[sct.Plant, ...]
    rejected_goals: tuple[sct.Event, ...]
    never_ending: tuple[NeverEnding, ...]
    counterexamples: Mapping[sct.Event, BlockingCounterexample]
    flaws: tuple[Flaw, ...] = ()


class Observer:
    """Observer of a system whose supervisor is not empty; `permissions` are those of all controllable events."""

    def __init__(self, system: SynthesizedSystem, permissions: Sequence[Permission]) -> None:
        self._system = system
        self._permissions = {permission.relation.event: permission for permission in permissions}
        self._counterexamples: dict[tuple[sct.Event, Diagram], BlockingCounterexample] = {}
        self._triggers = [trigger for trigger in system.roles.triggers if trigger in self._permissions]

    def observations(self) -> Observations:
        """Return all observations."""
        return Observations(
            tuple(self._never_enabled()),
            tuple(self._silent_restricted()),
            tuple(self._self_cancelling()),
            tuple(self._forbidden_cancels()),
            tuple(self._shared_servers()),
            tuple(self._provide_gaps()),
            tuple(self._shared_topic_conflicts()),
            tuple(self._unrestricted_calls()),
            tuple(self._unreachable_states()),
            tuple(self._unused_assumptions()),
            tuple(self._rejected_goals),
            tuple(self._never_ending()),
            dict(self._affordable_counterexamples()),
            flaws(self._system, self._system.solution.reached) if self._system.model.supervised else (),
        )

    def weights(self) -> Iterator[Weight]:
        """Yield, in the order of the model, the number of states in which each requirement matters.

        Yields nothing if the count exceeds its effort limit.
        """
        groups = self._system.group_requirements()
        if len(groups) * self._system.solution.reached.node_count() > _WEIGHING:
            return
        for requirements in groups:
            states = self._system.diagrams.any_of(map(self._matters, requirements))
            # Skip range requirements that matter in no state: they follow from types, and no author wrote them.
            stands = not all(isinstance(own, sct.Requirement) and own.ranges for own in requirements)
            if stands or states.satisfiable():
                yield Weight(requirements, self._system.encoding.count(states))

    def _matters(self, requirement: sct.StatedRequirement) -> Diagram:
        if requirement in self._system.violations:
            return self._system.solution.reached & self._system.violations[requirement]
        if isinstance(requirement, sct.ReachabilityRequirement):
            return self._system.stranded(requirement)
        assert isinstance(requirement, sct.Requirement)
        relation = self._system.relations[requirement.event]
        return self._system.controlled & relation.forbidden_by(requirement)

    def _never_enabled(self) -> Iterator[NeverEnabled]:
        controlled = self._system.controlled
        for event, permission in self._permissions.items():
            if event.kind not in (sct.EventKind.trigger, sct.EventKind.tau, *ANSWERS) or permission.guard.everEnabled:
                continue
            if any(plant_of(event) is plant_of(rejected) for rejected in self._rejected_goals):
                continue
            relation = permission.relation
            in_sight = controlled & relation.enabled
            enabled = in_sight if in_sight.satisfiable() else self._system.uncontrolled & relation.enabled
            forbidden = not (enabled & relation.requirement).satisfiable()
            if not enabled.satisfiable() or not (in_sight.satisfiable() or forbidden):
                plants = never_ready(relation, controlled)
                yield (
                    self._kept_away(event, plants, enabled)
                    if enabled.satisfiable()
                    else NeverEnabled(event, Forbidden.BY_PLANTS, plants=plants)
                )
            elif forbidden:
                requirements = requirements_at_fault(permission.relation, enabled)
                has_automaton = any(requirement.automaton is not None for requirement in requirements)
                way = self._way_of_plants(enabled) if has_automaton else None
                trace = self._system.trace(way) if way is not None else None
                yield NeverEnabled(event, Forbidden.BY_REQUIREMENTS, requirements=requirements, trace=trace)
            else:
                yield NeverEnabled(event, Forbidden.BY_SYNTHESIS, counterexample=self._counterexample(permission))

    def _way_of_plants(self, goal: Diagram) -> Path | None:
        """Return a shortest path of the plants to one of these states; None if it exceeds the effort limit."""
        system = self._system
        within, effort = system.uncontrolled, None if system.violations or system.goals else _EFFORT
        return Layers(system.encoding, system.plant_moves, system.encoding.initial, within).path_to(
            goal & within, effort
        )

    def _kept_away(self, event: sct.Event, plants: tuple[sct.Plant, ...], goal: Diagram) -> NeverEnabled:
        """Return why an event that the plants allow only outside of the controlled states never happens."""
        system = self._system
        way = self._way_of_plants(goal)
        observation = NeverEnabled(event, Forbidden.BY_PLANTS, plants=plants, kept_away=True)
        if way is None:
            return observation
        for number, (relation, _) in enumerate(way.moves):
            permission = self._permissions.get(relation.event)
            before, after = way.states[number], way.states[number + 1]
            if permission is None or (
                system.is_in(after, system.controlled) and not relation.forbidding(before, after)
                if relation.has_data
                else system.is_in(before, permission.allowed)
            ):
                continue
            here = permission.held_back & system.encoding.state(before)
            if here.satisfiable() and not relation.forbidding(before, after):
                return replace(observation, counterexample=self._counterexample(permission, here))
            return replace(
                observation,
                requirements=relation.forbidding(before, after),
                trace=system.trace(Path(way.states[: number + 2], way.moves[: number + 1])),
                needed=relation.event,
            )
        return observation

    def _silent_restricted(self) -> Iterator[SilentRestricted]:
        for event, permission in self._permissions.items():
            if event.kind in _FOLLOWS_THE_ROBOT and (permission.guard.synthesis is not None or permission.unwritten):
                yield SilentRestricted(event, self._counterexample(permission))

    def _self_cancelling(self) -> Iterator[SelfCancelling]:
        for event in self._triggers:
            permission = self._permissions[event]
            step = permission.relation.step
            if plant_of(event).kind != sct.PlantKind.action or not permission.guard.everEnabled:
                continue
            after = permission.where if step is None else step.image(permission.where)
            if not (after & self._system.started_where(event)).satisfiable():
                yield SelfCancelling(event, self._canceling(permission.relation, after))

    def _canceling(self, relation: EventRelation, running: Diagram) -> tuple[sct.Requirement, ...]:
        """Return the requirements on the start of an action that do not hold in these states, where it runs."""
        judging = tuple(requirement for requirement in relation.requirements if requirement.automaton is None)
        if relation.has_data:
            alone = (own for own in judging if not (running & self._system.goal_satisfies(relation, own)).satisfiable())
            return tuple(alone) or judging
        return tuple(requirement for requirement in requirements_at_fault(relation, running) if requirement in judging)

    def _forbidden_cancels(self) -> Iterator[ForbiddenCancel]:
        for event, permission in self._permissions.items():
            if event.kind != sct.EventKind.cancel:
                continue
            relation = permission.relation
            due = self._system.controlled & relation.enabled
            automata = [requirement for requirement in relation.permissions if requirement.automaton is not None]
            for requirement, allowing in relation.permissions.items():
                if requirement.automaton is None:
                    due &= allowing
            for requirement in automata:
                forbidden = due & ~relation.permissions[requirement]
                if forbidden.satisfiable():
                    yield ForbiddenCancel(event, requirement, self._system.trace(self._system.path_to(forbidden)))

    def _shared_servers(self) -> Iterator[SharedServer]:
        servers: dict[tuple[sct.PlantKind, str], list[sct.Plant]] = {}
        for plant in self._system.model.plants:
            if plant.kind in _CALLS and plant.topic:
                servers.setdefault((plant.kind, _server(plant)), []).append(plant)
        for calls in servers.values():
            where = {plant: self._system.controlled & self._running(plant) for plant in calls if len(calls) > 1}
            for (first, *others), second, both in self._meetings(where):
                yield SharedServer(first, second, self._system.trace(self._system.path_to(both)), tuple(others))

    def _meetings(self, where: Mapping[_Key, Diagram]) -> Iterator[tuple[list[_Key], _Key, Diagram]]:
        """Yield each key whose states overlap with those of earlier keys.

        Each result has the earlier keys, the key, and the states shared with the first of them. A key without an
        overlap costs one operation, so hundreds of commands may use one topic.
        """
        before = self._system.diagrams.false
        for position, (second, states) in enumerate(where.items()):
            if (before & states).satisfiable():
                earlier = islice(where.items(), position)
                shared = {first: both for first, other in earlier if (both := other & states).satisfiable()}
                yield list(shared), second, next(iter(shared.values()))
            before |= states

    def _running(self, plant: sct.Plant) -> Diagram:
        """Return the states in which a service or action is running."""
        encoding = self._system.encoding
        running = [location for location in plant.locations if location.name in RUNNING]
        return encoding.diagrams.any_of(map(encoding.location, running))

    @cached_property
    def _rejected_goals(self) -> list[sct.Event]:
        """Requests of actions that the controller serves and that can happen in no controlled state."""
        requests = (event for event in self._system.relations if event.kind == sct.EventKind.request)
        return [
            event
            for event in requests
            if not (self._system.controlled & self._system.relations[event].enabled).satisfiable()
        ]

    def _never_ending(self) -> Iterator[NeverEnding]:
        """Yield the served communications with a controlled state from which they never become idle again."""
        system = self._system
        for plant in system.model.plants:
            if plant.kind in (sct.PlantKind.serviceServer, sct.PlantKind.actionServer):
                idle = system.controlled & system.encoding.location(plant.locations[0])
                ending = coreachable(system.diagrams, steps(system.supervised_moves), idle, system.controlled)
                endless = system.controlled & ~ending
                if endless.satisfiable():
                    yield NeverEnding(plant, system.trace(system.path_to(endless)))

    def _provide_gaps(self) -> Iterator[ProvideGap]:
        for event in self._triggers:
            plant = self._system.roles.data_plants.get(event)
            if plant is None or event.kind in (sct.EventKind.replyError, sct.EventKind.replyCanceled):
                continue
            gap = self._permissions[event].allowed
            for chosen, number in provide_numbers(plant).items():
                if chosen in self._permissions and number:
                    gap &= ~self._permissions[chosen].relation.enabled
            if gap.satisfiable():
                yield ProvideGap(event, plant, self._example(gap))

    def _shared_topic_conflicts(self) -> Iterator[SharedTopicConflict]:
        for events in self._system.roles.shared_topics:
            where = {event: self._permissions[event].allowed for event in events if event in self._permissions}
            for (first, *others), second, both in self._meetings(where):
                yield SharedTopicConflict(first, second, self._example(both), tuple(others))

    def _unrestricted_calls(self) -> Iterator[sct.Event]:
        for event in self._triggers:
            plant, permission = plant_of(event), self._permissions[event]
            alone = all(
                participant is plant or participant.kind == sct.PlantKind.requirement
                for participant in permission.relation.enabled_by
            )
            restricted = permission.relation.requirements or not alone
            if plant.kind in _CALLS and not restricted and permission.guard.everEnabled:
                yield event

    def _unreachable_states(self) -> Iterator[UnreachableState]:
        for plant in self._system.model.plants:
            if plant.kind != sct.PlantKind.behaviour:
                continue
            reached = [
                (self._system.controlled & self._system.encoding.location(location)) for location in plant.locations
            ]
            if all(states.satisfiable() for states in reached):
                continue
            states = dict(zip(plant.locations, reached, strict=True))
            for location in plant.locations:
                if not states[location].satisfiable():
                    leading = (
                        edge
                        for other in plant.locations
                        for edge in other.edges
                        if edge.target is location and other is not location
                    )
                    hindrances = [self._hindrance(edge, states[edge.eContainer()]) for edge in leading]
                    yield UnreachableState(location, tuple(hindrances))

    def _unused_assumptions(self) -> Iterator[sct.Plant]:
        """Yield the first assumption of each text, such as one with `each`, of which none excludes anything."""
        by_text: dict[object, list[sct.Plant]] = {}
        for plant in assumptions(self._system.model):
            by_text.setdefault(plant.source or plant, []).append(plant)
        for alike in by_text.values():
            if not any(map(self._excludes, alike)):
                yield alike[0]

    def _excludes(self, assumption: sct.Plant) -> bool:
        """Return whether one of its events could come in a state in which an assumption forbids it."""
        events = dict.fromkeys(edge.event for location in assumption.locations for edge in location.edges)
        relations = self._system.relations
        return any(self._could_violate(relations[event], assumption).satisfiable() for event in events)

    def _could_violate(self, relation: EventRelation, assumption: sct.Plant) -> Diagram:
        """Return the controlled states in which all plants but the assumption allow an event."""
        others = [enabled for plant, enabled in relation.enabled_by.items() if plant is not assumption]
        return self._system.controlled & ~relation.enabled_by[assumption] & self._system.diagrams.all_of(others)

    def _hindrance(self, edge: sct.Edge, here: Diagram) -> Hindrance:
        """Return why an edge is never taken in the controlled states in which its plant is in its location."""
        if not here.satisfiable():
            return Hindrance(edge, None)
        relation = self._system.relations[edge.event]
        own = relation.states_taking([edge])
        if not (here & own).satisfiable():
            return Hindrance(edge, Forbidden.BY_PLANTS, plants=(edge.target.eContainer(),))
        if relation.has_data:
            own = self._system.encoding.source(edge) & self._system.encoding.holds(edge.guard)
        enabled = here & (relation.happens if relation.has_data else relation.enabled) & own
        if not enabled.satisfiable():
            return Hindrance(edge, Forbidden.BY_PLANTS, plants=never_ready(relation, here))
        if not (enabled & relation.permitted).satisfiable():
            return Hindrance(edge, Forbidden.BY_REQUIREMENTS, requirements=requirements_at_fault(relation, enabled))
        if relation.has_data:
            own = (enabled & relation.permitted).exists(relation.inputs)
        return Hindrance(
            edge, Forbidden.BY_SYNTHESIS, counterexample=self._counterexample(self._permissions[edge.event], here & own)
        )

    def _example(self, states: Diagram) -> Example:
        quiescent = states & ~self._active
        codes = pick(quiescent if quiescent.satisfiable() else states, self._system.encoding.layout.state)
        by_rank = sorted(self._system.encoding.layout.state, key=lambda domain: domain.rank)
        named = {domain.element: value(domain.element, codes[domain.element]) for domain in by_rank}
        return Example(named, quiescent.satisfiable())

    @cached_property
    def _active(self) -> Diagram:
        silent = (self._permissions[event] for event in self._system.roles.silent if event in self._permissions)
        return self._system.diagrams.any_of(permission.allowed for permission in silent)

    def _affordable_counterexamples(self) -> Iterator[tuple[sct.Event, BlockingCounterexample]]:
        taken = 0
        for event, permission in self._permissions.items():
            if permission.guard.synthesis is None:
                continue
            goal = permission.held_back
            known = self._counterexamples.get((event, goal))
            way = None if known or taken > _STEPS else self._system.layers.path_to(goal, _EFFORT)
            counterexample = known or (way and blocking_counterexample(self._system, event, way))
            if counterexample:
                taken += len(counterexample.trace) + len(counterexample.onwards)
                yield event, counterexample

    def _counterexample(self, permission: Permission, where: Diagram | None = None) -> BlockingCounterexample:
        """Return the counterexample that holding back the event prevents in some of these states. Cached."""
        goal = permission.held_back
        if where is not None:
            goal &= where
        event = permission.relation.event
        if (event, goal) not in self._counterexamples:
            way = self._system.path_to(goal)
            self._counterexamples[event, goal] = blocking_counterexample(self._system, event, way)
        return self._counterexamples[event, goal]


def _server(plant: sct.Plant) -> str:
    """Return the ROS name of a service or action without the leading slash, which makes no difference."""
    return (plant.topic or "").removeprefix("/")
