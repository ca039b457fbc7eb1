"""`robosc view`."""

from __future__ import annotations

import secrets
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from robosc.cli import CallError, put, say
from robosc.cli.options import Paths, model, paths
from robosc.cli.parameters import parameters, set_parameters
from robosc.cli.reading import read_models, supervise_models
from robosc.cli.report import Report
from robosc.files.writing import write
from robosc.simulation import Simulation
from robosc.simulation.played import PlayError, counterexample_steps, script_steps

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.simulation import Step
    from robosc.view import Record


@click.command("view")
@model
@click.option("--log", type=click.Path(), help="Show an event log or a script.")
@click.option("--trace", "refuted", metavar="PROPERTY", help="Show a counterexample of `verify`; `any`: the first.")
@click.option("--seed", type=int, default=0, show_default=True, help="Of random events.")
@click.option("--export", "folder", type=click.Path(), help="Write the page to FOLDER, to open without a server.")
@click.option("--open", "opens", is_flag=True, help="Open a browser.")
@click.option(
    "--port", type=click.IntRange(0, 65535), default=0, help="Listen on this port; 0, the default: a free one."
)
@click.option("--address", default="127.0.0.1", show_default=True, help="Listen on this address; others need a token.")
@parameters
@paths
def command(
    model: str,
    log: str | None,
    refuted: str | None,
    seed: int,
    folder: str | None,
    opens: bool,
    port: int,
    address: str,
    given: Sequence[str],
    paths: Paths,
) -> None:
    """See a supervised robot decide, in a browser: states, commands, and why they are forbidden.

    MODEL is a .rscd file with a robot, a .cif file, or an .xmi file that `transform --to xmi` wrote. Without --log and
    --trace the robot is simulated: a click lets an event happen. From any moment of a log one goes on in simulation.

    \b
    Examples:
      robosc view line_follower.rscd --open
      robosc view line_follower.rscd --log ~/.ros/log/line_follower-events.jsonl
      robosc view line_follower.rscd --trace never-collides
      robosc view line_follower.rscd --log events.jsonl --export page

    Exit status: 0 done, 1 errors in the model or log, 2 a wrong call, 3 no supervisor exists.
    """
    if log is not None and refuted is not None:
        raise click.UsageError("--log and --trace exclude each other")
    try:
        from robosc import view
        from robosc.view import serving
    except ModuleNotFoundError as error:
        raise CallError(f"{error.name} is missing: `pip install 'robosc[view]'` brings it") from error
    with Report(aside=True) as report:
        models = read_models(model, paths, report, cif=True)
        set_parameters(models.rosgraph, given)
        supervise_models(models, report)
        simulation = Simulation(models.sct, models.rosgraph)
        steps = _steps(simulation, log, refuted, report)
    description = view.describe(models, report.texts)
    record = view.Record(simulation, steps, seed)
    try:
        if folder is not None:
            write({Path(folder): view.export(description, record.moments)})
            say(f"written: {Path(folder) / 'index.html'}")
            return
        _serve(serving, description, record, address, port, opens=opens)
    except view.PageError as error:
        raise CallError(str(error)) from None


def _steps(simulation: Simulation, log: str | None, refuted: str | None, report: Report) -> Sequence[Step] | None:
    """What is played; None where nothing is. Ends the report where the log has faults."""
    try:
        if log is not None:
            return script_steps(simulation, log)
        if refuted is not None:
            steps, said = counterexample_steps(simulation, None if refuted == "any" else refuted)
            say(said, err=True, nl=False)
            return steps
    except PlayError as error:
        if not error.findings:
            raise CallError(str(error)) from None
        report.add(error.findings, error.texts)
        report.stop_on_errors()
    return None


def _serve(
    serving: Any, description: Mapping[str, Any], record: Record, address: str, port: int, *, opens: bool
) -> None:
    from robosc import view

    try:
        listening = serving.listen(address, port)
    except OSError as error:
        raise CallError(f"{address}:{port}: {error.strerror}") from None
    number = listening.getsockname()[1]
    host = f"[{address}]" if ":" in address else address
    is_loopback = host in serving.LOOPBACK
    token = None if is_loopback else secrets.token_urlsafe(16)
    hosts = {f"{name}:{number}" for name in (*serving.LOOPBACK, host)}
    path = f"http://{host}:{number}/{'' if token is None else f'?token={token}'}"

    def ready() -> None:
        put(path)
        if opens:
            webbrowser.open(path)

    serving.serve(view.application(description, record, hosts, token), listening, ready)
