"""Why an event can or can't happen in a state."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.explanation.answers import Explanation, Reach, Situation
from robosc.analysis.explanation.names import whole_state
from robosc.analysis.explanation.obstacles import Obstacles, blamed
from robosc.engine import Blocked
from robosc.synthesis.observations import trouble
from robosc.synthesis.paths import Path, shortest_path, trace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.analysis.explanation.answers import Note
    from robosc.analysis.explanation.space import Codes, Space
    from robosc.metamodel import sct
    from robosc.synthesis import TraceStep
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.observations import Trouble


def explain(space: Space, event: sct.Event, given: Codes) -> Explanation:
    """Whether an event can happen in the nearest state that has these codes, and why not; the supervisor is not empty.

    Where the supervisor lets the robot get to no such state, it is the nearest that the plants get to; where they get
    to none either, the initial one with these codes.
    """
    encoding = space.encoding
    goal = encoding.diagrams.true
    for element, code in given.items():
        goal &= encoding.has_code(element, code)
    way = space.supervised_layers.path_to(goal & space.controlled)
    if way is not None:
        return explain_after(space, event, way)
    way = shortest_path(encoding, space.plant_moves, encoding.initial, goal & space.uncontrolled, space.uncontrolled)
    if way is not None:
        return explain_beyond(space, event, way)
    return _explained(space, event, _situation(space, {**encoding.initial_codes, **given}, Reach.NEVER))


def explain_after(space: Space, event: sct.Event, way: Path) -> Explanation:
    """Whether the event can happen after a way through controlled states."""
    return _explained(space, event, _situation(space, way.states[-1], Reach.SUPERVISED, trace(space.encoding, way)))


def explain_beyond(space: Space, event: sct.Event, way: Path) -> Explanation:
    """Whether it could happen after a way of the plants that the supervisor does not let the robot go to its end."""
    refused = next(
        number
        for number, ((relation, _), state) in enumerate(zip(way.moves, way.states, strict=False))
        if relation.event.controllable and not space.is_in(state, space.allowed(relation.event))
    )
    before = Path(way.states[: refused + 1], way.moves[:refused])
    refusal = explain_after(space, way.moves[refused][0].event, before)
    situation = _situation(space, way.states[-1], Reach.UNSUPERVISED, trace(space.encoding, way))
    return _explained(space, event, situation, refusal)


def _situation(space: Space, codes: Codes, reach: Reach, steps: Sequence[TraceStep] = ()) -> Situation:
    return Situation(codes, whole_state(space.model, codes), reach, tuple(steps))


def _explained(space: Space, event: sct.Event, situation: Situation, refusal: Explanation | None = None) -> Explanation:
    codes, supervised = situation.codes, situation.reach is Reach.SUPERVISED
    obstacles = Obstacles(space, event, codes)
    plants, requirements = tuple(obstacles.plants()), tuple(obstacles.requirements())
    allowed = space.allowed(event)
    caught: Trouble | None = None
    blame: list[Note] = []
    if supervised and not plants and not requirements and not space.is_in(codes, allowed):
        caught = trouble(space.encoding, space.moves, space.found, space.relations[event], Path([dict(codes)], []))
        blame = blamed(space, caught.codes)
    return Explanation(
        event,
        situation,
        _first(plants, requirements, caught),
        plants,
        requirements,
        caught,
        tuple(blame),
        tuple(obstacles.changes(allowed)) if supervised and not space.is_in(codes, allowed) else (),
        _way(space, codes, allowed) if supervised else None,
        refusal,
    )


def _first(plants: tuple[Note, ...], requirements: tuple[Note, ...], caught: Trouble | None) -> Blocked | None:
    if plants:
        return Blocked.PLANT
    if requirements:
        return Blocked.REQUIREMENT
    return Blocked.SYNTHESIS if caught else None


def _way(space: Space, start: Codes, allowed: Diagram) -> tuple[TraceStep, ...] | None:
    if not allowed.satisfiable():
        return None
    way = space.layers(start).path_to(allowed)
    return None if way is None else tuple(trace(space.encoding, way))
