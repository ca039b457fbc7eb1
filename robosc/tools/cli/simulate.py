"""Command `robosc simulate`."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from random import Random
from typing import TYPE_CHECKING, Any

import click

from robosc.analysis.wording import describe_event
from robosc.base.files import reading as files
from robosc.engine import Settings
from robosc.language.text import decode
from robosc.model.semantics.roles import event_name
from robosc.run.simulation import LoopSimulation, Simulation, read_script, unfit_data
from robosc.run.simulation.script import RULE
from robosc.run.simulation.session import Session, trace_line
from robosc.tools.cli import put, say
from robosc.tools.cli.options import FILE, Paths, model, paths, synthesizer
from robosc.tools.cli.parameters import parameters, set_parameters
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models


@click.command("simulate")
@model
@click.option(
    "--script", type=click.Path(allow_dash=True), help="Play the script FILE (-: standard input); print JSON Lines."
)
@click.option("--loop", is_flag=True, help="Run the control loop: lines are incoming events, `tick`, `begin`, `end`.")
@click.option("--random", "number", type=click.IntRange(0), metavar="N", help="Perform N random events; print them.")
@click.option("--seed", type=int, default=0, show_default=True, help="The seed of random numbers.")
@click.option(
    "--config",
    "chosen",
    type=FILE,
    help="With --loop: the configuration file.  [default: controller-config.json near the model]",
)
@parameters
@synthesizer
@paths
def command(
    model: str,
    script: str | None,
    loop: bool,
    number: int | None,
    seed: int,
    chosen: str | None,
    parameter_texts: Sequence[str],
    paths: Paths,
) -> None:
    """Simulate a supervised robot: step by step by hand, by a script, or at random.

    MODEL is a .rscd file with a robot, a .cif or .wmod file, or an .xmi file written by `transform --to xmi`. Without
    --script and --random, the command reads commands from the terminal; `h` lists them. A line of a script is an event
    with its data, a step of a scenario such as `error from lift because timeout`, or a line of an event log. Only the
    events in the script happen, unless --loop runs the control loop between the lines.

    \b
    Examples:
      robosc simulate line_follower.rscd
      robosc simulate line_follower.rscd --random 20 --seed 7 > trace.jsonl
      robosc simulate line_follower.rscd --script trace.jsonl
      echo 'message_scan.u_response {"value": "clear"}' | robosc simulate line_follower.rscd --script -

    Exit status: 0 success, 1 errors in the model or script, 2 a wrong call, 3 no supervisor exists.
    """
    if sum((script is not None, number is not None)) > 1:
        raise click.UsageError("--script and --random exclude each other")
    if loop and script is None:
        raise click.UsageError("--loop needs a --script")
    with Report(aside=True) as report:
        models = read_models(model, paths, report, cif=not loop)
        set_parameters(models.rosgraph, parameter_texts)
        settings = loop_settings(read_configuration(model, chosen, report)) if loop else None
        supervise_models(models, report)
        if script is not None:
            name = "<stdin>" if script == "-" else script
            content = files.read_stdin(name) if script == "-" else files.read(script)
            answers = play(models, name, content, settings, report)
        else:
            simulation = Simulation(models.sct, models.rosgraph, models.ros_types)
    if script is not None:
        for answer in answers:
            put(json.dumps(answer))
        return
    if number is not None:
        _run(simulation, number, seed)
    else:
        _converse(simulation, seed)


def loop_settings(configuration: Configuration) -> Settings:
    """Return the settings of the control loop in a configuration."""
    loop = configuration.control_loop
    return Settings(loop.events_per_tick, loop.reactions_per_tick, loop.react_immediately)


def play(
    models: Models, name: str, content: bytes, settings: Settings | None, report: Report
) -> Iterator[dict[str, Any]]:
    """Return the answer to each line of a script, which findings call `name`.

    With `settings`, the control loop runs between the lines. Errors in the script go to the report and end it.
    """
    decoded, faults = decode(name, content)
    report.add([replace(fault, rule=RULE) for fault in faults], {name: decoded.content})
    report.stop_on_errors()
    text = decoded.content
    simulation = Simulation(models.sct, models.rosgraph, models.ros_types)
    looped = None if settings is None else LoopSimulation(models.sct, models.rosgraph, settings, models.ros_types)
    if looped is None:
        steps, findings = read_script(name, text, simulation.engine.events, LoopSimulation.OWN, models.sct)
    else:
        steps, findings = read_script(name, text, looped.events, simulation.engine.events, models.sct)
    report.add([*findings, *unfit_data(name, steps, simulation.data)], {name: text})
    report.stop_on_errors()
    if looped is not None:
        return (looped.step(step.event, step.data) for step in steps)
    return (simulation.perform(step.event, step.data).answer() for step in steps)


def _run(simulation: Simulation, number: int, seed: int) -> None:
    random = Random(seed)  # noqa: S311
    for _ in range(number):
        happened = simulation.random_step(random)
        if happened is None:
            return
        put(trace_line(happened))


def _converse(simulation: Simulation, seed: int) -> None:
    named = {event_name(event): describe_event(event) for event in simulation.engine.roles.events}
    session = Session(simulation, seed, named)
    interactive = sys.stdin.isatty()
    if hasattr(sys.stdin, "reconfigure"):
        sys.stdin.reconfigure(errors="replace")
    if interactive:
        say(f"{simulation.engine.model.name}: h for help, q to quit")
    say(session.enabled())
    while not session.ended:
        if interactive:
            say("> ", nl=False)
        line = sys.stdin.readline()
        if not line:
            return
        try:
            answer = session.do(line)
        except (OSError, ValueError) as error:  # no such file, or no valid file name or content
            answer = str(error)
        if answer:
            say(answer)
