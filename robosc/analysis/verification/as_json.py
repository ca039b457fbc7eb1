"""Verdicts as JSON, for programs."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from robosc.analysis.verification.verdict import Outcome

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.analysis.verification.verdict import Verdict
    from robosc.synthesis import TraceStep


def render(robot: str, verdicts: Sequence[Verdict]) -> str:
    """One object: `proved` says that nothing was refuted; a trace is a list of events with the inputs that matter."""
    answer = {
        "robot": robot,
        "proved": all(each.outcome is not Outcome.REFUTED for each in verdicts),
        "properties": [_verdict(each) for each in verdicts],
    }
    return json.dumps(answer, indent=2) + "\n"


def _verdict(verdict: Verdict) -> dict[str, Any]:
    return {
        "property": verdict.property,
        "outcome": verdict.outcome.value,
        "evidence": verdict.evidence,
        "explanation": verdict.explanation or None,
        "trace": _steps(verdict.trace),
        "onwards": _steps(verdict.onwards),
        "other": _steps(verdict.other),
        "seconds": round(verdict.seconds, 3),
    }


def _steps(trace: Sequence[TraceStep]) -> list[dict[str, Any]]:
    return [{"event": each.event, "inputs": dict(each.inputs)} for each in trace]
