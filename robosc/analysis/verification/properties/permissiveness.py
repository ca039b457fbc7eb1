"""Maximal permissiveness: nothing is forbidden without need."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.supervision.wording import words
from robosc.analysis.verification.system import counted, happening
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.synthesis.fixpoint import supervise

if TYPE_CHECKING:
    from robosc.analysis.verification.system import SupervisedSystem
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.relation import EventRelation

NAME = "maximal permissiveness"


def maximal_permissiveness(system: SupervisedSystem) -> Verdict:
    """Where the guard of a controllable event forbids it in a reachable state, any supervisor has to."""
    moves = [(each, each.step) for each in system.relations if each.step is not None]
    controlled = supervise(
        system.encoding,
        [step for _, step in moves],
        [step for relation, step in moves if not relation.event.controllable],
    ).controlled
    controllable = [each for each in system.relations if each.event.controllable]
    needless = {each: system.reachable & _permitted(each, controlled) & ~system.allowed[each] for each in controllable}
    anywhere = system.diagrams.false
    for states in needless.values():
        anywhere |= states
    evidence = f"{system.size}, {counted(len(controllable), 'controllable event')}"
    if not anywhere.satisfiable():
        return Verdict(NAME, Outcome.PROVED, evidence)
    path = system.path_to(anywhere)
    here = system.last(path)
    relation = next(each for each, states in needless.items() if (here & states).satisfiable())
    explanation = f"{words(relation.event)} is forbidden here, though nothing speaks against it"
    return Verdict(NAME, Outcome.REFUTED, evidence, explanation, (*system.trace(path), happening(relation)))


def _permitted(relation: EventRelation, controlled: Diagram) -> Diagram:
    """Where the maximally permissive supervisor allows the event."""
    enabled = controlled & relation.enabled & relation.requirement
    return enabled if relation.step is None else enabled & relation.step.preimage(controlled)
