"""Command `robosc view`."""

from __future__ import annotations

import secrets
import webbrowser
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from robosc.base.files.writing import write
from robosc.base.recordings import RecordingError, is_recording
from robosc.run.simulation import Simulation
from robosc.run.simulation.sources import PlayError, counterexample_of, recorded_moments, script_steps
from robosc.tools.cli import CallError, put, say
from robosc.tools.cli.audit import Judgment, judge_of, judging, run
from robosc.tools.cli.options import FILE, Paths, over_ros, paths, synthesizer
from robosc.tools.cli.parameters import parameters, set_parameters
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph
    from robosc.run.audit import LogJudge, RecordingJudge
    from robosc.tools.view import Live, Moments, Record, Source


@click.command("view")
@click.argument("models", metavar="MODEL...", nargs=-1, required=True, type=FILE)
@over_ros("Show a running ROS 2 robot.")
@click.option("--node", help="The node to show, such as /robot/line_follower_controller.  [default: its usual name]")
@click.option("--log", type=click.Path(), help="Show an event log, a script, or a recording (bag, MCAP).")
@click.option(
    "--audit",
    "audited",
    type=click.Path(exists=True),
    metavar="RECORDING",
    help="Show the findings of an audit: a bag, an MCAP file, or an event log.",
)
@judging
@click.option(
    "--trace",
    "refuted",
    metavar="PROPERTY",
    help="Show the counterexample of this property of `verify`; `any` selects the first.",
)
@click.option("--seed", type=int, default=0, show_default=True, help="The seed of random events.")
@click.option("--export", "folder", type=click.Path(), help="Write the page to FOLDER. It opens without a server.")
@click.option("--open", "opens", is_flag=True, help="Open a browser.")
@click.option(
    "--port", type=click.IntRange(0, 65535), default=0, help="Listen on this TCP port.  [default: a free port]"
)
@click.option(
    "--address",
    default="127.0.0.1",
    show_default=True,
    help="Listen on this address. Addresses of other machines need a token.",
)
@parameters
@synthesizer
@paths
def command(
    models: Sequence[str],
    live: bool,
    node: str | None,
    log: str | None,
    audited: str | None,
    judgment: Judgment,
    refuted: str | None,
    seed: int,
    folder: str | None,
    opens: bool,
    port: int,
    address: str,
    parameter_texts: Sequence[str],
    paths: Paths,
) -> None:
    """Show the decisions of a supervised robot in a browser: states, commands, and why they are forbidden.

    MODEL is a .rscd file with a robot, a .cif or .wmod file, or an .xmi file written by `transform --to xmi`. By
    default, the robot is simulated: a click performs an event. --log and --trace show a recorded run, and you can
    continue from any moment of it in simulation. --audit marks the commands that the supervisor forbids in a recording.
    --ros2 shows a running robot, from its node's reports on ~/state. With several models, you select one on the page.

    \b
    Examples:
      robosc view line_follower.rscd --open
      robosc view line_follower.rscd --ros2
      robosc view base.rscd arm.rscd --ros2
      robosc view line_follower.rscd --log ~/.ros/log/line_follower-events.jsonl
      robosc view line_follower.rscd --log rosbag2_2026_11_24-10_20_30
      robosc view line_follower.rscd --audit rosbag2_2026_11_24-10_20_30
      robosc view line_follower.rscd --trace never-collides
      robosc view line_follower.rscd --log events.jsonl --export page

    Exit status: 0 success, 1 errors in the model or log, 2 a wrong call, 3 no supervisor exists.
    """
    _check_sources(models, live, node, log, audited, judgment, refuted, folder)
    try:
        from robosc.tools import view
    except ModuleNotFoundError as error:
        raise CallError(f"{error.name} is missing: run `pip install 'robosc[view]'`") from error
    shown: list[tuple[Mapping[str, Any], Moments]] = []
    heard: list[tuple[list[str], Live]] = []
    for model in models:
        with Report(aside=True) as report:
            robot = read_models(model, paths, report, cif=True)
            set_parameters(robot.rosgraph, parameter_texts)
            settings = read_configuration(model, None, report)
            supervise_models(robot, report)
            simulation = Simulation(robot.sct, robot.rosgraph, robot.ros_types)
            if audited is not None:
                source = view.Source(f"Audit of {audited}")
                judged = partial(judge_of, robot, settings, audited, judgment)
                record: Moments = _audited(simulation, robot.rosgraph, judged)
            elif not live:
                record, source = _record(simulation, robot.rosgraph, log, node, refuted, seed, report)
            else:
                if robot.rosgraph is None:
                    raise CallError(
                        f"{model} has no ROS graph, so no node reports its state: use its .rosgraph.xmi or .rscd"
                    )
                nodes = [node] if node else _nodes(robot.rosgraph, settings)
                source = view.Source(f"Live: {' or '.join(nodes)}")
                record = view.Live(simulation, robot.rosgraph, " or ".join(nodes))
                heard.append((nodes, record))
        shown.append((view.describe(robot, report.texts, report.findings, source), record))
    try:
        if folder is not None:
            ((description, record),) = shown
            write({Path(folder): view.export(description, record.moments)})
            say(f"written: {Path(folder) / 'index.html'}")
        else:
            begin = _listening(heard) if live else None
            _serve(shown, address, port, opens=opens, begin=begin)
    except view.PageError as error:
        raise CallError(str(error)) from None


def _check_sources(
    models: Sequence[str],
    live: bool,
    node: str | None,
    log: str | None,
    audited: str | None,
    judgment: Judgment,
    refuted: str | None,
    folder: str | None,
) -> None:
    """Raise UsageError for options that exclude each other."""
    if sum([live, log is not None, audited is not None, refuted is not None]) > 1:
        raise click.UsageError("--ros2, --log, --audit and --trace exclude each other")
    if audited is None and judgment != Judgment():
        raise click.UsageError("--from-state, --tolerance, --namespace and --remap need --audit")
    if live and folder is not None:
        raise click.UsageError("a running robot cannot be exported: record it, and export the recording with --log")
    if len(models) > 1 and {node, log, audited, refuted, folder} != {None}:
        raise click.UsageError("--node, --log, --audit, --trace and --export are for one model")


def _nodes(graph: rosgraph.RosGraph, settings: Configuration) -> list[str]:
    """Return the default full names of the robot's controller and layer."""
    return list(dict.fromkeys(f"/{name}" for name in (settings.package_name(graph), settings.layer_name(graph))))


def _listening(heard: Sequence[tuple[Sequence[str], Live]]) -> Callable[[], Callable[[], None]]:
    """Return the function that starts listening to the nodes. It returns the function that stops it."""

    def begin() -> Callable[[], None]:
        from robosc.run.runtime.core.node import StartError
        from robosc.run.runtime.subscriptions import listen
        from robosc.tools.view.relay import Relay

        try:
            return listen([(nodes, Relay(live)) for nodes, live in heard]).close
        except StartError as error:
            raise CallError(f"{error}\n  {error.hint}" if error.hint else str(error)) from error

    return begin


def _record(
    simulation: Simulation,
    graph: rosgraph.RosGraph | None,
    log: str | None,
    node: str | None,
    refuted: str | None,
    seed: int,
    report: Report,
) -> tuple[Record, Source]:
    """Return the record to show, and its source. Ends the report if the log has faults."""
    from robosc.tools import view

    try:
        if log is not None and is_recording(log):
            recorded = view.Record(simulation, graph, seed=seed, recorded=recorded_moments(simulation, log, node))
            return recorded, view.Source(f"Recording {log}")
        if log is not None:
            return view.Record(simulation, graph, script_steps(simulation, log), seed), view.Source(
                f"Log or script {log}"
            )
        if refuted is not None:
            example = counterexample_of(simulation, None if refuted == "any" else refuted)
            say(f"{example.property}: {example.explanation}", err=True)
            text = f"Counterexample to {example.property}: {example.explanation}"
            return view.Record(simulation, graph, example.steps, seed), view.Source(text, example.violation)
    except RecordingError as error:
        raise CallError(str(error)) from None
    except PlayError as error:
        if not error.findings:
            raise CallError(str(error)) from None
        report.add(error.findings, error.texts)
        report.stop_on_errors()
    return view.Record(simulation, graph, seed=seed), view.SIMULATION


def _audited(
    simulation: Simulation, graph: rosgraph.RosGraph | None, judged: Callable[..., RecordingJudge | LogJudge]
) -> Moments:
    """Return the moments of an audit. `judged` returns the judge for the function that watches it."""
    from robosc.tools.view.audited import Audited

    moments = Audited(simulation, graph)
    judge = judged(watch=moments.note)
    moments.begin(judge.audit, judge.engine, judge.timers)
    fault = run(judge)
    moments.finish()
    if fault:
        say(f"Error: {fault}", err=True)
    return moments


def _serve(
    shown: Sequence[tuple[Mapping[str, Any], Moments]],
    address: str,
    port: int,
    *,
    opens: bool,
    begin: Callable[[], Callable[[], None]] | None,
) -> None:
    from robosc.tools.view import http_server
    from robosc.tools.view.server import application

    try:
        listening = http_server.listen(address, port)
    except OSError as error:
        raise CallError(f"{address}:{port}: {error.strerror}") from None
    number = listening.getsockname()[1]
    host = f"[{address}]" if ":" in address else address
    is_loopback = host in http_server.LOOPBACK
    token = None if is_loopback else secrets.token_urlsafe(16)
    hosts = {f"{name}:{number}" for name in (*http_server.LOOPBACK, host)}
    seen = http_server.reachable(address)
    path = f"http://{f'[{seen}]' if ':' in seen else seen}:{number}/{'' if token is None else f'?token={token}'}"
    ends: list[Callable[[], None]] = []

    def ready() -> None:
        if begin is not None:
            ends.append(begin())
        put(path)
        if opens:
            webbrowser.open(path)

    try:
        http_server.serve(application(shown, hosts, token), listening, ready)
    finally:
        for end in ends:
            end()
