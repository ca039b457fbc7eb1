"""Collects the report as plain data that is the same on every run."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from robosc.analysis.verify.properties import requirement_identifier, requirement_name
from robosc.analysis.wording import words
from robosc.base.diagnostics import has_errors
from robosc.m2t.targets import TARGETS, together
from robosc.model import sct
from robosc.model.places import place
from robosc.model.semantics.durations import timer_text
from robosc.model.semantics.printing import RobotPrinter
from robosc.model.semantics.roles import assumption_text, assumptions, event_name, plant_of
from robosc.model.semantics.walks import copy_tree
from robosc.run.node_tests.trace_test import trace_test_of
from robosc.run.report import digests, printing
from robosc.run.report.trace_coverage import play

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.analysis.verify import Verdict
    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.model import rosgraph
    from robosc.run.report.trace_coverage import TraceCoverage

#: First paragraph of the report.
NOTICE = (
    "This is not a safety certificate, and the controller is not a safety-rated one: it is ordinary software on "
    "ordinary hardware. Functions that people's safety depends on belong in safety-rated parts of the robot."
)
#: Targets that are generated for the report; without ROS in the model, those that do not need it.
_TARGETS = ("supervisor", "cif", "ros1", "ros2")


def report(  # noqa: PLR0913 - the inputs of a report
    models: Models,
    configuration: Configuration,
    verdicts: Sequence[Verdict],
    *,
    texts: Mapping[str, str | bytes],
    version: str,
    interface_paths: Sequence[str] = (),
) -> dict[str, Any]:
    """Return the report on a model with its supervisor and the verdicts of `verify`.

    `texts` are the files of the model by path, `version` is the version of the tool. ROS types are also looked up in
    `interface_paths`. All targets are generated again in memory, with tests. A target whose precondition fails is
    omitted, and the report states it. Raises the same exceptions as `verify`.
    """
    outputs, refused, missed = _generated(models, configuration, interface_paths)
    traces = {path: text for path, text in outputs.items() if path.endswith(".jsonl")}
    # Packages for both ROS versions have the same traces.
    different = {text: path for path, text in reversed(traces.items())}
    shown = play(models, {path: text for path, text in traces.items() if different[text] == path})
    model = models.sct
    statements = [*model.requirements, *model.invariants, *model.reachabilityRequirements, *model.properties]
    return {
        "notice": NOTICE,
        "robot": model.name,
        "requirements": _requirements(model, statements, verdicts, shown, printing.Sources(outputs)),
        "verdicts": [
            {
                "property": verdict.property,
                "outcome": verdict.outcome.value,
                "evidence": verdict.evidence,
                "explanation": verdict.explanation or None,
                "requirement": verdict.requirement or None,
            }
            for verdict in verdicts
        ],
        "assumptions": _assumptions(models, configuration),
        "coverage": {
            "traces": sorted(different.values()),
            "missed": missed,
            **shown.coverage(model, models.engine),
        },
        "digests": {
            "tool": {"name": "robosc", "version": version, "sha256": digests.of_tool()},
            "model": digests.of_files(texts),
            "outputs": digests.of_files(outputs),
            "refused": refused,
        },
    }


def _generated(
    models: Models, configuration: Configuration, interface_paths: Sequence[str]
) -> tuple[dict[str, str], list[dict[str, str]], list[str]]:
    """Return generated texts by path, the targets that were refused with the reason, and the gaps of the tests."""
    missed: dict[str, None] = {}
    files: dict[str, str] = {}
    refused = []
    with together():
        for target in (TARGETS[name] for name in _TARGETS):
            if target.needs_graph and models.rosgraph is None:
                continue
            findings = target.findings(models, configuration)
            if has_errors(findings):
                refused.append({"target": target.name, "reason": findings[0].message})
                continue
            tests = trace_test_of(target, models, configuration, interface_paths)
            missed |= dict.fromkeys(tests.missed if tests else ())
            texts = target.files(models, configuration, tests=tests)
            folder = target.folder(models, configuration)
            files |= {f"{folder}/{path}" if folder else path: text for path, text in texts.items()}
    return files, refused, list(missed)


def _requirements(
    model: sct.SupervisoryControlModel,
    statements: Sequence[sct.StatedRequirement],
    verdicts: Sequence[Verdict],
    shown: TraceCoverage,
    sources: printing.Sources,
) -> list[dict[str, Any]]:
    """Return one entry for each requirement and property of the text.

    An entry can combine several requirements of the model.
    """
    guards = {guard.event: guard for guard in model.supervisor.guards} if model.supervisor else {}
    grouped: dict[str, list[sct.StatedRequirement]] = {}
    for requirement in statements:
        grouped.setdefault(requirement_identifier(requirement), []).append(requirement)
    by_property = {verdict.property: verdict.outcome.value for verdict in verdicts}
    entries = []
    for name, parts in grouped.items():
        file, span = place(parts[0])
        generated: dict[str, set[int]] = {}
        for part in parts:
            for path, lines in sources.places(part).items():
                generated.setdefault(path, set()).update(lines)
        about = [verdict for verdict in verdicts if verdict.requirement == name]
        entries.append(
            {
                "name": name,
                "kind": _kind(parts[0]),
                "texts": list(dict.fromkeys(part.text or requirement_name(part) for part in parts)),
                "file": PurePath(file).name,
                "line": span.line,
                "events": [
                    {**_guarded(part, guards, shown), "verdict": by_property.get(requirement_name(part))}
                    for part in parts
                    if isinstance(part, sct.Requirement)
                ],
                "verdicts": [{"property": verdict.property, "outcome": verdict.outcome.value} for verdict in about],
                "generated": [{"path": path, "lines": sorted(generated[path])} for path in sorted(generated)],
            }
        )
    return entries


def _kind(statement: sct.StatedRequirement) -> str:
    match statement:
        case sct.Requirement():
            return "requirement"
        case sct.StateInvariant() | sct.ReachabilityRequirement():
            return "state requirement"
    return "property"


def _guarded(
    requirement: sct.Requirement, guards: Mapping[sct.Event, sct.EventGuard], shown: TraceCoverage
) -> dict[str, Any]:
    """Return the condition on a requirement's event, the guard that synthesis added, and the results of the tests."""
    guard = guards.get(requirement.event)
    added = None if guard is None or guard.synthesis is None else RobotPrinter()(copy_tree(guard.synthesis))
    seen = {}
    for word, where in (("allowed", shown.allowed), ("forbidden", shown.forbidden)):
        path, line = where.get(requirement, ("", 0))
        seen[word] = {"path": path, "line": line} if path else None
    return {
        "event": event_name(requirement.event),
        "meaning": words(requirement.event),
        "condition": f"{requirement.kind.name} {RobotPrinter()(copy_tree(requirement.condition))}",
        "added_by_synthesis": added,
        "why": (guard.explanation or None) if guard and added else None,
        "tests": seen,
    }


def _assumptions(models: Models, configuration: Configuration) -> dict[str, Any]:
    model, graph = models.sct, models.rosgraph
    events = [event for plant in model.plants for event in plant.events]
    overridden = _overridden(model, graph, configuration.on_shutdown)
    return {
        "uncontrollable": [event_name(event) for event in events if not event.controllable],
        "timeouts": [
            {"event": event_name(event), "time": timer_text(event.timer)} for event in events if event.timer is not None
        ],
        "marked": [
            {
                "plant": plant.origin or plant.name,
                "states": [location.name for location in plant.locations if location.marked],
            }
            for plant in model.plants
            if len(plant.locations) > 1 and plant.kind != sct.PlantKind.data
        ],
        "stated": [{"text": assumption_text(plant), "line": place(plant)[1].line} for plant in assumptions(model)],
        "on_violation": configuration.on_violation,
        "watchdogs": [
            {"topic": topic, "milliseconds": milliseconds}
            for topic, milliseconds in sorted(configuration.watchdog_ms.items())
        ],
        "watchdog_stops": configuration.watchdog_stops,
        "on_shutdown": list(configuration.on_shutdown),
        "overridden": overridden,
        "deadlines_ms": {
            "period": configuration.control_loop.period_ms,
            "service": configuration.services.timeout_ms,
            "action": configuration.actions.timeout_ms,
            "retry": configuration.retry_ms,
        },
    }


def _overridden(
    model: sct.SupervisoryControlModel, graph: rosgraph.RosGraph | None, messages: Sequence[str]
) -> list[str]:
    """Return the requirements that do not apply to the messages sent on shutdown."""
    if graph is None:
        return []
    named = {*messages}
    return [
        requirement_identifier(requirement)
        for requirement in model.requirements
        if plant_of(requirement.event).name.removeprefix("message_") in named
        or (plant_of(requirement.event).origin or "").rpartition(".")[2] in named
    ]
