"""Command `robosc verify`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from time import time_ns
from typing import TYPE_CHECKING

import click
from rich.console import Console
from rich.table import Table
from rich.text import Text

from robosc.analysis.passages import Outcome as Passed
from robosc.analysis.passages import passages
from robosc.analysis.verify import PARTS, Outcome, verify
from robosc.analysis.verify.verdict import TRUSTED, as_json, as_junit, details, summary
from robosc.base.diagnostics import as_junit as as_junit_xml
from robosc.base.diagnostics.visible import visible
from robosc.base.files.writing import refuse, write_file
from robosc.language.configuration.names import configured_names
from robosc.tools.cli import ERRORS_FOUND, CallError, interruption, put, say
from robosc.tools.cli.graph import node_graph, require_nodes
from robosc.tools.cli.options import (
    GRAPH,
    LIVE,
    Paths,
    configuration,
    jobs,
    model,
    paths,
    require_own_synthesis,
    robot_nodes,
    synthesizer,
)
from robosc.tools.cli.progress import note_slow_diagrams, progress
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report
from robosc.tools.cli.tuning import chosen_tuning, tuning
from robosc.tools.workers import completed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.analysis.passages import Passage, Passages
    from robosc.analysis.verify import Verdict
    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.model import sct
    from robosc.synthesis import Tuning

    #: Model, configuration, folders, tuning, and the time that identifies the call.
    _Call = tuple[str, str | None, Paths, Tuning, int]

_STYLES = {
    Outcome.PROVED: "green",
    Outcome.REFUTED: "bold red",
    Outcome.WARNED: "magenta",
    Outcome.SAMPLED: "yellow",
    Outcome.SKIPPED: "yellow",
}
#: Width of the table without a terminal.
_WIDTH = 120


@click.command("verify")
@model
@click.option("--json", "as_object", is_flag=True, help="Print one JSON object.")
@click.option("--junit", type=click.Path(dir_okay=False), help="Also write JUnit XML to FILE.")
@click.option(
    "--guard",
    "source",
    type=GRAPH,
    metavar="FILE|live",
    help="Prove nothing; print the commands that go around the layer in a ROS graph: that of a JSON file (`robosc"
    " graph`), or the running one.",
)
@robot_nodes
@click.option(
    "--except", "exceptions", multiple=True, metavar="NAME", help="Leave this name out of --guard; repeatable."
)
@configuration
@synthesizer
@tuning
@jobs
@paths
def command(
    model: str,
    as_object: bool,
    junit: str | None,
    source: str | None,
    robot: Sequence[str],
    exceptions: Sequence[str],
    jobs: int,
    chosen: str | None,
    paths: Paths,
) -> None:
    """Prove the properties of a supervised robot, or refute them with a shortest trace.

    MODEL is a .rscd file with a robot, a .cif or .wmod file, or an .xmi file written by `transform --to xmi`; the
    supervisor of an .xmi file is used unchanged. The command analyzes the supervised system with its requirements,
    silent events and control loop, and compares it with the generated C and CIF. docs/verify.md explains each property.

    \b
    Examples:
      robosc verify line_follower.rscd
      robosc verify line_follower.rscd --junit verify.xml
      robosc verify out/LineFollower.sct.xmi --json | jq .proved
      robosc verify porter.rscd --guard graph.json --robot /base

    Exit status: 0 no property refuted, 1 refuted, a command around the layer, or errors in the model, 2 a wrong call,
    3 no supervisor exists.
    """
    require_own_synthesis(jobs)
    if source is not None:
        _verify_guard(model, chosen, paths, _GuardCall(source, robot, exceptions, as_object=as_object, junit=junit))
        return
    if robot or exceptions:
        raise click.UsageError("--robot and --except need --guard")
    with Report(aside=True) as report:
        models = read_models(model, paths, report, cif=True)
        settings = read_configuration(model, chosen, report)
        if junit:
            refuse(junit)
        supervise_models(models, report)
        note_slow_diagrams()
        steps = [""]
        with progress(lambda: f"verifying {steps[-1]}; robots with very many states take minutes"):
            verdicts = (
                verify(models, settings, steps.append)
                if jobs == 1
                else _verify_in_processes((model, chosen, paths, chosen_tuning(models.sct), time_ns()), jobs)
            )
        report.add(finding for verdict in verdicts for finding in verdict.findings)
    if junit:
        interruption.check()
        write_file(junit, as_junit(models.sct, verdicts, model))
    if as_object:
        put(as_json(models.sct.name, verdicts), nl=False)
    else:
        _show(models.sct, verdicts)
    if any(verdict.outcome is Outcome.REFUTED for verdict in verdicts):
        raise click.exceptions.Exit(ERRORS_FOUND)


@dataclass(frozen=True)
class _GuardCall:
    """The call of `--guard`: the graph, patterns of the robot's nodes and of names to leave out, and the output."""

    source: str
    robot: Sequence[str]
    exceptions: Sequence[str]
    as_object: bool
    junit: str | None


def _verify_guard(model: str, chosen: str | None, paths: Paths, call: _GuardCall) -> None:
    """Print the passages to the robot in a graph. Exits with 1 if a command goes around the layer."""
    with Report(aside=True) as report:
        models = read_models(model, paths, report)
        if models.rosgraph is None:
            raise CallError(f"{model} has no ROS graph: use its .rosgraph.xmi or .rscd")
        settings = read_configuration(model, chosen, report)
        if call.junit:
            refuse(call.junit)
        if call.source != LIVE:
            report.may_quote(call.source)
        nodes = node_graph(call.source)
    require_nodes(nodes, call.robot)
    layer = settings.layer_name(models.rosgraph)
    with configured_names(models.rosgraph, settings):
        ways = passages(models.rosgraph, nodes, layer, call.robot, call.exceptions)
    if call.junit:
        write_file(call.junit, as_junit_xml.render("robosc verify --guard", _guard_cases(models.sct.name, ways, model)))
    if call.as_object:
        put(ways.as_json(models.sct.name), nl=False)
    else:
        _show_passages(models.sct.name, layer, ways)
    if not ways.is_complete:
        raise click.exceptions.Exit(ERRORS_FOUND)


def _guard_cases(robot: str, ways: Passages, file: str) -> list[as_junit_xml.TestCase]:
    return [
        as_junit_xml.TestCase(
            robot,
            f"{passage.kind} {passage.name}",
            file,
            0.0,
            failure=as_junit_xml.Failure(passage.evidence, passage.outcome.value, "") if passage.is_open else None,
            output=f"{passage.outcome.value}: {passage.evidence}",
        )
        for passage in ways.passages
    ]


def _show_passages(robot: str, layer: str, ways: Passages) -> None:
    rows = [
        (f"{passage.kind} {passage.name}", (passage.outcome.value, _style(passage)), passage.evidence)
        for passage in ways.passages
    ]
    table = Table()
    for heading in ("to the robot", "verdict", "nodes"):
        table.add_column(heading)
    for name, outcome, evidence in rows:
        table.add_row(Text(visible(name)), Text(*outcome), Text(visible(evidence)))
    _console().print(table)
    if not ways.layers:
        say(f"\nthe graph has no node {layer}: start the layer, or no command passes it")
    around = sum(passage.is_open for passage in ways.passages)
    passing = sum(passage.outcome is Passed.PASSES for passage in ways.passages)
    say(f"\n{robot}: {around} around the layer, {passing} through it")


def _style(passage: Passage) -> str:
    if passage.is_open:
        return _STYLES[Outcome.REFUTED]
    return _STYLES[Outcome.PROVED if passage.outcome is Passed.PASSES else Outcome.SKIPPED]


def _verify_in_processes(call: _Call, jobs: int) -> list[Verdict]:
    """Return the verdicts on a model without errors. Each process reads and synthesizes it again."""
    parts: dict[str, list[Verdict]] = {}
    tasks = [(*call, name) for name in PARTS]
    for (*_, name), verdicts in completed(_part, tasks, min(jobs, len(tasks))):
        if verdicts is None:
            raise CallError(f"the process that verified {name} was killed; use fewer --jobs if memory is short")
        parts[name] = verdicts
    return [verdict for name in PARTS for verdict in parts[name]]


def _part(task: tuple[str, str | None, Paths, Tuning, int, str]) -> list[Verdict]:
    *supervised, name = task
    return PARTS[name](*_supervised(*supervised))


@lru_cache(maxsize=1)
def _supervised(
    model: str, chosen: str | None, paths: Paths, tuning: Tuning, _began: int
) -> tuple[Models, Configuration]:
    """Return a model and its configuration, once in each process of a call, which `_began` identifies."""
    with Report("none") as report:
        models = read_models(model, paths, report, cif=True)
        settings = read_configuration(model, chosen, report)
        supervise_models(models, report, tuning=tuning)
    return models, settings


def _show(model: sct.SupervisoryControlModel, verdicts: Sequence[Verdict]) -> None:
    table = Table()
    for heading in ("property", "verdict", "evidence"):
        table.add_column(heading)
    table.add_column("seconds", justify="right")
    for verdict in verdicts:
        outcome = Text(verdict.outcome.value, _STYLES[verdict.outcome])
        table.add_row(Text(verdict.property), outcome, Text(visible(verdict.evidence)), f"{verdict.seconds:.3f}")
    _console().print(table)
    for verdict in verdicts:
        text = details(verdict, model)
        if text:
            say(f"\n{text}")
    say(f"\n{TRUSTED}\n\n{model.name}: {summary(verdicts)}")


def _console() -> Console:
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = _WIDTH
    return console
