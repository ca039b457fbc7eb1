"""Non-blocking in the control loop: it comes to rest in a marked state, though it lets silent events happen first.

Where some events have precedence, a system that is non-blocking may never get out of them, or always take the same
branch. Non-blocking under control, of Eclipse ESCET's controller properties for CIF, is asked in the same way of all
controllable events, which code generated there lets happen until none is possible. This loop does that with silent
events; requests and cancels take turns with what comes from the robot.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.verification.loop import asked_of_the_loop
from robosc.analysis.verification.system import counted, stuck
from robosc.analysis.verification.verdict import Outcome, Verdict

if TYPE_CHECKING:
    from robosc.analysis.verification.system import SupervisedSystem

NAME = "non-blocking in the control loop"


@asked_of_the_loop(NAME)
def non_blocking_in_the_loop(system: SupervisedSystem) -> Verdict:
    """From each state that the control loop comes to it can come to a marked one in which it rests."""
    loop = system.loop
    blocked = loop.states & ~loop.coreachable(loop.rests & system.encoding.all_marked)
    evidence = counted(system.encoding.count(loop.states), "state")
    if not blocked.satisfiable():
        return Verdict(NAME, Outcome.PROVED, evidence)
    path = loop.path_to(blocked)
    onwards = loop.after(path.states[-1])
    plants = [each for each in system.model.plants if not (onwards & system.encoding.marked(each)).satisfiable()]
    explanation = stuck(plants, path.states[-1]) if plants else _UNRESTING
    return Verdict(NAME, Outcome.REFUTED, evidence, explanation, system.trace(path))


_UNRESTING = "the control loop never again rests in a state in which all components are marked"
