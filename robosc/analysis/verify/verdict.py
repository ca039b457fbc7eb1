"""Verdicts on a supervised system; as JSON, as JUnit XML, and in words."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from enum import StrEnum
from time import perf_counter
from typing import TYPE_CHECKING, Any, ParamSpec

from robosc.analysis.paths import TraceStep, trace_data
from robosc.analysis.wording import in_words
from robosc.base.diagnostics import as_junit as as_junit_xml
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.model import sct

P = ParamSpec("P")

#: Parts that no verdict covers.
TRUSTED = (
    "Trusted, not examined: the reading of the text itself, the ROS node around the control loop, the C compiler, "
    "RoboSC itself; see docs/verify.md."
)


#: Method of verification of a requirement, in the vocabulary of S-CORE for test cases.
_HOW = (("TestType", "requirements-based"), ("DerivationTechnique", "requirements-analysis"))


class Outcome(StrEnum):
    """Result of an examination."""

    PROVED = "proved"
    REFUTED = "refuted"
    #: The property does not hold, but no promise is broken. `Verdict.findings` are warnings.
    WARNED = "warned"
    #: No difference, but the examination was not exhaustive.
    SAMPLED = "sampled"
    #: Not examined; `Verdict.explanation` holds the reason.
    SKIPPED = "skipped"


@dataclass(frozen=True)
class Verdict:
    """Answer to one question, which took `seconds`.

    `property` is its short name (`non-blocking`). `evidence` is the extent of the examination (`1,234 states`).
    `explanation` is a sentence unless nothing is wrong. `requirement` identifies the requirement in question, if any.
    `trace` is a shortest trace from the initial state to the fault. `onwards` is a continuation and `other` a
    second one, if the fault needs them. `findings` are warnings at places of the text.
    """

    property: str
    outcome: Outcome
    evidence: str
    explanation: str = ""
    trace: tuple[TraceStep, ...] = ()
    onwards: tuple[TraceStep, ...] = ()
    other: tuple[TraceStep, ...] = ()
    seconds: float = 0.0
    requirement: str = ""
    findings: tuple[Diagnostic, ...] = ()


def measure(examine: Callable[P, Verdict], *arguments: P.args, **named: P.kwargs) -> Verdict:
    """Return the verdict of an examination with its seconds."""
    began = perf_counter()
    return replace(examine(*arguments, **named), seconds=perf_counter() - began)


def trace_step(event: sct.Event) -> TraceStep:
    """Return the event as the end of a trace, without its inputs."""
    return TraceStep(event_name(event))


def as_json(robot: str, verdicts: Sequence[Verdict]) -> str:
    """Return the verdicts as JSON, one object.

    `proved` is true if nothing is refuted. A trace lists events with their inputs.
    """
    answer = {
        "robot": robot,
        "proved": all(verdict.outcome is not Outcome.REFUTED for verdict in verdicts),
        "properties": [_verdict(verdict) for verdict in verdicts],
    }
    return json.dumps(answer, indent=2) + "\n"


def _verdict(verdict: Verdict) -> dict[str, Any]:
    return {
        "property": verdict.property,
        "outcome": verdict.outcome.value,
        "evidence": verdict.evidence,
        "explanation": verdict.explanation or None,
        "trace": trace_data(verdict.trace),
        "onwards": trace_data(verdict.onwards),
        "other": trace_data(verdict.other),
        "seconds": round(verdict.seconds, 3),
    }


def as_junit(model: sct.SupervisoryControlModel, verdicts: Sequence[Verdict], file: str) -> str:
    """Return JUnit XML; a property of the model in a file is a test case.

    A refuted property is a failure with its trace as the text. The properties of a test case that verifies a
    requirement are those that Eclipse S-CORE uses for links.
    """
    return as_junit_xml.render("robosc verify", [_test_case(model, verdict, verdicts, file) for verdict in verdicts])


def _test_case(
    model: sct.SupervisoryControlModel, verdict: Verdict, verdicts: Sequence[Verdict], file: str
) -> as_junit_xml.TestCase:
    alone = sum(other.requirement == verdict.requirement for other in verdicts) == 1
    verifies = "FullyVerifies" if alone else "PartiallyVerifies"
    refuted, skipped = (verdict.outcome is outcome for outcome in (Outcome.REFUTED, Outcome.SKIPPED))
    failure = as_junit_xml.Failure(verdict.explanation, verdict.outcome.value, details(verdict, model))
    return as_junit_xml.TestCase(
        model.name,
        verdict.property,
        file,
        verdict.seconds,
        failure=failure if refuted else None,
        skipped=verdict.explanation if skipped else None,
        output=f"{verdict.evidence}; {verdict.explanation}" if verdict.outcome is Outcome.WARNED else verdict.evidence,
        properties=((verifies, verdict.requirement), *_HOW) if verdict.requirement else (),
    )


def _count(verdicts: Sequence[Verdict], outcome: Outcome) -> int:
    return sum(verdict.outcome is outcome for verdict in verdicts)


def details(verdict: Verdict, model: sct.SupervisoryControlModel) -> str:
    """Return the fault and the shortest trace to it, one event on each line; empty if there is nothing to add."""
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
    steps_in_words = [f"    {number}. {in_words([step], model)}" for number, step in enumerate(steps, 1)]
    return [f"  {heading}", *steps_in_words]


def summary(verdicts: Sequence[Verdict]) -> str:
    """Return the number of verdicts for each outcome: `12 proved, 1 refuted`."""
    counts = {outcome: sum(verdict.outcome is outcome for verdict in verdicts) for outcome in Outcome}
    return ", ".join(f"{count} {outcome}" for outcome, count in counts.items() if count)
