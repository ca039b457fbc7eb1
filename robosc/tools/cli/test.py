"""Command `robosc test`."""

from __future__ import annotations

import shlex
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

import robosc
from robosc.analysis.verify.c_program import CProgram, c_compiler
from robosc.base.diagnostics import Severity
from robosc.base.files import reading as files
from robosc.base.files.writing import temporary_folder, write
from robosc.base.ros_types import RosTypes
from robosc.language.checks import check
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
from robosc.tools.cli.options import (
    FILE,
    Paths,
    chosen_synthesizer,
    configuration,
    findings_format,
    model,
    over_ros,
    paths,
    synthesizer,
)
from robosc.tools.cli.progress import progress
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

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
@configuration
@findings_format
@synthesizer
@paths
def command(
    model: str,
    scenarios: Sequence[str],
    engine: str,
    live: bool,
    node: str | None,
    traces: str | None,
    chosen: str | None,
    form: str,
    paths: Paths,
) -> None:
    """Run scenario tests: events from the robot, and the expected reactions of its controller.

    MODEL is a .rscd file with a robot. docs/scenarios.md describes the format of a FILE. The robot's controller in
    Python runs the scenarios. `--engine c` also compares its control loop with the compiled control loop of the
    generated C in every step. `--ros2` also starts a node for each scenario, in simulated time, which must show the
    same events with the same data. Nothing else may use these topics, in particular no robot.

    \b
    Examples:
      robosc test line_follower.rscd line_follower.scenarios
      robosc test line_follower.rscd *.scenarios --engine c
      robosc test line_follower.rscd *.scenarios --ros2
      robosc test porter.rscd *.scenarios --ros2 --node "ros2 run porter_controller porter_controller"
      robosc test line_follower.rscd line_follower.scenarios --traces ros2/line_follower_controller/test/traces

    Exit status: 0 all scenarios passed, 1 a scenario failed, or errors, 2 a wrong call, 3 no supervisor exists.
    """
    if not model.endswith(".rscd"):
        raise CallError(f"{model} is not a text file: scenarios need a robot in a .rscd file")
    if node is not None and not live:
        raise click.UsageError("--node needs --ros2")
    with Report(form, aside=form != "text") as report:
        models, expressions, played = _read(model, scenarios, paths, report)
        settings = read_configuration(model, chosen, report)
        report.stop_on_errors()
        supervise_models(models, report)
        report.stop_on_errors()
        assert models.rosgraph is not None
        types = RosTypes(paths.interfaces)
        report.add(unfit_data(models.rosgraph, types, played))
        report.stop_on_errors()
        distribution = types.distribution(2)
        player = Player(models.rosgraph, settings, distribution, expressions)
        started: LiveNode | None = None
        if live:
            report.add(TARGETS["ros2"].findings(models, settings))
            report.stop_on_errors()
            started = _live(models, settings, player, node)
        logs: dict[str, str] = {}
        with progress("playing"):
            failed = 0
            runs = []
            for number, scenario in enumerate(played, 1):
                operations = Operations()
                deviations = player.play(scenario, operations)
                if started is not None and not deviations:
                    deviations = _followed(started, scenario, player)
                runs.append(operations)
                failed += bool(deviations)
                report.add(deviations)
                logs[f"scenario_{number}.jsonl"] = "".join(f"{line}\n" for line in player.trace)
            if engine == "c":
                report.add(_compared(models, settings, runs))
        if traces is not None:
            write({Path(traces): logs})
        say(f"{len(played)} scenario{'s' * (len(played) != 1)}, {failed} failed", err=True)


def _read(
    path: str, names: Sequence[str], paths: Paths, report: Report
) -> tuple[Models, Mapping[Holds, ex.Expression], list[Scenario]]:
    """Return the models of a robot, its scenarios, and the expressions of their conditions. Errors go to the report."""
    plain = read_models(path, paths, report)
    scenarios: list[Scenario] = []
    conditions: list[Holds] = []
    for name in names:
        text, faults = decode(name, files.read(name))
        more_scenarios, expected, findings = read_scenarios(name, text.content)
        report.add([*(replace(fault, rule=RULE) for fault in faults), *findings], {name: text.content})
        scenarios += more_scenarios
        conditions += expected
    report.add(unknown_events(plain.sct, scenarios))
    return (*_resolve_conditions(path, plain, conditions, paths, report), scenarios)


def _resolve_conditions(
    path: str, plain: Models, conditions: Sequence[Holds], paths: Paths, report: Report
) -> tuple[Models, Mapping[Holds, ex.Expression]]:
    """Return models with which the conditions can be evaluated, and their expressions in these models."""
    if not conditions:
        return plain, {}
    text, _ = decode(path, files.read(path))
    assert plain.robosc is not None
    span = plain.robosc.source.span  # type: ignore[union-attr]  # a model from a text has a place
    end = text.offset(span.end_line, span.end_column)
    longer = add_conditions(text.content, end, conditions, Instances(plain.robosc).fleet_texts)
    types = RosTypes(paths.interfaces)
    reading = read_text(path, paths.libraries, types, Documents({path: longer.text}))
    findings = [*reading.findings, *(check(reading.base, reading.findings, types) if reading.base else ())]
    report.add(longer.move_to_scenario(finding) for finding in findings if finding.severity is Severity.ERROR)
    report.stop_on_errors()
    robot: rsc.Robot = reading.base  # type: ignore[assignment]  # equal except for the properties
    model = robosc.to_sct(robot)
    meant = dict(zip(conditions, longer.expressions(model), strict=True))
    return Models(model, robosc.to_rosgraph(robot, paths.interfaces), robot), meant


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


def _compared(models: Models, settings: Configuration, runs: Sequence[Operations]) -> list[Diagnostic]:
    """Return the deviations of the generated control loop. Raises CallError if it cannot be compiled here."""
    compiler = c_compiler()
    if compiler is None:
        raise CallError("no C compiler found to play scenarios with")
    generated = robosc.generate("supervisor", models, settings)
    with temporary_folder() as folder:
        program = CProgram(models.sct, folder, compiler, generated)
        differences = [run.compare(program) for run in runs]
    return [difference for difference in differences if difference is not None]
