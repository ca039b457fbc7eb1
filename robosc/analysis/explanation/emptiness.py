"""Why a robot has no supervisor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.explanation.answers import Emptiness, Note
from robosc.analysis.explanation.loosening import loosenings
from robosc.analysis.explanation.obstacles import blamed
from robosc.analysis.supervision.wording import listed, name
from robosc.synthesis.explanation import EmptySupervisor

if TYPE_CHECKING:
    from robosc.analysis.explanation.space import Space
    from robosc.synthesis import Reason


def emptiness(space: Space) -> Emptiness | None:
    """Why the supervisor is empty; None where it is not."""
    if space.controlled.satisfiable():
        return None
    reason = EmptySupervisor(space.encoding, space.moves, space.plant_moves, space.found).reason()
    found = blamed(space, reason.codes)
    helpful = loosenings(space, lambda other: other.controlled.satisfiable(), [each.element for each in found])
    return Emptiness(reason, tuple(_stuck(reason)), tuple(found), helpful)


def _stuck(reason: Reason) -> list[Note]:
    notes = []
    for plant in reason.unmarked:
        here = plant.locations[reason.codes[plant]]
        marked = listed([f"`{each.name}`" for each in plant.locations if each.marked])
        goal = f"can't get back to {marked}" if marked else "has no marked state"
        notes.append(Note(here, f"`{name(plant)}` is in `{here.name}`, and {goal}"))
    return notes
