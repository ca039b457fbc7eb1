"""Input-enabledness: no component keeps from happening what is not its own to decide.

The term is that of I/O automata (Lynch, Tuttle: An introduction to input/output automata, CWI Quarterly 1989).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.supervision.wording import name, words
from robosc.analysis.verification.system import counted
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.metamodel import sct
from robosc.semantics.roles import plant_of

if TYPE_CHECKING:
    from robosc.analysis.verification.system import SupervisedSystem

NAME = "input-enabledness"
_INPUTS = (sct.EventKind.response, sct.EventKind.error, sct.EventKind.feedback, sct.EventKind.cancel)


def input_enabledness(system: SupervisedSystem) -> Verdict:
    """Where a communication allows an answer, an error, feedback or its cancelling, so does every component.

    Components synchronise with communications: one without an edge for such an event would block the robot in the
    model, though nothing blocks it in the world.
    """
    inputs = [
        each for each in system.relations if each.event.kind in _INPUTS and plant_of(each.event) in each.enabled_by
    ]
    blocking = {
        (each.event, plant): system.reachable & each.enabled_by[plant_of(each.event)] & ~enabled
        for each in inputs
        for plant, enabled in each.enabled_by.items()
    }
    anywhere = system.diagrams.false
    for states in blocking.values():
        anywhere |= states
    evidence = f"{system.size}, {counted(len(inputs), 'event')}"
    if not anywhere.satisfiable():
        return Verdict(NAME, Outcome.PROVED, evidence)
    path = system.path_to(anywhere)
    here = system.last(path)
    event, plant = next(each for each, states in blocking.items() if (here & states).satisfiable())
    location = plant.locations[path.states[-1][plant]].name
    explanation = f"{words(event)} can come, but `{name(plant)}` has no transition for it in `{location}`"
    return Verdict(NAME, Outcome.REFUTED, evidence, explanation, system.trace(path))
