"""Non-blocking under control: the control loop, which lets silent events happen first, gets to a marked state, too.

Where some events have precedence, a system that is non-blocking may never get out of them, or always take the same
branch. The term is that of Eclipse ESCET's controller properties for CIF.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import sct
from robosc.roles import SILENT
from robosc.synthesis.explanation import never_marked
from robosc.synthesis.fixpoint import coreachable, reachable
from robosc.synthesis.paths import shortest_path
from robosc.synthesis.settling import groups
from robosc.verification.system import counted, steps, stuck
from robosc.verification.verdict import Outcome, Verdict

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.paths import Move
    from robosc.synthesis.relation import Step
    from robosc.synthesis.settling import SilentEvent
    from robosc.verification.system import SupervisedSystem

    Fire = Callable[[Step, Diagram], Diagram]
    Close = Callable[[list[Step], Diagram], Diagram]

NAME = "non-blocking under control"


def non_blocking_under_control(system: SupervisedSystem) -> Verdict:
    """From each state that the control loop comes to it can get to a marked one.

    Silent events happen at any time, and so does the choice of data; triggers, cancels and what comes from the robot
    only in states in which no silent event can happen, but then in any order and as often as they can. Quotas, which
    only delay, are left out of account.
    """
    loop = _Loop(system)
    states = loop.reachable()
    blocked = states & ~loop.coreachable(states & system.encoding.all_marked, states)
    evidence = counted(system.encoding.count(states), "state")
    if not blocked.satisfiable():
        return Verdict(NAME, Outcome.PROVED, evidence)
    moves = [_at_rest(each, system) for each in system.moves]
    path = shortest_path(system.encoding, moves, system.encoding.initial, blocked, states)
    assert path is not None
    plants = never_marked(system.encoding, moves, path.states[-1])
    return Verdict(NAME, Outcome.REFUTED, evidence, stuck(plants, path.states[-1]), system.trace(path))


class _Loop:
    """The order that the control loop keeps."""

    def __init__(self, system: SupervisedSystem) -> None:
        self._system = system
        self._free = steps([each for each in system.moves if _is_free(each)])
        together = groups(system.silent)
        self._waiting = [
            (move[1], [each.step for group in together if _awakes(move, group) for each in group if each.step])
            for move in system.moves
            if not _is_free(move)
        ]

    def reachable(self) -> Diagram:
        """The states that it comes to."""
        system = self._system
        return self._closure(
            system.encoding.initial,
            lambda step, states: step.image(states & system.resting),
            lambda free, states: reachable(system.diagrams, free, states, system.diagrams.true),
        )

    def coreachable(self, goal: Diagram, within: Diagram) -> Diagram:
        """The states from which it can come to the goal without leaving `within`."""
        system = self._system
        return self._closure(
            goal,
            lambda step, states: step.preimage(states) & system.resting & within,
            lambda free, states: coreachable(system.diagrams, free, states, within),
        )

    def _closure(self, states: Diagram, fire: Fire, close: Close) -> Diagram:
        while True:
            found = states = close(self._free, states)
            for step, near in self._waiting:
                more = states | fire(step, states)
                # Without those that have come to rest again, the states of others would be found one by one.
                states = states if more == states else close(near, more)
            if states == found:
                return states


def _is_free(move: Move) -> bool:
    return move[0].event.kind in (*SILENT, sct.EventKind.data)


def _awakes(move: Move, group: Sequence[SilentEvent]) -> bool:
    """Whether the event may make silent events of the group possible."""
    return any(not each.touched.isdisjoint(move[0].changed) for each in group)


def _at_rest(move: Move, system: SupervisedSystem) -> Move:
    """The event as it happens under control, so that no state need be asked whether it is at rest."""
    relation = move[0]
    at_rest = relation.step_where(system.allowed[relation] & system.resting)
    return move if _is_free(move) or at_rest is None else (relation, at_rest)
