"""What synthesis can say of a model beside its supervisor: what is allowed, but hardly meant."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING

from robosc.metamodel import sct
from robosc.semantics.roles import Roles, plant_of, provide_numbers
from robosc.synthesis.decoding import Value, pick, value
from robosc.synthesis.explanation import never_marked, unavoidable
from robosc.synthesis.paths import Layers, Path, TraceStep, deciding, trace

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element, Encoding
    from robosc.synthesis.fixpoint import SupervisedStates
    from robosc.synthesis.guards import Permission
    from robosc.synthesis.paths import Move
    from robosc.synthesis.relation import EventRelation

_CALLS = (sct.PlantKind.service, sct.PlantKind.action)
#: What the troubles of all guards may cost: the way to them, in nodes looked at, and steps of all traces together.
_EFFORT = 1_000_000
_STEPS = 400
_FOLLOWS_THE_ROBOT = (sct.EventKind.tau, sct.EventKind.reset, sct.EventKind.cancel)


@dataclass(frozen=True)
class Trouble:
    """What the supervisor prevents when it holds an event back that plants and requirements would allow.

    `trace` is a shortest one from the initial state, or from the state asked about, that ends with the event so held
    back. `onwards` is a way from there, under the requirements, to where no marked state can be reached any more, as
    `unavoidable` finds it: its last event is the uncontrollable one that is guarded against; empty where none is
    needed. `codes` are those of the state where it ends. `unmarked` are the plants that can't be in a marked location
    from then on; none if each can be but never all at once.
    """

    trace: tuple[TraceStep, ...]
    onwards: tuple[TraceStep, ...]
    codes: Mapping[Element, int]
    unmarked: tuple[sct.Plant, ...]


class Forbidden(Enum):
    """Who keeps an event from ever happening: the first of these that does."""

    BY_PLANTS = auto()
    BY_REQUIREMENTS = auto()
    BY_SYNTHESIS = auto()


@dataclass(frozen=True)
class NeverEnabled:
    """A trigger or tau event that is allowed in no controlled state.

    `plants` are those which forbid it alone wherever the robot may come, `requirements` those which forbid it wherever
    the plants enable it, be it only in states that the supervisor keeps the robot from: see `forbidding`.
    `kept_away` says that the plants forbid it for that reason only. `trouble` is there where synthesis forbids it.
    """

    event: sct.Event
    forbidden: Forbidden
    plants: tuple[sct.Plant, ...] = ()
    requirements: tuple[sct.Requirement, ...] = ()
    kept_away: bool = False
    trouble: Trouble | None = None


@dataclass(frozen=True)
class SilentRestricted:
    """A tau, reset or cancel event to which synthesis added something."""

    event: sct.Event
    trouble: Trouble


@dataclass(frozen=True)
class SelfCancelling:
    """An action, by its trigger, whose requirement holds in no state right after it.

    `requirements` are those on it which hold in none of these states: see `forbidding`.
    """

    event: sct.Event
    requirements: tuple[sct.Requirement, ...]


@dataclass(frozen=True)
class Example:
    """A controlled state: the location of every plant by name, the value of every variable.

    `settled` says that no silent event is allowed in it. There is an unsettled example only where there is no other.
    """

    state: Mapping[Element, Value]
    settled: bool


@dataclass(frozen=True)
class ProvideGap:
    """A trigger that is allowed where none of the conditions on its data, in the plant `data`, holds."""

    event: sct.Event
    data: sct.Plant
    example: Example


@dataclass(frozen=True)
class SharedTopicConflict:
    """Two triggers of messages on one topic that are allowed at once, in the order of the model."""

    first: sct.Event
    second: sct.Event
    example: Example


@dataclass(frozen=True)
class Hindrance:
    """Why a transition that leads to a state from another is never taken.

    `forbidden` is None where its own state is never reached. `plants` are those, its own among them, that are never
    ready for it there, none if each is but never all at once; `requirements` forbid it there, as `forbidding` says;
    `trouble` is there where synthesis does.
    """

    edge: sct.Edge
    forbidden: Forbidden | None
    plants: tuple[sct.Plant, ...] = ()
    requirements: tuple[sct.Requirement, ...] = ()
    trouble: Trouble | None = None


@dataclass(frozen=True)
class UnreachableState:
    """A location of a component in no controlled state, and why none of the transitions to it is ever taken."""

    location: sct.Location
    hindrances: tuple[Hindrance, ...]


@dataclass(frozen=True)
class Observations:
    """All of them, each kind in the order of the model. `unrestricted_calls` are triggers of services and actions.

    These can happen, no requirement is on them, and no plant but their own takes part in them. `troubles` are there for
    events to which synthesis added something: for all in models that are not large.
    """

    never_enabled: tuple[NeverEnabled, ...]
    silent_restricted: tuple[SilentRestricted, ...]
    self_cancelling: tuple[SelfCancelling, ...]
    provide_gaps: tuple[ProvideGap, ...]
    shared_topic_conflicts: tuple[SharedTopicConflict, ...]
    unrestricted_calls: tuple[sct.Event, ...]
    unreachable_states: tuple[UnreachableState, ...]
    troubles: Mapping[sct.Event, Trouble]


class Observer:
    """Asks the decision diagrams of a supervisor that is not empty."""

    def __init__(
        self,
        model: sct.SupervisoryControlModel,
        encoding: Encoding,
        moves: Sequence[Move],
        found: SupervisedStates,
        permissions: Sequence[Permission],
    ) -> None:
        """`moves` are all events under the requirements, `permissions` are of all controllable events."""
        self._encoding = encoding
        self._moves = moves
        self._found = found
        self._permissions = {each.relation.event: each for each in permissions}
        self._model = model
        self._roles = Roles(model)
        self._troubles: dict[tuple[sct.Event, Diagram], Trouble] = {}
        self._triggers = [each for each in self._roles.triggers if each in self._permissions]

    def observations(self, uncontrolled: Diagram) -> Observations:
        """All that there is to say; `uncontrolled` are the states that the plants reach without requirements."""
        return Observations(
            tuple(self._never_enabled(uncontrolled)),
            tuple(self._silent_restricted()),
            tuple(self._self_cancelling()),
            tuple(self._provide_gaps()),
            tuple(self._shared_topic_conflicts()),
            tuple(self._unrestricted_calls()),
            tuple(self._unreachable_states()),
            dict(self._affordable_troubles()),
        )

    def _never_enabled(self, uncontrolled: Diagram) -> Iterator[NeverEnabled]:
        controlled = self._found.controlled
        for event, permission in self._permissions.items():
            if event.kind not in (sct.EventKind.trigger, sct.EventKind.tau) or permission.guard.everEnabled:
                continue
            relation = permission.relation
            in_sight = controlled & relation.enabled
            enabled = in_sight if in_sight.satisfiable() else uncontrolled & relation.enabled
            forbidden = not (enabled & relation.requirement).satisfiable()
            if not enabled.satisfiable() or not (in_sight.satisfiable() or forbidden):
                plants = [each for each, own in relation.enabled_by.items() if not (controlled & own).satisfiable()]
                kept_away = enabled.satisfiable()
                yield NeverEnabled(event, Forbidden.BY_PLANTS, plants=tuple(plants), kept_away=kept_away)
            elif forbidden:
                yield NeverEnabled(
                    event, Forbidden.BY_REQUIREMENTS, requirements=forbidding(permission.relation, enabled)
                )
            else:
                yield NeverEnabled(event, Forbidden.BY_SYNTHESIS, trouble=self._trouble(permission))

    def _silent_restricted(self) -> Iterator[SilentRestricted]:
        for event, permission in self._permissions.items():
            if event.kind in _FOLLOWS_THE_ROBOT and permission.guard.synthesis is not None:
                yield SilentRestricted(event, self._trouble(permission))

    def _self_cancelling(self) -> Iterator[SelfCancelling]:
        for event in self._triggers:
            permission = self._permissions[event]
            step = permission.relation.step
            if plant_of(event).kind != sct.PlantKind.action or not permission.guard.everEnabled:
                continue
            after = permission.where if step is None else step.image(permission.where)
            if not (after & permission.relation.requirement).satisfiable():
                yield SelfCancelling(event, forbidding(permission.relation, after))

    def _provide_gaps(self) -> Iterator[ProvideGap]:
        for event in self._triggers:
            plant = self._roles.data_plants.get(event)
            if plant is None:
                continue
            gap = self._permissions[event].allowed
            for each, number in provide_numbers(plant).items():
                if each in self._permissions and number:
                    gap &= ~self._permissions[each].relation.enabled
            if gap.satisfiable():
                yield ProvideGap(event, plant, self._example(gap))

    def _shared_topic_conflicts(self) -> Iterator[SharedTopicConflict]:
        for events in self._roles.shared_topics:
            for first, second in combinations([each for each in events if each in self._permissions], 2):
                both = self._permissions[first].allowed & self._permissions[second].allowed
                if both.satisfiable():
                    yield SharedTopicConflict(first, second, self._example(both))

    def _unrestricted_calls(self) -> Iterator[sct.Event]:
        for event in self._triggers:
            plant, permission = plant_of(event), self._permissions[event]
            alone = all(each is plant for each in permission.relation.enabled_by)
            restricted = permission.relation.requirements or not alone
            if plant.kind in _CALLS and not restricted and permission.guard.everEnabled:
                yield event

    def _unreachable_states(self) -> Iterator[UnreachableState]:
        for plant in self._model.plants:
            if plant.kind != sct.PlantKind.behaviour:
                continue
            reached = [(self._found.controlled & self._encoding.location(each)) for each in plant.locations]
            if all(each.satisfiable() for each in reached):
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
                    hindrances = [self._hindrance(each, states[each.eContainer()]) for each in leading]
                    yield UnreachableState(location, tuple(hindrances))

    def _hindrance(self, edge: sct.Edge, here: Diagram) -> Hindrance:
        """Why an edge is never taken in the controlled states in which its plant is in its location."""
        if not here.satisfiable():
            return Hindrance(edge, None)
        relation = self._relations[edge.event]
        enabled = here & relation.enabled
        if not enabled.satisfiable():
            plants = [each for each, own in relation.enabled_by.items() if not (here & own).satisfiable()]
            return Hindrance(edge, Forbidden.BY_PLANTS, plants=tuple(plants))
        if not (enabled & relation.requirement).satisfiable():
            return Hindrance(edge, Forbidden.BY_REQUIREMENTS, requirements=forbidding(relation, enabled))
        return Hindrance(edge, Forbidden.BY_SYNTHESIS, trouble=self._trouble(self._permissions[edge.event], here))

    @cached_property
    def _relations(self) -> dict[sct.Event, EventRelation]:
        known = {relation.event: relation for relation, _ in self._moves}
        return known | {event: each.relation for event, each in self._permissions.items()}

    def _example(self, states: Diagram) -> Example:
        settled = states & ~self._unsettled
        codes = pick(settled if settled.satisfiable() else states, self._encoding.layout.state)
        by_rank = sorted(self._encoding.layout.state, key=lambda each: each.rank)
        named = {each.element: value(each.element, codes[each.element]) for each in by_rank}
        return Example(named, settled.satisfiable())

    @cached_property
    def _unsettled(self) -> Diagram:
        result = self._encoding.diagrams.false
        for event in self._roles.silent:
            if event in self._permissions:
                result |= self._permissions[event].allowed
        return result

    @cached_property
    def _layers(self) -> Layers:
        """The controlled states by their distance from the initial one."""
        controlled = self._found.controlled
        return Layers(self._encoding, self._moves, self._encoding.initial, controlled)

    def _affordable_troubles(self) -> Iterator[tuple[sct.Event, Trouble]]:
        steps = 0
        for event, permission in self._permissions.items():
            if permission.guard.synthesis is None:
                continue
            goal = held_back(permission, self._found)
            known = self._troubles.get((event, goal))
            way = None if known or steps > _STEPS else self._layers.path_to(goal, _EFFORT)
            found = known or (way and trouble(self._encoding, self._moves, self._found, permission.relation, way))
            if found:
                steps += len(found.trace) + len(found.onwards)
                yield event, found

    def _trouble(self, permission: Permission, where: Diagram | None = None) -> Trouble:
        """What is prevented where the event is held back, in some of these states: looked for once, it may be long."""
        goal = held_back(permission, self._found)
        if where is not None:
            goal &= where
        key = permission.relation.event, goal
        if key not in self._troubles:
            way = self._layers.path_to(goal)
            assert way is not None
            self._troubles[key] = trouble(self._encoding, self._moves, self._found, permission.relation, way)
        return self._troubles[key]


def held_back(permission: Permission, found: SupervisedStates) -> Diagram:
    """The controlled states in which only synthesis forbids the event."""
    relation = permission.relation
    return found.controlled & (relation.enabled & relation.requirement & ~permission.where)


def trouble(
    encoding: Encoding, moves: Sequence[Move], found: SupervisedStates, relation: EventRelation, way: Path
) -> Trouble:
    """What would happen if the event were not held back at the end of a way."""
    step = relation.step
    assert step is not None  # else the event would change nothing, and lead to no trouble
    after = pick(step.image(encoding.state(way.states[-1])), encoding.layout.state)
    onwards = unavoidable(encoding, moves, found, after)
    end = onwards.states[-1]
    unmarked = [each for each in encoding.layout.plants if not each.locations[end[each]].marked]
    return Trouble(
        tuple(trace(encoding, Path([*way.states, after], [*way.moves, (relation, step)]))),
        tuple(trace(encoding, onwards)),
        end,
        tuple(never_marked(encoding, deciding(moves, unmarked), end)),
    )


def forbidding(relation: EventRelation, states: Diagram) -> tuple[sct.Requirement, ...]:
    """Of the requirements on an event, which allow it in none of these states, those at fault.

    That are all that alone allow it in none; where there is none, some that do not together, and no fewer of them.
    """
    alone = [each for each, asked in relation.asked.items() if not (states & asked).satisfiable()]
    if alone:
        return tuple(alone)
    together = dict(relation.asked)
    for each in relation.asked:
        rest = states
        for other, asked in together.items():
            rest = rest if other is each else rest & asked
        if not rest.satisfiable():
            del together[each]
    return tuple(together)
