"""Sources of runs: a script, an event log, a recording, or a counterexample of `verify`."""

from __future__ import annotations

import re
from difflib import get_close_matches
from typing import TYPE_CHECKING, NamedTuple

from robosc.analysis.verify import Outcome, verify_system
from robosc.base.files import reading as files
from robosc.base.files.json_reading import JsonError, json_value
from robosc.base.recordings import recorded_texts
from robosc.language.text import decode
from robosc.run.simulation.script import WAIT, ScriptStep, read_script, unfit_data
from robosc.run.simulation.simulation import LoopSimulation
from robosc.run.simulation.tracker import ReportError, Tracker

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.analysis.paths import TraceStep
    from robosc.base.diagnostics import Diagnostic
    from robosc.run.simulation.simulation import Simulation
    from robosc.run.simulation.tracker import ReportedMoment


class PlayError(Exception):
    """Error of a source that can't be played, with findings in a model or script, and their texts by path."""

    def __init__(
        self, message: str, findings: Sequence[Diagnostic] = (), texts: Mapping[str, str] | None = None
    ) -> None:
        super().__init__(message)
        self.findings = findings
        self.texts = texts or {}


def script_steps(simulation: Simulation, path: str) -> list[ScriptStep]:
    """Return the steps of a script or event log. Raises PlayError, and OSError if it can't be read."""
    text, faults = decode(path, files.read(path))
    events = [*simulation.engine.events, WAIT]
    others = [word for word in LoopSimulation.OWN if word != WAIT]
    steps, findings = read_script(path, text.content, events, others, simulation.engine.model)
    findings += [*faults, *unfit_data(path, steps, simulation.data)]
    if findings:
        raise PlayError(f"{path}: {findings[0].message}", findings, {path: text.content})
    return steps


def recorded_moments(simulation: Simulation, path: str, node: str | None) -> Iterator[tuple[float, ReportedMoment]]:
    """Yield the recorded reports of a node with their times in seconds; the simulation is in the state after each.

    `node` is its full name; None means the only node that reports this robot. Raises PlayError, RecordingError, and
    OSError.
    """
    tracker = Tracker(simulation.engine)
    began: float | None = None
    fault = None
    told_by: str | None = None
    for topic, text in recorded_texts(path):
        name, _, kind = topic.rpartition("/")
        if kind not in ("state", "definition") or name != (node or told_by or name):
            continue
        if kind == "definition":
            tracker.begin()
            continue
        try:
            report = json_value(text)
            followed = tracker.report(report)
        except (JsonError, ReportError) as error:
            fault = fault or f"{topic}: {error}"
            continue
        told_by = name
        began = report["time"] if began is None else began
        for reported in followed:
            yield round(report["time"] - began, 3), reported
    if began is None:
        source = f"`{node}/state`" if node else "a topic `~/state`"
        raise PlayError(f"{path} has no reports of this robot on {source}{f': {fault}' if fault else ''}")


class Counterexample(NamedTuple):
    """Steps that refute a property: the state after the first `violation` of them violates it. `explanation`: why."""

    property: str
    steps: list[ScriptStep]
    violation: int
    explanation: str


def counterexample_of(simulation: Simulation, name_of_property: str | None) -> Counterexample:
    """Return a counterexample of a property; None means the first refuted one.

    Irrelevant data has the defaults of ROS. Raises PlayError if there is no counterexample.
    """
    verdicts = verify_system(simulation.engine.model)
    properties = [verdict.property for verdict in verdicts]
    named = [name for name in properties if name_of_property is None or _is_called(name, name_of_property)]
    if name_of_property is not None and not named:
        close = get_close_matches(name_of_property, properties, n=1)
        raise PlayError(f"unknown property `{name_of_property}`{f'; did you mean `{close[0]}`?' if close else ''}")
    refuted = next(
        (verdict for verdict in verdicts if verdict.outcome is Outcome.REFUTED and verdict.property in named), None
    )
    if refuted is None:
        raise PlayError("no property is refuted, so there is no counterexample")
    steps = _steps(simulation, [*refuted.trace, *refuted.onwards])
    return Counterexample(refuted.property, steps, len(refuted.trace), refuted.explanation)


def _is_called(verified: str, name: str) -> bool:
    """Return whether a property matches: by its name in `verify`, or by its name in the model."""
    return verified == name or re.match(rf"property {re.escape(name)}(?!\w)", verified) is not None


def _steps(simulation: Simulation, trace: Sequence[TraceStep]) -> list[ScriptStep]:
    inputs = {event: simulation.data.inputs(event, {}) for event in {step.event for step in trace}}
    return [
        ScriptStep(number, step.event, simulation.data.shape(step.event, {**inputs[step.event], **step.inputs}))
        for number, step in enumerate(trace, 1)
    ]
