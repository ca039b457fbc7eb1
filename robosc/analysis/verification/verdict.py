"""What was asked of a supervised system, and the answer."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.synthesis import TraceStep


class Outcome(StrEnum):
    """How an examination ended."""

    PROVED = "proved"
    REFUTED = "refuted"
    #: No difference was found, but not everything was looked at.
    SAMPLED = "sampled"
    #: It could not be examined: `Verdict.explanation` says why.
    SKIPPED = "skipped"


@dataclass(frozen=True)
class Verdict:
    """The answer to one question, in `seconds`.

    `property` is its short name (`non-blocking`), `evidence` what was looked at (`1,234 states`), `explanation` a
    sentence where it is refuted or skipped. `trace` is then a shortest way from the initial state to the fault,
    `onwards` how it can go on from there, `other` a second way from there, where these are needed to show it.
    """

    property: str
    outcome: Outcome
    evidence: str
    explanation: str = ""
    trace: tuple[TraceStep, ...] = ()
    onwards: tuple[TraceStep, ...] = ()
    other: tuple[TraceStep, ...] = ()
    seconds: float = 0.0
