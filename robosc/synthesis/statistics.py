"""Phases and costs of a synthesis, while it runs and afterwards."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import StrEnum
from time import perf_counter, process_time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator


class Phase(StrEnum):
    """The phases of synthesis, in this order."""

    #: Puts the variables in order.
    ORDER = "order"
    #: Makes decision diagrams of the plants, the requirements and the relation of each event.
    ENCODE = "encode"
    #: Finds the states that can be reached without requirements, and the controlled ones.
    FIXPOINT = "fixpoint"
    #: Says in expressions when each event is allowed; or why there is no supervisor.
    GUARDS = "guards"
    #: Looks for what is allowed, but hardly meant.
    OBSERVE = "observe"


@dataclass
class Statistics:
    """The costs of one synthesis, to be handed to it; another thread may read them at any time.

    statistics = Statistics()
    synthesize(model, statistics=statistics)
    print(statistics.seconds[Phase.FIXPOINT], statistics.peak_nodes)

    `phase` is what it is at. `seconds` and `processor_seconds` are the costs of each phase that has ended: wall-clock
    time, and the processor time of the whole process. `rounds` counts the rounds of the fixpoint, `operations` the
    images and preimages of an event, `states` those that the last ended search of a round has found. `peak_nodes` is
    the most nodes that were there at once, garbage included. Where more memory is needed synthesis begins again
    (`attempts`): the seconds add up, all else begins anew. But for the seconds all of it is the same on every run.
    """

    phase: Phase | None = None
    seconds: dict[Phase, float] = field(default_factory=dict)
    processor_seconds: dict[Phase, float] = field(default_factory=dict)
    attempts: int = 0
    rounds: int = 0
    operations: int = 0
    states: int = 0
    peak_nodes: int = 0

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
        """A new attempt."""
        self.attempts += 1
        self.rounds = self.operations = self.states = self.peak_nodes = 0
