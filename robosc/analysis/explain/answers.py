"""Answers about an event in a state, about an impossible event, and about an empty supervisor."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from robosc.engine import Blocked

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.analysis.blocking import BlockingCounterexample, BlockReason
    from robosc.analysis.paths import TraceStep
    from robosc.model import sct
    from robosc.synthesis.decoding import Value
    from robosc.synthesis.encoding import Element


class Reach(StrEnum):
    """Reachability of a state by a robot."""

    SUPERVISED = "supervised"
    #: The plants reach the state, but the supervisor prevents it.
    UNSUPERVISED = "unsupervised"
    NEVER = "never"


@dataclass(frozen=True)
class Note:
    """A sentence, without its full stop, about an element of the model; `details` are further sentences."""

    element: Any
    text: str
    details: tuple[str, ...] = ()


@dataclass(frozen=True)
class Situation:
    """A state, and a shortest trace to it from the initial one, under the supervisor if possible."""

    codes: Mapping[Element, int]
    state: Mapping[str, Value]
    reach: Reach
    trace: tuple[TraceStep, ...]


@dataclass(frozen=True)
class Explanation:
    """Answer whether an event can happen in a situation, with the reasons if it cannot.

    `by` is the first cause that forbids it: plants, assumptions, requirements or synthesis. It is None if nothing
    forbids the event. It is also None if the supervisor never lets the robot reach the state and neither plants nor
    requirements forbid the event. `plants` and `requirements` are all obstacles. `counterexample` is the consequence if
    synthesis did not forbid the event; `blamed` are then the requirements that forbid something after the end of that
    counterexample. `changes` are transitions of the events that can happen now and after which the event can happen.
    `way` is a shortest trace from here, under the supervisor, to a state that allows the event: empty if this state
    allows it, None if there is none. `refusal` explains the first event of the trace that the supervisor forbids, if it
    never lets the robot reach this state. `data` are the requirements that permit only some data of the command here.
    """

    event: sct.Event
    situation: Situation
    by: Blocked | None
    plants: tuple[Note, ...] = ()
    requirements: tuple[Note, ...] = ()
    counterexample: BlockingCounterexample | None = None
    blamed: tuple[Note, ...] = ()
    changes: tuple[Note, ...] = ()
    way: tuple[TraceStep, ...] | None = None
    refusal: Explanation | None = None
    data: tuple[Note, ...] = ()

    @property
    def allowed(self) -> bool:
        """Whether the event can happen in this state under the supervisor."""
        return self.by is None and self.situation.reach is Reach.SUPERVISED

    @property
    def needless(self) -> bool:
        """Whether the model's supervisor forbids the event, but a newly synthesized one would not."""
        return self.by is Blocked.SYNTHESIS and self.counterexample is None


@dataclass(frozen=True)
class Loosening:
    """Requirement of the text, as requirements of the model, whose removal would help.

    `states` is the number of states under the supervisor without it.
    """

    requirements: tuple[sct.StatedRequirement, ...]
    states: int


@dataclass(frozen=True)
class Emptiness:
    """Explanation of an empty supervisor.

    `stuck` are the plants that can no longer reach a marked state at the end of the reason's trace. `blamed` are the
    requirements that forbid something after it. `loosenings` are the requirements each of which, left out alone, would
    give a supervisor. None: there would be none even without any requirement.
    """

    reason: BlockReason
    stuck: tuple[Note, ...]
    blamed: tuple[Note, ...]
    loosenings: tuple[Loosening, ...] | None


@dataclass(frozen=True)
class Possibility:
    """Answer whether an event can ever happen, explained in the nearest state with the fewest obstacles.

    `nearest` is a state that allows it. If there is none, only synthesis forbids it there; if that is impossible, only
    requirements; otherwise, it is a state that the plants allow but the supervisor never lets the robot reach. It is
    None if the plants never allow the event; `plants` then has the reasons. If its requirements forbid the event,
    `beyond` is the nearest state in which they would not. `beyond` is None if there is none independently of the
    supervisor; `conflict` are then the requirements on the event that allow it nowhere, alone or together. `loosenings`
    are requirements without which it could happen, as in `Emptiness`.
    """

    event: sct.Event
    nearest: Explanation | None
    plants: tuple[Note, ...] = ()
    beyond: Explanation | None = None
    loosenings: tuple[Loosening, ...] | None = ()
    conflict: tuple[Note, ...] = ()

    @property
    def possible(self) -> bool:
        """Whether the event can happen in some state that the supervised robot reaches."""
        return self.nearest is not None and self.nearest.allowed


Answer = Explanation | Possibility | Emptiness
