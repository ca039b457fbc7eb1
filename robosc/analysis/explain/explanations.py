"""Answers to questions about events that cannot happen and about empty supervisors.

The answer to each question is a function of the system that synthesis computes, or of the system under the supervisor
that the model already has. No function changes the model.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from robosc.analysis.blocking import blocking_counterexample, forbidden_from, reason_of_emptiness, requirements_at_fault
from robosc.analysis.explain.answers import (
    Emptiness,
    Explanation,
    Loosening,
    Note,
    Possibility,
    Reach,
    Situation,
)
from robosc.analysis.explain.obstacles import Obstacles
from robosc.analysis.paths import Path, shortest_path
from robosc.analysis.system import ExplainedSystem, SynthesizedSystem, whole_state
from robosc.analysis.wording import goal_in_words, join_with_and, name, words
from robosc.engine import Blocked
from robosc.model import sct
from robosc.model.semantics.edges import edges_from
from robosc.model.semantics.printing import RobotPrinter
from robosc.synthesis import MEMORY, use_encoding

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from robosc.analysis.blocking import BlockingCounterexample, BlockReason
    from robosc.analysis.paths import TraceStep
    from robosc.analysis.system import Codes
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.relation import EventRelation

    T = TypeVar("T")

#: Maximum number of requirements to try: each takes as long as a synthesis.
_TRIED = 24


def explore(model: sct.SupervisoryControlModel, look: Callable[[SynthesizedSystem], T], memory: int = MEMORY) -> T:
    """Return the result of `look` for the system under the model's supervisor, or under a synthesized one.

    `look` may run several times, with more memory each time. Raises MemoryError if the decision diagrams take more than
    `memory` bytes.
    """
    system = SynthesizedSystem if model.supervisor is None else ExplainedSystem
    return use_encoding(model, lambda encoding: look(system(model, encoding)), memory)


# An event in a state


def explain(system: SynthesizedSystem, event: sct.Event, partial: Codes) -> Explanation:
    """Explain whether an event can happen in the nearest state with these codes; the supervisor is not empty.

    If the supervisor lets the robot reach no such state, the answer is about the nearest state that the plants reach.
    If they reach none either, it is about the initial state with these codes.
    """
    encoding = system.encoding
    goal = encoding.diagrams.all_of(encoding.has_code(element, code) for element, code in partial.items())
    way = system.layers.path_to(goal & system.controlled)
    if way is not None:
        return explain_after(system, event, way)
    way = shortest_path(encoding, system.plant_moves, encoding.initial, goal & system.uncontrolled, system.uncontrolled)
    if way is not None:
        return explain_beyond(system, event, way)
    return _explained(system, event, _situation(system, {**encoding.initial_codes, **partial}, Reach.NEVER))


def explain_after(system: SynthesizedSystem, event: sct.Event, way: Path) -> Explanation:
    """Explain whether the event can happen after a path through controlled states."""
    return _explained(system, event, _situation(system, way.states[-1], Reach.SUPERVISED, system.trace(way)))


def explain_beyond(system: SynthesizedSystem, event: sct.Event, way: Path) -> Explanation:
    """Explain whether the event could happen after a path of the plants that leaves the controlled states."""
    refused = next(
        number
        for number, ((relation, _), state) in enumerate(zip(way.moves, way.states, strict=False))
        if relation.event.controllable and not system.is_in(state, system.allowed(relation.event))
    )
    before = Path(way.states[: refused + 1], way.moves[:refused])
    refusal = explain_after(system, way.moves[refused][0].event, before)
    situation = _situation(system, way.states[-1], Reach.UNSUPERVISED, system.trace(way))
    return _explained(system, event, situation, refusal)


def _situation(system: SynthesizedSystem, codes: Codes, reach: Reach, steps: Sequence[TraceStep] = ()) -> Situation:
    return Situation(codes, whole_state(system.model, codes), reach, tuple(steps))


def _explained(
    system: SynthesizedSystem, event: sct.Event, situation: Situation, refusal: Explanation | None = None
) -> Explanation:
    codes, supervised = situation.codes, situation.reach is Reach.SUPERVISED
    obstacles = Obstacles(system, event, codes)
    plants, requirements = tuple(obstacles.plants()), tuple(obstacles.requirements())
    allowed = system.allowed(event)
    happens = supervised and system.is_in(codes, allowed)
    caught: BlockingCounterexample | None = None
    blame: list[Note] = []
    if supervised and not plants and not requirements and not happens and not _harmless(system, event, codes):
        caught = blocking_counterexample(system, event, Path([dict(codes)], []))
        blame = find_culprits(system, caught.codes)
    return Explanation(
        event,
        situation,
        None if happens else _first(plants, requirements, supervised=supervised),
        plants,
        requirements,
        caught,
        tuple(blame),
        tuple(obstacles.changes(allowed)) if supervised and not happens else (),
        _way(system, codes, allowed) if supervised else None,
        refusal,
        tuple(obstacles.on_data()) if happens else (),
    )


def _harmless(system: SynthesizedSystem, event: sct.Event, codes: Codes) -> bool:
    """Return whether synthesis accepts the target of an event: then only another tool's supervisor forbids it."""
    step = system.relations[event].step
    rounds = system.solution.rounds.good
    given_up = rounds[0] & ~rounds[-1]
    return step is None or not (step.image(system.encoding.state(codes)) & given_up).satisfiable()


def _first(plants: tuple[Note, ...], requirements: tuple[Note, ...], *, supervised: bool) -> Blocked | None:
    if plants:
        return Blocked.ASSUMPTION if all(map(_is_assumed, plants)) else Blocked.PLANT
    if requirements:
        return Blocked.REQUIREMENT
    return Blocked.SYNTHESIS if supervised else None


def _is_assumed(note: Note) -> bool:
    return isinstance(note.element, sct.Plant) and note.element.kind == sct.PlantKind.assumption


def _way(system: SynthesizedSystem, start: Codes, allowed: Diagram) -> tuple[TraceStep, ...] | None:
    if not allowed.satisfiable():
        return None
    way = system.layers_from(start).path_to(allowed)
    return None if way is None else system.trace(way)


def find_culprits(system: SynthesizedSystem, end: Codes) -> list[Note]:
    """Return the invariants that a state violates, else the requirements that forbid something after it.

    A requirement whose states are unreachable from there comes first. Each requirement of the text has one note.
    """
    goals = {requirement: goal_in_words(requirement) for requirement in system.violated(end)}
    details: dict[tuple[object, str], tuple[sct.StatedRequirement, dict[str, None]]] = {}
    reasons: list[tuple[sct.StatedRequirement, str]] = [
        (requirement, f"needs a way to a {goal}" if goal else "forbids this state")
        for requirement, goal in goals.items()
    ]
    if None not in goals.values():
        forbidding = forbidden_from(system, end)
        reasons += [(requirement, f"forbids the {words(requirement.event)}") for requirement in forbidding]
    for requirement, reason in reasons:
        text = requirement.text or "a requirement"
        _, known = details.setdefault((requirement.source or requirement, text), (requirement, {}))
        known[reason] = None
    return [Note(requirement, text, tuple(known)) for (_, text), (requirement, known) in details.items()]


# An event that may never happen


def possibility(system: SynthesizedSystem, event: sct.Event) -> Possibility:
    """Explain whether the event can ever happen under the supervisor, which is not empty."""
    relation, controlled = system.relations[event], system.controlled
    goals = (
        system.allowed(event),
        controlled & relation.enabled & relation.requirement,
        controlled & relation.enabled,
    )
    for goal in goals:
        if goal.satisfiable():
            way = system.layers.path_to(goal)
            assert way is not None
            nearest = explain_after(system, event, way)
            if nearest.allowed:
                return Possibility(event, nearest)
            if nearest.needless:
                return Possibility(event, nearest)
            required = nearest.by is Blocked.REQUIREMENT
            beyond = _beyond(system, event, relation.requirement) if required else None
            conflict = _conflict(system, relation) if required and beyond is None else ()
            return Possibility(event, nearest, (), beyond, _loosenings(system, event), conflict)
    beyond = _beyond(system, event, system.encoding.diagrams.true)
    if beyond is not None:
        return Possibility(event, beyond, loosenings=_loosenings(system, event))
    return Possibility(event, None, tuple(_never(system, event)))


def _conflict(system: SynthesizedSystem, relation: EventRelation) -> tuple[Note, ...]:
    """Return the requirements that disable an event in every state in which the plants enable it."""
    at_fault = requirements_at_fault(relation, system.uncontrolled & relation.enabled)
    return tuple(Note(requirement, requirement.text or "a requirement") for requirement in at_fault)


def _beyond(system: SynthesizedSystem, event: sct.Event, condition: Diagram) -> Explanation | None:
    """Return the nearest state that enables the event and satisfies `condition`, unreachable under the supervisor."""
    goal = system.uncontrolled & system.relations[event].enabled & condition
    way = shortest_path(system.encoding, system.plant_moves, system.encoding.initial, goal, system.uncontrolled)
    return None if way is None else explain_beyond(system, event, way)


def _loosenings(system: SynthesizedSystem, event: sct.Event) -> tuple[Loosening, ...] | None:
    return loosenings(system, lambda other: other.allowed(event).satisfiable())


def _never(system: SynthesizedSystem, event: sct.Event) -> list[Note]:
    """Return why the plants never enable an event: those that never take part, else all participants."""
    relation, reached = system.relations[event], system.uncontrolled
    notes = []
    for plant, where in relation.enabled_by.items():
        if not (reached & where).satisfiable():
            notes += _never_takes_part(system, plant, event)
    if notes:
        return notes
    return [
        Note(plant, f"`{plant.text}` excludes it wherever all others take part")
        if plant.kind == sct.PlantKind.assumption
        else Note(plant, f"`{name(plant)}` takes part in the {words(event)}, but never when all others do")
        for plant in relation.enabled_by
    ]


def _never_takes_part(system: SynthesizedSystem, plant: sct.Plant, event: sct.Event) -> list[Note]:
    if plant.kind == sct.PlantKind.assumption:
        return [Note(plant, f"`{plant.text}` excludes it in every state that the robot can reach")]
    notes = []
    for location in plant.locations:
        for edge in (edge for edge in edges_from(location) if edge.event is event):
            is_reached = (system.uncontrolled & system.encoding.location(location)).satisfiable()
            why = (
                "is never reached"
                if not is_reached
                else "is reached, but the guard of its transition never holds there"
            )
            notes.append(Note(edge if is_reached else location, f"`{name(plant)}.{location.name}` {why}"))
    return notes


# No supervisor


def emptiness(system: SynthesizedSystem) -> Emptiness | None:
    """Explain why the supervisor is empty; None if it is not."""
    if system.controlled.satisfiable():
        return None
    reason = reason_of_emptiness(system)
    culprits = find_culprits(system, reason.codes)
    helpful = loosenings(system, lambda other: other.controlled.satisfiable(), [note.element for note in culprits])
    return Emptiness(reason, tuple(_stuck(reason)), tuple(culprits), helpful)


def _stuck(reason: BlockReason) -> list[Note]:
    notes, printed = [], RobotPrinter()
    for plant in reason.unmarked:
        here = plant.locations[reason.codes[plant]]
        marked = join_with_and([f"`{location.name}`" for location in plant.locations if location.marked])
        goal = f"cannot get back to {marked}" if marked else "has no marked state"
        details = [
            f"its transition on {words(edge.event)} requires `{printed(edge.guard)}`"
            for edge in edges_from(here)
            if edge.guard is not None and edge.target not in (None, here)
        ]
        notes.append(Note(here, f"`{name(plant)}` is in `{here.name}`, and {goal}", tuple(dict.fromkeys(details))))
    return notes


# Requirements left out


def loosenings(
    system: SynthesizedSystem, helps: Callable[[SynthesizedSystem], bool], first: Iterable[sct.StatedRequirement] = ()
) -> tuple[Loosening, ...] | None:
    """Return the requirements of the text that each help if left out alone, those that leave most states first.

    The requirements of `first` are tried before the others. The result is None if even leaving out all of them does not
    help.
    """
    texts = system.group_requirements(first)
    if not helps(system.without(frozenset(requirement for text in texts for requirement in text))):
        return None
    helpful = []
    for text in texts[:_TRIED]:
        other = system.without(frozenset(text))
        if helps(other):
            helpful.append(Loosening(text, system.encoding.count(other.controlled)))
    return tuple(sorted(helpful, key=lambda loosening: -loosening.states))
