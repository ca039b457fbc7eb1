"""Strategies for the same fixpoint, in turns until one of them is done.

All compute the same supervisor. The turns depend on numbers of operations only, so the winner is the same on every run.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Generic

from robosc.synthesis.bdd import OutOfRoomError
from robosc.synthesis.fixpoint import (
    T,
    completed,
    good_states,
    safe_states,
    supervise_forwards,
    supervise_within,
)
from robosc.synthesis.memory import TooFewAddressesError

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.fixpoint import Computation, Search, SupervisedStates

#: Number of operations before another strategy begins. Most models are done by then.
_HEAD_START = 1 << 14
#: Maximum number of operations of the backward strategy, per event. Where it is better, it needs fewer.
_PATIENCE = 400


class Strategy(StrEnum):
    """Set of states in which the fixpoint searches for the good ones."""

    #: States that are reachable under the requirements.
    FORWARD = "forward"
    #: States that are reachable without leaving the safe ones: uncontrollable events lead to no violation there.
    SAFE = "safe"
    #: All states. Their diagrams are smaller for chains of components, and far larger for many other models.
    BACKWARD = "backward"


class StrategyChosenError(Exception):
    """The race has chosen a strategy that needs a new search. All diagrams of the old ones can be released first."""


class Race:
    """Computation of the supervised states with the best strategy.

    `strategy` is the chosen one, or None as long as none is chosen. It stays chosen if synthesis restarts.
    """

    def __init__(self, strategy: Strategy | None = None) -> None:
        """Choose a strategy, or none."""
        self.strategy = strategy

    def supervise(self, search: Search, another: Callable[[], Search]) -> SupervisedStates:
        """Return the states of the supervisor.

        Unless a strategy is chosen, the forward strategy runs on `search`. If it takes long, the backward strategy runs
        in turns with it on `another()`, a search with diagrams of its own. If that takes long, too, the safe strategy
        replaces both, provided that the safe states are known and that there are violations. Raises
        StrategyChosenError to begin again with it.
        """
        if self.strategy is None and search.encoding.layout.wide:
            # Backwards, the search would count through all values of wide integers.
            self.strategy = Strategy.FORWARD
        if self.strategy is Strategy.FORWARD:
            return completed(supervise_forwards(search))
        if self.strategy is Strategy.BACKWARD:
            return supervise_within(search, completed(good_states(search, completed(safe_states(search)))))
        if self.strategy is Strategy.SAFE:
            return completed(supervise_forwards(search, completed(safe_states(search))))
        return self._race(_Runner(search, supervise_forwards(search)), another)

    def _race(self, forward: _Runner[SupervisedStates], another: Callable[[], Search]) -> SupervisedStates:
        turn = _HEAD_START
        backward: _Backward | None = None
        while not forward.advance(turn):
            if self.strategy is None:
                try:
                    backward = backward or _Backward(another())
                except TooFewAddressesError:
                    self.strategy = Strategy.FORWARD
                    continue
                if backward.advance(turn):
                    self.strategy = Strategy.BACKWARD
                    return supervise_within(backward.search, backward.result)
                if backward.is_out_of_room or turn > _PATIENCE * len(forward.search.moves):
                    if backward.knows_safe and forward.search.violating.satisfiable():
                        self.strategy = Strategy.SAFE
                        raise StrategyChosenError
                    self.strategy, backward = Strategy.FORWARD, None
            turn *= 2
        self.strategy = Strategy.FORWARD
        return forward.result


class _Runner(Generic[T]):
    """Computation that runs in turns."""

    result: T

    def __init__(self, search: Search, computation: Computation[T]) -> None:
        self.search = search
        self._computation = computation
        self._statistics = search.diagrams.statistics
        self._start = self._statistics.operations

    def advance(self, operations: int) -> bool:
        """Run until that many operations are done in total; return whether there is a result."""
        while self._statistics.operations - self._start < operations:
            try:
                next(self._computation)
            except StopIteration as end:
                self.result = end.value
                return True
        return False


class _Backward(_Runner["Diagram"]):
    """Computation of the good states among all states. `knows_safe`: the safe states are computed."""

    def __init__(self, search: Search) -> None:
        super().__init__(search, self._good())
        self.knows_safe = self.is_out_of_room = False

    def _good(self) -> Computation[Diagram]:
        safe = yield from safe_states(self.search)
        self.knows_safe = True
        return (yield from good_states(self.search, safe))

    def advance(self, operations: int) -> bool:
        """Run as any computation, but end with `is_out_of_room` instead of an error."""
        try:
            return super().advance(operations)
        except OutOfRoomError:
            self.is_out_of_room = True
            return False
