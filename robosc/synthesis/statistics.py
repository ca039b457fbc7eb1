"""Phases and costs of a synthesis, while it runs and afterwards."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import StrEnum
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any, Self, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


#: Function of a step and a set of states.
Follow = TypeVar("Follow", bound="Callable[..., Any]")


class Phase(StrEnum):
    """Phases of synthesis, in this order."""

    #: Computes the variable order.
    ORDER = "order"
    #: Builds the decision diagrams of the plants, the requirements and the relation of each event.
    ENCODE = "encode"
    #: Computes the states that are reachable without requirements, and the controlled ones.
    FIXPOINT = "fixpoint"
    #: Writes the guards as expressions, or explains why there is no supervisor.
    GUARDS = "guards"
    #: Searches for behavior that is allowed but probably not intended.
    OBSERVE = "observe"


@dataclass
class Statistics:
    """Costs of one synthesis; another thread may read them at any time.

        statistics = Statistics()
        synthesize(model, statistics=statistics)
        print(statistics.seconds[Phase.FIXPOINT], statistics.peak_nodes)

    `phase` is the current phase. `seconds` and `processor_seconds` are the costs of each phase that has ended:
    wall-clock time, and the processor time of the whole process. `rounds` counts the rounds of the fixpoint,
    `operations` the images and preimages of an event. `states` is the number of states at the end of the last search of
    a round. `peak_nodes` is the maximum number of nodes at a time, garbage included. If more memory is needed,
    synthesis restarts (`attempts`): the seconds add up, everything else starts again at 0. Every run gives the same
    values, except for the seconds. If two strategies ran in turns, the counts are those of the chosen one.
    """

    phase: Phase | None = None
    seconds: dict[Phase, float] = field(default_factory=dict)
    processor_seconds: dict[Phase, float] = field(default_factory=dict)
    attempts: int = 0
    rounds: int = 0
    operations: int = 0
    states: int = 0
    peak_nodes: int = 0
    #: Strategy that computed the result, None before that.
    strategy: str | None = None

    @contextmanager
    def during(self, phase: Phase) -> Iterator[None]:
        """Set the phase and measure the time of the `with` block."""
        began, processor_began = perf_counter(), process_time()
        self.phase = phase
        try:
            yield
        finally:
            self.seconds[phase] = self.seconds.get(phase, 0.0) + perf_counter() - began
            processor = process_time() - processor_began
            self.processor_seconds[phase] = self.processor_seconds.get(phase, 0.0) + processor

    def begin_again(self) -> None:
        """Start a new attempt."""
        self.attempts += 1
        self.rounds = self.operations = self.states = self.peak_nodes = 0

    def another(self) -> Self:
        """Return statistics of the same kind for another computation, which begins with the same operations."""
        other = type(self)()
        other.operations = self.operations
        return other

    def followed(self, follow: Follow) -> Follow:
        """Return a function that follows steps as `follow` does, and records their costs if they are observed."""
        return follow

    def replace_costs(self, other: Statistics) -> None:
        """Take over the counts of another computation."""
        self.rounds, self.operations, self.states = other.rounds, other.operations, other.states
        self.peak_nodes = other.peak_nodes
