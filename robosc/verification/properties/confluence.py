"""Confluence: in whatever order silent events happen, they come to rest in the same state.

The term is that of Reijnen, Hofkamp, van de Mortel-Fronczak, Reniers, Rooda: Finite response and confluence of
state-based supervisory controllers, CASE 2019. Where pairs of events are looked at there, it is decided here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.synthesis.fixpoint import coreachable
from robosc.synthesis.paths import shortest_path
from robosc.synthesis.settling import groups
from robosc.verification.system import counted, steps
from robosc.verification.verdict import Outcome, Verdict

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.paths import Move, Path
    from robosc.verification.system import SupervisedSystem

NAME = "confluence"


def confluence(system: SupervisedSystem) -> Verdict:
    """From every reachable state silent events lead to no more than one state in which none of them can happen.

    Events that have nothing to do with each other can't lead elsewhere by taking turns: they are looked at apart.
    """
    evidence = f"{system.size}, {counted(system.encoding.count(system.resting), 'of them at rest').removesuffix('s')}"
    for group in groups(system.silent):
        moves = [(each.relation, each.step) for each in group if each.step is not None]
        resting = system.reachable
        for each in group:
            resting &= ~each.allowed
        # A single event has no order.
        torn = _torn(system, moves, resting) if len(moves) > 1 else system.diagrams.false
        if torn.satisfiable():
            path = system.path_to(torn)
            one = _way(system, moves, path, resting)
            other = _way(system, moves, path, resting & ~system.last(one))
            return Verdict(
                NAME,
                Outcome.REFUTED,
                evidence,
                _difference(system, one, other),
                system.trace(path),
                system.trace(one),
                system.trace(other),
            )
    return Verdict(NAME, Outcome.PROVED, evidence)


def _torn(system: SupervisedSystem, moves: Sequence[Move], resting: Diagram) -> Diagram:
    """The reachable states with several resting states: these differ in some bit, which one of the events changed."""
    torn = system.diagrams.false
    for element in dict.fromkeys(each for relation, _ in moves for each in relation.changed):
        for bit in system.encoding.bits(element):
            one, other = (
                coreachable(system.diagrams, steps(moves), resting & value, system.reachable) for value in (bit, ~bit)
            )
            torn |= one & other
    return torn


def _way(system: SupervisedSystem, moves: Sequence[Move], before: Path, goal: Diagram) -> Path:
    way = shortest_path(system.encoding, moves, system.last(before), goal, system.reachable)
    assert way is not None
    return way


def _difference(system: SupervisedSystem, one: Path, other: Path) -> str:
    ends = one.states[-1], other.states[-1]
    differing = [element for element in ends[0] if ends[0][element] != ends[1][element]]
    first, second = (system.where(each, differing) for each in ends)
    return f"depending on their order, silent events end where `{first}` or where `{second}`"
