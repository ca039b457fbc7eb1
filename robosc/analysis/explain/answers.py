"""What can be said about an event in a state, about one that never happens, and about a robot without a supervisor."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from robosc.engine import Blocked

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.analysis.blocking import BlockingCounterexample, Reason
    from robosc.analysis.paths import TraceStep
    from robosc.metamodel import sct
    from robosc.synthesis.decoding import Value
    from robosc.synthesis.encoding import Element


class Reach(StrEnum):
    """How a robot gets into a state."""

    SUPERVISED = "supervised"
    #: Its plants do, but the supervisor keeps them from it.
    UNSUPERVISED = "unsupervised"
    NEVER = "never"


@dataclass(frozen=True)
class Note:
    """A sentence, without its full stop, about an element of the model; `details` are further ones."""

    element: Any
    text: str
    details: tuple[str, ...] = ()


@dataclass(frozen=True)
class Situation:
    """A state, and a shortest trace to it from the initial one, under the supervisor if that is possible."""

    codes: Mapping[Element, int]
    state: Mapping[str, Value]
    reach: Reach
    trace: tuple[TraceStep, ...]


@dataclass(frozen=True)
class Explanation:
    """Whether an event can happen in a situation, and why not.

    `by` is the first of what forbids it: the plants, requirements, synthesis; None where nothing does, or, in a state
    that the supervisor never lets the robot get to, where neither plants nor requirements do. `plants` and
    `requirements` say all that forbids it, `counterexample` what would follow if synthesis did not; there `blamed` are
    the requirements that forbid something from the end of that counterexample on. `changes` are the transitions of
    those events that can happen now and after which it can. `way` is a shortest trace from here, under the supervisor,
    to where the event can happen: empty if that is here, None if there is none. `refusal` is about the
    first event on the trace that the supervisor forbids, where it never lets the robot get to this state.
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

    @property
    def allowed(self) -> bool:
        """Whether the event can happen in this state under the supervisor."""
        return self.by is None and self.situation.reach is Reach.SUPERVISED

    @property
    def needless(self) -> bool:
        """Whether the model's supervisor forbids it, and the one that synthesis finds would not."""
        return self.by is Blocked.SYNTHESIS and self.counterexample is None


@dataclass(frozen=True)
class Loosening:
    """A requirement of the text, as the requirements of the model that it became, whose absence would help.

    `states` are then left under the supervisor.
    """

    requirements: tuple[sct.StatedRequirement, ...]
    states: int


@dataclass(frozen=True)
class Emptiness:
    """Why a supervisor is empty.

    `stuck` are the plants that can't be in a marked state any more where the reason's trace ends, `blamed` the
    requirements that forbid something from there on. `loosenings`: the requirements each of which, left out alone,
    would give a supervisor; None: there would be none even without any requirement.
    """

    reason: Reason
    stuck: tuple[Note, ...]
    blamed: tuple[Note, ...]
    loosenings: tuple[Loosening, ...] | None


@dataclass(frozen=True)
class Possibility:
    """Whether an event can ever happen, explained in the nearest state where most of what it takes is there.

    `nearest` is a state where it is allowed; else where only synthesis forbids it; else only requirements; else one
    that the supervisor never lets the robot get to, where the plants allow it. None where they never do: `plants` says
    why. `beyond` is, where its requirements forbid it, the nearest state in which they would not; None where there is
    none, whatever the supervisor does; then `conflict` are the requirements on it that allow it nowhere, alone or
    together. `loosenings` are requirements without which it could happen, as for `Emptiness`.
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
