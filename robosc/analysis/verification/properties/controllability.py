"""Controllability: nothing that comes from the robot is forbidden."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.supervision.wording import words
from robosc.analysis.verification.system import counted
from robosc.analysis.verification.verdict import Outcome, Verdict

if TYPE_CHECKING:
    from robosc.analysis.verification.system import SupervisedSystem
    from robosc.synthesis.relation import EventRelation

NAME = "controllability"


def controllability(system: SupervisedSystem) -> Verdict:
    """Where the plants enable an uncontrollable event in a reachable state, no requirement and no guard forbids it."""
    uncontrollable = [each for each in system.relations if not each.event.controllable]
    forbidden = {
        each: system.reachable & each.enabled & ~(each.requirement & system.guard(each.event))
        for each in uncontrollable
    }
    anywhere = system.diagrams.false
    for states in forbidden.values():
        anywhere |= states
    evidence = f"{system.size}, {counted(len(uncontrollable), 'uncontrollable event')}"
    if not anywhere.satisfiable():
        return Verdict(NAME, Outcome.PROVED, evidence)
    path = system.path_to(anywhere)
    here = system.last(path)
    relation = next(each for each, states in forbidden.items() if (here & states).satisfiable())
    explanation = f"{words(relation.event)} can't be prevented, but {_who(relation, system)} forbids it here"
    return Verdict(NAME, Outcome.REFUTED, evidence, explanation, system.trace(path))


def _who(relation: EventRelation, system: SupervisedSystem) -> str:
    """Who may be the one that forbids the event."""
    parts = ["a requirement"] if relation.requirements else []
    return " or ".join([*parts, "its guard"] if relation.event in system.guards else parts)
