"""Elements of a plan: stimuli, places of a control loop, and steps between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from robosc.engine.state import Value


@dataclass(frozen=True)
class Stimulus:
    """Stimulus of a control loop: a batch of incoming events with their inputs, or a wait (no events).

    A wait ends when the next timer expires, or with the pause after a failure.
    """

    name: str
    events: tuple[tuple[str, tuple[tuple[str, Value], ...]], ...] = ()
    fails: bool = False


WAIT = Stimulus("wait")


class Place(NamedTuple):
    """State of a loop as far as a plan distinguishes it: its cells, the running timers, and whether it pauses."""

    cells: tuple[int, ...]
    running: frozenset[int]
    pauses: bool
    #: Remaining periods of each running timer, in the order of the timers; empty if a step takes no time.
    left: tuple[int, ...] = ()

    def resembles(self, other: Place) -> bool:
        """Return whether the places are equal except for the remaining times."""
        return self._replace(left=other.left) == other


class TourStep(NamedTuple):
    """Step of a tour: its stimulus, the place that it leads to, and the goals that it shows, as bits."""

    stimulus: Stimulus
    end: Place
    shows: int
