"""States that the control loop reaches if internal events run to completion between external events."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, wraps
from itertools import chain, count, pairwise
from typing import TYPE_CHECKING

from robosc.analysis.paths import Path
from robosc.analysis.verify.verdict import Outcome, Verdict
from robosc.base.diagnostics import ModelError
from robosc.model import sct
from robosc.model.semantics.roles import SILENT, plant_of
from robosc.synthesis.acceleration import Acceleration
from robosc.synthesis.encoding import pick
from robosc.synthesis.fixpoint import coreachable, reachable
from robosc.synthesis.run_to_completion import independent_groups, runs

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.analysis.paths import Move
    from robosc.analysis.system import GuardedSystem
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element
    from robosc.synthesis.relation import SymbolicStep
    from robosc.synthesis.run_to_completion import InternalEvent

    Property = Callable[["LoopModel"], Verdict]
    Fire = Callable[["_Batch", Diagram], Diagram]
    Close = Callable[[list[SymbolicStep], Diagram], Diagram]


def require_loop_states(name: str) -> Callable[[Property], Property]:
    """Decorate a property so that it is skipped if the states of the loop cannot be computed.

    `name` is the name of the property.
    """

    def decorator(examine: Property) -> Property:
        @wraps(examine)
        def examined(loop: LoopModel) -> Verdict:
            try:
                return examine(loop)
            except ModelError as fault:
                return Verdict(name, Outcome.SKIPPED, "", fault.diagnostics[0].message)

        return examined

    return decorator


@dataclass(frozen=True)
class _Batch:
    """A sequence of events, each of which may be left out, with nothing in between; possibly all are left out."""

    moves: tuple[Move, ...]

    def image(self, states: Diagram) -> Diagram:
        for _, step in self.moves:
            states |= step.image(states)
        return states

    def preimage(self, states: Diagram) -> Diagram:
        for _, step in reversed(self.moves):
            states |= step.preimage(states)
        return states

    def between(self, system: GuardedSystem, before: dict[Element, int], after: dict[Element, int]) -> Path:
        """Return a path between two states with few events, tried in their order."""
        goals = [system.encoding.state(after)]
        for _, step in reversed(self.moves):
            goals.append(goals[-1] | step.preimage(goals[-1]))
        goals.reverse()
        path = Path([before], [])
        for move, goal in zip(self.moves, goals[1:], strict=True):
            here = system.encoding.state(path.states[-1])
            if not (here & goal).satisfiable():
                path.states.append(pick(move[1].image(here) & goal, system.encoding.layout.state))
                path.moves.append(move)
        return path


class LoopModel:
    """Model of the order of events in the control loop.

    Internal events and the choice of data happen at any time. Requests, cancels and events from the robot happen only
    in states in which the loop waits. The events of one message, and the cancels of a stopped robot, then happen one
    after the other if they are possible; some may be missing because their data cannot be read. Quotas and disabled
    reactions only delay events and are not modeled. The reset of a failed call may be held back, as `retryMs` defines.
    If more internal events can happen in a row than the loop permits, the loop continues from any state in between.
    """

    def __init__(self, system: GuardedSystem) -> None:
        self.system = system
        free = [move for move in system.moves if move[0].event.kind in (*SILENT, sct.EventKind.data)]
        self._free = [step for _, step in free]
        self._alone = [_Batch((move,)) for move in free]
        moves = {relation.event: (relation, step) for relation, step in system.moves}
        together = [*system.roles.batches, system.roles.cancels]
        batches = [tuple(moves[event] for event in events if event in moves) for events in together]
        batched = {relation.event for batch in batches for relation, _ in batch}
        batches += [(move,) for move in system.moves if move not in free and move[0].event not in batched]
        near = independent_groups(system.internal)
        self._waiting = [
            (_Batch(batch), [event.step for group in near if _triggers(batch, group) for event in group if event.step])
            for batch in batches
            if batch
        ]

    @cached_property
    def states(self) -> Diagram:
        """States that the loop reaches, including those in which internal events are pending."""
        return self._after(self.system.initial, self._waits)

    def after(self, codes: Mapping[Element, int]) -> Diagram:
        """Return the states that the loop reaches from one of its states, with run to completion."""
        return self._after(self.system.encoding.state(codes), self.quiescent)

    def _after(self, start: Diagram, waits: Diagram) -> Diagram:
        diagrams = self.system.diagrams
        acceleration = _LoopAcceleration(self._free, self._waiting, waits, diagrams.true, forwards=True)
        return self._closure(
            start,
            lambda batch, states: batch.image(states & waits),
            lambda free, states: reachable(diagrams, free, states, diagrams.true),
            acceleration,
        )

    @cached_property
    def quiescent(self) -> Diagram:
        """States of the loop in which no internal event can happen, unless it is held back."""
        return self.states & ~self._active

    def withheld(self, event: sct.Event) -> Diagram:
        """Return the states in which an internal event may be held back: the reset of a failed call."""
        encoding = self.system.encoding
        if event.kind != sct.EventKind.reset:
            return encoding.diagrams.false
        edges = (edge for location in plant_of(event).locations for edge in location.edges)
        failed = dict.fromkeys(edge.target for edge in edges if edge.event.kind == sct.EventKind.error)
        return encoding.diagrams.any_of(map(encoding.location, failed))

    def coreachable(self, goal: Diagram) -> Diagram:
        """Return the states from which the loop reaches one of these, with run to completion."""
        acceleration = _LoopAcceleration(self._free, self._waiting, self.quiescent, self.states, forwards=False)
        return self._closure(
            goal,
            lambda batch, states: batch.preimage(states & self.states) & self.quiescent,
            lambda free, states: coreachable(self.system.diagrams, free, states, self.states),
            acceleration,
        )

    def path_to(self, goal: Diagram) -> Path:
        """Return a path from the initial state to one of these states, with the fewest batches; deterministic."""
        system = self.system
        layers, seen = [system.initial], system.initial
        batches = [(batch, system.diagrams.true) for batch in self._alone]
        batches += [(batch, self._waits) for batch, _ in self._waiting]
        while not (layers[-1] & goal).satisfiable():
            reached = system.diagrams.any_of(batch.image(layers[-1] & waits) for batch, waits in batches)
            layers.append(reached & ~seen)
            seen |= reached
            assert layers[-1].satisfiable()
        codes = [pick(layers[-1] & goal, system.encoding.layout.state)]
        taken = []
        for layer in reversed(layers[:-1]):
            here = system.encoding.state(codes[-1])
            batch, before = next(
                (batch, before)
                for batch, waits in batches
                if (before := batch.preimage(here) & waits & layer).satisfiable()
            )
            codes.append(pick(before, system.encoding.layout.state))
            taken.append(batch)
        codes.reverse()
        path = Path(codes[:1], [])
        for batch, ends in zip(reversed(taken), pairwise(codes), strict=True):
            part = batch.between(system, *ends)
            path.states.extend(part.states[1:])
            path.moves.extend(part.moves)
        return path

    @cached_property
    def _waits(self) -> Diagram:
        """States in which the loop permits events that are not internal."""
        return self.system.diagrams.true if self._overruns else ~self._active

    @cached_property
    def _active(self) -> Diagram:
        """States in which an internal event can happen that is not held back."""
        internal = self.system.internal
        return self.system.diagrams.any_of(event.allowed & ~self.withheld(event.relation.event) for event in internal)

    @cached_property
    def _overruns(self) -> bool:
        """Whether more internal events can happen in a row than the loop permits."""
        system, bound = self.system, self.system.roles.settling_bound
        if system.completion.bound is None:
            return True
        if system.completion.bound <= bound:
            return False
        # The bound adds up those of groups of events. No sequence need be that long.
        for length, states in enumerate(runs(system.diagrams, system.internal, system.controlled), 1):
            if length > bound or not states.satisfiable():
                return states.satisfiable()
        raise AssertionError("there is no end to longer and longer runs")

    def _closure(self, states: Diagram, fire: Fire, close: Close, acceleration: _LoopAcceleration) -> Diagram:
        for turn in count(1):
            closed = states = close(self._free, states)
            for batch, near in self._waiting:
                more = states | fire(batch, states)
                # Without this, the states in which others are quiescent again would be added one by one.
                states = states if more == states else close(near, more)
            if states == closed:
                break
            states = acceleration.taken(states, turn)
        return states


class _LoopAcceleration:
    """Acceleration of many turns of the loop, for models whose wide integers keep it going.

    A single event of a batch is a batch, too, because the others may be missing. Each state that events reach one by
    one, within the conditions of the loop, is therefore a state that the loop reaches.
    """

    def __init__(
        self,
        free: Sequence[SymbolicStep],
        waiting: Sequence[tuple[_Batch, Sequence[SymbolicStep]]],
        where: Diagram,
        within: Diagram,
        *,
        forwards: bool,
    ) -> None:
        """Prepare the acceleration; batches start in `where`, and every state is `within` the bound."""
        self._free = free
        self._batches = [[step for _, step in batch.moves] for batch, _ in waiting]
        self._where = where
        self._within = within
        self._forwards = forwards
        self._acceleration = Acceleration([*free, *chain(*self._batches)], forwards=forwards)

    def taken(self, states: Diagram, turn: int) -> Diagram:
        """Return the states with those that acceleration adds if it is due.

        Raises ModelError as `Acceleration` does.
        """
        if self._acceleration.due(turn):
            for number, here in enumerate(self._restricted):
                others = chain(*self._restricted[:number], *self._restricted[number + 1 :], self._free)
                for step in self._acceleration.over(here, list(others), turn, self._within):
                    states |= step.image(states) if self._forwards else step.preimage(states)
        return states

    @cached_property
    def _restricted(self) -> list[list[SymbolicStep]]:
        """Batches whose events are restricted to the states in which the loop permits them."""
        return [[replace(step, relation=step.relation & self._where) for step in steps] for steps in self._batches]


def _triggers(batch: Sequence[Move], group: Sequence[InternalEvent]) -> bool:
    """Return whether the events may enable internal events of the group."""
    changed = {element for relation, _ in batch for element in relation.changed}
    return any(not event.touched.isdisjoint(changed) for event in group)
