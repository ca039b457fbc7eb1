"""Whether an event can ever happen, and if not, why."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.explanation.answers import Note, Possibility
from robosc.analysis.explanation.explaining import explain_after, explain_beyond
from robosc.analysis.explanation.loosening import loosenings
from robosc.analysis.supervision.wording import name, words
from robosc.engine import Blocked
from robosc.semantics.edges import edges_from
from robosc.synthesis.observations import forbidding
from robosc.synthesis.paths import shortest_path

if TYPE_CHECKING:
    from robosc.analysis.explanation.answers import Explanation, Loosening
    from robosc.analysis.explanation.space import Space
    from robosc.metamodel import sct
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.relation import EventRelation


def possibility(space: Space, event: sct.Event) -> Possibility:
    """Whether the event can ever happen under the supervisor, which is not empty, and if not, why."""
    relation, controlled = space.relations[event], space.controlled
    goals = (
        space.allowed(event),
        controlled & relation.enabled & relation.requirement,
        controlled & relation.enabled,
    )
    for goal in goals:
        if goal.satisfiable():
            way = space.supervised_layers.path_to(goal)
            assert way is not None
            nearest = explain_after(space, event, way)
            if nearest.allowed:
                return Possibility(event, nearest)
            required = nearest.by is Blocked.REQUIREMENT
            beyond = _beyond(space, event, relation.requirement) if required else None
            conflict = _conflict(space, relation) if required and beyond is None else ()
            return Possibility(event, nearest, (), beyond, _loosenings(space, event), conflict)
    beyond = _beyond(space, event, space.encoding.diagrams.true)
    if beyond is not None:
        return Possibility(event, beyond, loosenings=_loosenings(space, event))
    return Possibility(event, None, tuple(_never(space, event)))


def _conflict(space: Space, relation: EventRelation) -> tuple[Note, ...]:
    """The requirements that allow an event in no state in which the plants do, with or without a supervisor."""
    at_fault = forbidding(relation, space.uncontrolled & relation.enabled)
    return tuple(Note(each, each.text or "a requirement") for each in at_fault)


def _beyond(space: Space, event: sct.Event, wanted: Diagram) -> Explanation | None:
    """The nearest state in which the plants allow the event and this holds, out of reach under the supervisor."""
    goal = space.uncontrolled & space.relations[event].enabled & wanted
    way = shortest_path(space.encoding, space.plant_moves, space.encoding.initial, goal, space.uncontrolled)
    return None if way is None else explain_beyond(space, event, way)


def _loosenings(space: Space, event: sct.Event) -> tuple[Loosening, ...] | None:
    return loosenings(space, lambda other: other.allowed(event).satisfiable())


def _never(space: Space, event: sct.Event) -> list[Note]:
    """Why the plants never let an event happen: those that never take part in it, else all that have to, at once."""
    relation, reached = space.relations[event], space.uncontrolled
    notes = []
    for plant, where in relation.enabled_by.items():
        if not (reached & where).satisfiable():
            notes += _never_takes_part(space, plant, event)
    if notes:
        return notes
    return [
        Note(each, f"`{name(each)}` takes part in the {words(event)}, but never when all others do")
        for each in relation.enabled_by
    ]


def _never_takes_part(space: Space, plant: sct.Plant, event: sct.Event) -> list[Note]:
    notes = []
    for location in plant.locations:
        for edge in (each for each in edges_from(location) if each.event is event):
            is_reached = (space.uncontrolled & space.encoding.location(location)).satisfiable()
            why = (
                "is never reached"
                if not is_reached
                else "is reached, but the guard of its transition never holds there"
            )
            notes.append(Note(edge if is_reached else location, f"`{name(plant)}.{location.name}` {why}"))
    return notes
