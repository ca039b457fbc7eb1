"""Verdicts in words: what follows the table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.supervision.wording import in_words
from robosc.analysis.verification.verdict import Outcome

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.analysis.verification.verdict import Verdict
    from robosc.metamodel import sct
    from robosc.synthesis import TraceStep

#: What no verdict is about.
TRUSTED = (
    "Trusted, not examined: that plants and requirements are what the text says, the control loop around the events, "
    "the C compiler, RoboSC itself; docs/verify.md says more."
)


def details(verdict: Verdict, model: sct.SupervisoryControlModel) -> str:
    """What is wrong, and the shortest way to it, a line an event; empty where there is nothing to add."""
    if not verdict.explanation:
        return ""
    lines = [f"{verdict.property}: {verdict.explanation}"]
    if verdict.outcome is Outcome.REFUTED and verdict.trace:
        lines += _numbered("after", verdict.trace, model)
    if verdict.onwards:
        lines += _numbered("then", verdict.onwards, model)
    if verdict.other:
        lines += _numbered("or instead", verdict.other, model)
    return "\n".join(lines)


def _numbered(heading: str, steps: Sequence[TraceStep], model: sct.SupervisoryControlModel) -> list[str]:
    said = [f"    {number}. {in_words([each], model)}" for number, each in enumerate(steps, 1)]
    return [f"  {heading}", *said]


def summary(verdicts: Sequence[Verdict]) -> str:
    """How many verdicts there are of each outcome: `12 proved, 1 refuted`."""
    counts = {outcome: sum(each.outcome is outcome for each in verdicts) for outcome in Outcome}
    return ", ".join(f"{count} {outcome}" for outcome, count in counts.items() if count)
