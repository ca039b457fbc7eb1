"""Two strategies for the same fixpoint, in turns until one of them is done.

Both compute the same supervisor. The turns depend on numbers of operations only, so the winner is the same on every
run.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, Generic

from robosc.synthesis.bdd import OutOfRoomError
from robosc.synthesis.fixpoint import T, completed, good_of_all, supervise_forwards, supervise_within

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.fixpoint import Computation, Search, SupervisedStates

#: Number of operations before the second strategy begins. Most models are done by then.
_HEAD_START = 1 << 14
#: Maximum number of operations of the second strategy, per event. Where it is better, it needs fewer.
_PATIENCE = 400


class Strategy(StrEnum):
    """Set of states in which the fixpoint searches for the good ones."""

    #: States that are reachable under the requirements.
    FORWARD = "forward"
    #: All states. Their diagrams are smaller for chains of components, and far larger for many other models.
    BACKWARD = "backward"


class Race:
    """Computation of the supervised states with the better strategy.

    `strategy` is the chosen one, or None as long as none is chosen. It stays chosen if synthesis restarts.
    """

    def __init__(self, strategy: Strategy | None = None) -> None:
        """Choose a strategy, or none."""
        self.strategy = strategy

    def supervise(self, search: Search, rival: Callable[[], Search]) -> SupervisedStates:
        """Return the states of the supervisor.

        Unless a strategy is chosen, the forward strategy runs on `search`. If it takes long, the backward strategy runs
        on `rival()`, which has diagrams of its own.
        """
        if search.encoding.layout.wide:
            # Backwards, the search would count through all values of wide integers.
            self.strategy = self.strategy or Strategy.FORWARD
        if self.strategy is Strategy.BACKWARD:
            return supervise_within(search, completed(good_of_all(search)))
        forward, turn = _Runner(search, supervise_forwards(search)), _HEAD_START
        backward: _Runner[Diagram] | None = None
        while not forward.advance(turn):
            if self.strategy is None:
                if backward is None:
                    other = rival()
                    backward = _Runner(other, good_of_all(other))
                if backward.advances(turn):
                    self.strategy = Strategy.BACKWARD
                    return supervise_within(backward.search, backward.result)
                if backward.is_out_of_room or turn > _PATIENCE * len(search.moves):
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
        self.is_out_of_room = False

    def advance(self, operations: int) -> bool:
        """Run until that many operations are done in total; return whether there is a result."""
        while self._statistics.operations - self._start < operations:
            try:
                next(self._computation)
            except StopIteration as end:
                self.result = end.value
                return True
        return False

    def advances(self, operations: int) -> bool:
        """Run as `advance`, but end with `is_out_of_room` instead of an error."""
        try:
            return self.advance(operations)
        except OutOfRoomError:
            self.is_out_of_room = True
            return False
