"""Non-blocking: wherever the system is, it can still get to a marked state."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.verification.system import counted, steps, stuck
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.synthesis.explanation import never_marked
from robosc.synthesis.fixpoint import coreachable

if TYPE_CHECKING:
    from robosc.analysis.verification.system import SupervisedSystem

NAME = "non-blocking"


def non_blocking(system: SupervisedSystem) -> Verdict:
    """Every reachable state can reach one in which every plant is marked."""
    states = system.reachable
    marked = states & system.encoding.all_marked
    blocked = states & ~coreachable(system.diagrams, steps(system.moves), marked, states)
    if not blocked.satisfiable():
        marks = counted(system.encoding.count(marked), "of them marked").removesuffix("s")
        return Verdict(NAME, Outcome.PROVED, f"{system.size}, {marks}")
    path = system.path_to(blocked)
    plants = never_marked(system.encoding, system.moves, path.states[-1])
    return Verdict(NAME, Outcome.REFUTED, system.size, stuck(plants, path.states[-1]), system.trace(path))
