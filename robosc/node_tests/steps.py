"""What a plan is made of: what may come in, where a control loop is, and the steps between."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from robosc.engine.state import Value


@dataclass(frozen=True)
class Stimulus:
    """Something that comes in: a batch of events with their inputs. Without events: time goes by.

    Until the next time is up, that is, or the pause after a failure is over.
    """

    name: str
    events: tuple[tuple[str, tuple[tuple[str, Value], ...]], ...] = ()
    fails: bool = False


WAIT = Stimulus("wait")


class Place(NamedTuple):
    """Where a loop is, as far as a plan tells places apart: its cells, the times that run, and whether it pauses."""

    cells: tuple[int, ...]
    running: frozenset[int]
    pauses: bool
    #: How many periods each time still runs, in the order of the timers; nothing where a step takes no time.
    left: tuple[int, ...] = ()

    def resembles(self, other: Place) -> bool:
        """Whether they are the same but for how long the times still run."""
        return self._replace(left=other.left) == other


class Step(NamedTuple):
    """A step of a tour: what comes in, where that leads, and what it shows, a bit for each goal."""

    stimulus: Stimulus
    end: Place
    shows: int
