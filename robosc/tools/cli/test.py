"""Command `robosc test`."""

from __future__ import annotations

import shlex
import sys
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

import robosc
from robosc.analysis.verify.c_program import CProgram, c_compiler
from robosc.base.diagnostics import Severity, as_junit, as_text
from robosc.base.files.writing import refuse, temporary_folder, write, write_file
from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
from robosc.language.configuration import FILE_NAME
from robosc.language.reading import read as read_text
from robosc.language.text import Documents, decode
from robosc.m2t.models import Models, TraceTest
from robosc.m2t.targets import TARGETS
from robosc.model.semantics.instances import Instances
from robosc.run.node_tests.trace_test import player_files
from robosc.run.scenario_tests import RULE, LiveError, LiveNode, Player, read_scenarios, unfit_data, unknown_events
from robosc.run.scenario_tests.conditions import add_conditions
from robosc.run.scenario_tests.operations import Operations
from robosc.tools.cli import CallError, say
from robosc.tools.cli.file_watch import watch as watch_files
from robosc.tools.cli.options import (
    FILE,
    Paths,
    chosen_synthesizer,
    configuration,
    findings_format,
    jobs,
    model,
    over_ros,
    paths,
    require_own_synthesis,
    synthesizer,
)
from robosc.tools.cli.progress import progress
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report
from robosc.tools.workers import completed

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.configuration import Configuration
    from robosc.model import expression as ex
    from robosc.model import robosc as rsc
    from robosc.run.scenario_tests import Scenario
    from robosc.run.scenario_tests.reading import Holds


@click.command("test")
@model
@click.argument("scenarios", nargs=-1, required=True, type=FILE, metavar="FILE...")
@click.option(
    "--engine",
    type=click.Choice(["python", "c"]),
    default="python",
    show_default=True,
    help="The control loop that plays.",
)
@over_ros("Also play with a ROS 2 node.")
@click.option(
    "--node",
    metavar="COMMAND",
    help="With --ros2: the command that starts the node, such as a compiled one.  [default: `robosc run`]",
)
@click.option("--traces", type=click.Path(file_okay=False), help="Also write the event log of each scenario to FOLDER.")
@click.option("--junit", type=click.Path(dir_okay=False), help="Also write JUnit XML to FILE.")
@jobs
@click.option("--watch", is_flag=True, help="Test again after each change of a file, until Ctrl-C.")
@configuration
@findings_format
@synthesizer
@paths
def command(watch: bool, **options: Any) -> None:
    """Run scenario tests: events from the robot, and the expected reactions of its controller.

    MODEL is a .rscd file with a robot. docs/scenarios.md describes the format of a FILE. The robot's controller in
    Python runs the scenarios. `--engine c` also compares its control loop with the compiled control loop of the
    generated C in every step. `--ros2` also starts a node for each scenario, in simulated time, which must show the
    same events with the same data. Nothing else may use these topics, in particular no robot.

    \b
    Examples:
      robosc test line_follower.rscd line_follower.scenarios
      robosc test line_follower.rscd line_follower.scenarios --watch
      robosc test line_follower.rscd *.scenarios --engine c
      robosc test line_follower.rscd *.scenarios --junit scenarios.xml
      robosc test line_follower.rscd *.scenarios --ros2
      robosc test porter.rscd *.scenarios --ros2 --node "ros2 run porter_controller porter_controller"
      robosc test line_follower.rscd line_follower.scenarios --traces ros2/line_follower_controller/test/traces

    Exit status: 0 all scenarios passed, 1 a scenario failed, or errors, 2 a wrong call, 3 no supervisor exists.
    """
    call = Call(**options)
    if not call.model.endswith(".rscd"):
        raise CallError(f"{call.model} is not a text file: scenarios need a robot in a .rscd file")
    if call.node is not None and not call.live:
        raise click.UsageError("--node needs --ros2")
    require_own_synthesis(call.jobs)
    if call.live and call.jobs > 1:
        raise click.UsageError("--ros2 plays one scenario at a time: remove it or --jobs")
    if watch:
        settings = call.chosen or str(Path(call.model).with_name(FILE_NAME))
        watch_files("testing", partial(_test, call), [call.model], [*call.scenarios, settings], call.paths)
    _test(call)


@dataclass(frozen=True)
class Call:
    """Arguments and options of a call."""

    model: str
    scenarios: Sequence[str]
    engine: str = "python"
    live: bool = False
    node: str | None = None
    traces: str | None = None
    junit: str | None = None
    chosen: str | None = None
    form: str = "text"
    paths: Paths = field(default_factory=Paths)
    jobs: int = 1
    #: Texts that replace the model or the scenarios.
    documents: Documents = field(default_factory=Documents)


@dataclass
class Run:
    """Run of a scenario: the calls of its control loop, its event log, its seconds, and its findings."""

    scenario: Scenario
    operations: Operations
    log: str
    seconds: float
    findings: list[Diagnostic]


def _test(call: Call) -> None:
    """Play all scenarios once, and print their results after the findings."""
    runs: list[Run] = []
    began = perf_counter()
    try:
        with Report(call.form, aside=call.form != "text") as report:
            play_all(call, report, runs)
    except click.exceptions.Exit:
        _show_results(runs, perf_counter() - began)
        raise
    _show_results(runs, perf_counter() - began)


def play_all(call: Call, report: Report, runs: list[Run]) -> None:
    """Add the runs of all scenarios to the list, and their findings to the report."""
    if call.junit:
        refuse(call.junit)
    models, settings, player, scenarios = _prepare(call, report)
    live: LiveNode | None = None
    if call.live:
        report.add(TARGETS["ros2"].findings(models, settings))
        report.stop_on_errors()
        live = _live(models, settings, player, call.node)
    with progress(lambda: f"playing scenario {len(runs) + 1} of {len(scenarios)}"):
        if call.jobs > 1:
            runs.extend(_play_in_processes(replace(call, form="none"), len(scenarios)))
        else:
            runs.extend(_play(scenario, player, live) for scenario in scenarios)
            if call.engine == "c":
                _compare(models, settings, runs)
    for run in runs:
        report.add(run.findings)
    if call.traces is not None:
        write({Path(call.traces): {f"scenario_{number}.jsonl": run.log for number, run in enumerate(runs, 1)}})
    if call.junit:
        write_file(call.junit, _junit(runs, report.texts))


def _prepare(call: Call, report: Report) -> tuple[Models, Configuration, Player, list[Scenario]]:
    """Return the supervised models of a call, their configuration, a player, and the scenarios, all without errors."""
    models, expressions, scenarios = _read(call, report)
    settings = read_configuration(call.model, call.chosen, report)
    report.stop_on_errors()
    supervise_models(models, report)
    report.stop_on_errors()
    assert models.rosgraph is not None
    types = RosTypes(call.paths.interfaces)
    report.add(unfit_data(models.rosgraph, types, scenarios))
    report.stop_on_errors()
    return models, settings, Player(models.rosgraph, settings, types.distribution(2), expressions), scenarios


def _play_in_processes(call: Call, number: int) -> list[Run]:
    """Return the runs of a number of scenarios in their order. Each process reads the model, and plays its share."""
    shares = [(call, first) for first in range(min(call.jobs, number))]
    runs: dict[int, Run] = {}
    for _, played in completed(_play_share, shares, max(len(shares), 1)):
        if played is None:
            raise CallError("a process that played scenarios was killed; use fewer --jobs if memory is short")
        runs |= played
    return [runs[scenario] for scenario in sorted(runs)]


def _play_share(share: tuple[Call, int]) -> dict[int, Run]:
    call, first = share
    with Report(call.form) as report:
        models, settings, player, scenarios = _prepare(call, report)
    runs = {place: _play(scenarios[place], player, None) for place in range(first, len(scenarios), call.jobs)}
    if call.engine == "c":
        _compare(models, settings, list(runs.values()))
    return {place: replace(run, operations=Operations()) for place, run in runs.items()}


def _play(scenario: Scenario, player: Player, live: LiveNode | None) -> Run:
    began = perf_counter()
    operations = Operations()
    findings = player.play(scenario, operations)
    if live is not None and not findings:
        findings = _followed(live, scenario, player)
    log = "".join(f"{line}\n" for line in player.trace)
    return Run(scenario, operations, log, perf_counter() - began, findings)


def _show_results(runs: Sequence[Run], seconds: float) -> None:
    """Print the failed scenarios, and how many failed and passed."""
    if not runs:
        return
    failed = [run.scenario for run in runs if run.findings]
    for scenario in failed:
        say(f'FAILED {scenario.line.file}:{scenario.line.span.line} "{scenario.name}"', err=True)
    counts = {"failed": len(failed), "passed": len(runs) - len(failed)}
    say(f"{', '.join(f'{count} {word}' for word, count in counts.items() if count)} in {seconds:.2f} s", err=True)


def _junit(runs: Sequence[Run], texts: Mapping[str, str]) -> str:
    """Return JUnit XML: a suite for each file, and a test case for each scenario."""
    cases = []
    for run in runs:
        line = run.scenario.line
        details = as_text.render(run.findings, texts, as_text.plain)
        failure = as_junit.Failure(run.findings[0].message, "failed", details) if run.findings else None
        name = run.scenario.name
        cases.append(as_junit.TestCase(line.file, name, line.file, run.seconds, line.span.line, failure))
    return as_junit.render("robosc test", cases)


def as_objects(runs: Iterable[Run]) -> list[dict[str, Any]]:
    """Return the result of each scenario: its place, its name, and whether it passed."""
    return [
        {
            "file": run.scenario.line.file,
            "line": run.scenario.line.span.line,
            "name": run.scenario.name,
            "passed": not run.findings,
        }
        for run in runs
    ]


def _read(call: Call, report: Report) -> tuple[Models, Mapping[Holds, ex.Expression], list[Scenario]]:
    """Return the models of a robot, its scenarios, and the expressions of their conditions. Errors go to the report."""
    plain = read_models(call.model, call.paths, report, documents=call.documents)
    scenarios: list[Scenario] = []
    conditions: list[Holds] = []
    for name in call.scenarios:
        text, faults = decode(name, call.documents.read(Path(name)))
        more_scenarios, expected, findings = read_scenarios(name, text.content)
        report.add([*(replace(fault, rule=RULE) for fault in faults), *findings], {name: text.content})
        scenarios += more_scenarios
        conditions += expected
    report.add(unknown_events(plain.sct, scenarios))
    return (*_resolve_conditions(call, plain, conditions, report), scenarios)


def _resolve_conditions(
    call: Call, plain: Models, conditions: Sequence[Holds], report: Report
) -> tuple[Models, Mapping[Holds, ex.Expression]]:
    """Return models with which the conditions can be evaluated, and their expressions in these models."""
    if not conditions:
        return plain, {}
    text, _ = decode(call.model, call.documents.read(Path(call.model)))
    assert plain.robosc is not None
    span = plain.robosc.source.span  # type: ignore[union-attr]  # a model from a text has a place
    end = text.offset(span.end_line, span.end_column)
    longer = add_conditions(text.content, end, conditions, Instances(plain.robosc).fleet_texts)
    types = RosTypes(call.paths.interfaces)
    reading = read_text(call.model, call.paths.libraries, types, Documents({call.model: longer.text}))
    findings = [*reading.findings, *(check(reading.base, reading.findings, types) if reading.base else ())]
    report.add(longer.move_to_scenario(finding) for finding in findings if finding.severity is Severity.ERROR)
    report.stop_on_errors()
    robot: rsc.Robot = reading.base  # type: ignore[assignment]  # equal except for the properties
    model = robosc.to_sct(robot)
    meant = dict(zip(conditions, longer.expressions(model), strict=True))
    return Models(model, robosc.to_rosgraph(robot, call.paths.interfaces), robot), meant


def _live(models: Models, settings: Configuration, player: Player, node: str | None) -> LiveNode:
    """Return the node that runs scenarios: by the given command, else `robosc run` of the model."""
    assert models.rosgraph is not None
    files = player_files(models.rosgraph, settings, player.parameters, player.incoming)
    generated = TARGETS["ros2"].files(models, settings, TraceTest(player.parameters, files, "", ()))
    tests = {name.removeprefix("test/"): text for name, text in generated.items() if name.startswith("test/")}
    return LiveNode(_command() if node is None else shlex.split(node), player.parameters, tests)


def _command() -> list[str]:
    """Return the command that runs the model as a node, with the search folders and configuration of this call."""
    params = click.get_current_context().params
    options = [word for folder in params["library_paths"] for word in ("-I", folder)]
    options += [word for folder in params["interface_paths"] for word in ("--interface-path", folder)]
    options += ["--config", params["chosen"]] if params["chosen"] else []
    synthesizer = chosen_synthesizer()
    options += ["--synthesizer", synthesizer.name] if synthesizer else []
    return [sys.executable, "-m", "robosc", "run", params["model"], "--ros2", *options]


def _followed(live: LiveNode, scenario: Scenario, player: Player) -> list[Diagnostic]:
    """Return the node's deviation from the scenario. Raises CallError if there is no node."""
    try:
        difference = live.follow(scenario, player.trace, player.sources)
    except LiveError as error:
        raise CallError(str(error)) from error
    return [] if difference is None else [difference]


def _compare(models: Models, settings: Configuration, runs: Sequence[Run]) -> None:
    """Add the deviations of the generated control loop to the runs. Raises CallError if it cannot be compiled here."""
    compiler = c_compiler()
    if compiler is None:
        raise CallError("no C compiler found to play scenarios with")
    generated = robosc.generate("supervisor", models, settings)
    with temporary_folder() as folder:
        program = CProgram(models.sct, folder, compiler, generated)
        for run in runs:
            difference = run.operations.compare(program)
            run.findings += [difference] if difference is not None else []
