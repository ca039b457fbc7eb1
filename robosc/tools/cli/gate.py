"""Command `robosc gate`."""

from __future__ import annotations

import secrets
from functools import partial
from typing import TYPE_CHECKING

import click

from robosc.base.ros_types import RosTypes
from robosc.m2t.targets import TARGETS
from robosc.run.runtime.core.event_log import EventLog, default_log
from robosc.tools.cli import CallError, put, say
from robosc.tools.cli.options import FILE, Paths, configuration, model, paths, synthesizer
from robosc.tools.cli.parameters import parameters, set_parameters
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report
from robosc.tools.cli.run import run_node

if TYPE_CHECKING:
    import socket
    from collections.abc import Sequence
    from contextlib import AbstractContextManager

    from robosc.language.configuration import Configuration
    from robosc.m2t.models import Models
    from robosc.model import rosgraph
    from robosc.run.runtime.core.gate import GatedLayer
    from robosc.run.runtime.core.node import RunningNode
    from robosc.run.runtime.core.settings import SafeMessages

#: The address of `--http`: clients on other machines need a tunnel.
_ADDRESS = "127.0.0.1"


@click.command("gate", context_settings={"ignore_unknown_options": True})
@model
@click.option("--dry", is_flag=True, help="Play the robot without ROS; the tool `robot` causes its events.")
@click.option("--script", type=FILE, help="Cause the events of this file, a JSON object a line. Needs --dry.")
@click.option(
    "--http",
    "port",
    type=click.IntRange(0, 65535),
    metavar="PORT",
    help="Serve clients over HTTP on this port of 127.0.0.1; 0: a free one.  [default: standard input and output]",
)
@click.option(
    "--clients",
    type=click.IntRange(1, 16),
    default=1,
    show_default=True,
    metavar="N",
    help="Number of tokens for --http, one for each client.",
)
@click.option("--log", type=click.Path(), help="The log of all calls.  [default: a file in the log folder of ROS]")
@click.option(
    "--rate",
    type=click.FloatRange(0, 1000, min_open=True),
    default=20.0,
    show_default=True,
    metavar="N",
    help="Most calls of a tool in a second.",
)
@click.option(
    "--total-rate",
    "total",
    type=click.FloatRange(0, 1000, min_open=True),
    default=50.0,
    show_default=True,
    metavar="N",
    help="Most calls of all tools in a second.",
)
@click.option(
    "--largest",
    type=click.IntRange(1, 1 << 24),
    default=65_536,
    show_default=True,
    metavar="N",
    help="The most characters of JSON in the data of a call.",
)
@click.option(
    "--lease",
    type=click.FloatRange(0, 86_400, min_open=True),
    default=60.0,
    show_default=True,
    metavar="SECONDS",
    help="End the role of a writer after this silence, and stop what it started.",
)
@configuration
@parameters
@synthesizer
@paths
@click.argument("arguments", nargs=-1, type=click.UNPROCESSED, metavar="[ROS ARGUMENTS]")
def command(
    model: str,
    dry: bool,
    script: str | None,
    port: int | None,
    clients: int,
    log: str | None,
    rate: float,
    total: float,
    largest: int,
    lease: float,
    chosen: str | None,
    parameter_texts: Sequence[str],
    paths: Paths,
    arguments: Sequence[str],
) -> None:
    """Serve the commands of a robot as tools of the Model Context Protocol, behind its supervisor.

    MODEL is a .rscd file with a robot, or a .rosgraph.xmi file written by `transform --to xmi`. Each incoming message,
    service and action is a tool. The supervisory layer decides on each call: it is sent, limited, or refused with the
    reason and what would make it possible. The robot runs on ROS 2, or is played with --dry.

    \b
    Examples:
      robosc gate supervised_line_follower.rscd --dry
      robosc gate supervised_line_follower.rscd --http 8765 --clients 2
      robosc gate supervised_line_follower.rscd --ros-args -r /scan:=/robot/scan

    Exit status: 0 the client left or interrupted, 1 errors in the model, 2 a wrong call, 3 no supervisor exists.
    """
    if script is not None and not dry:
        raise click.UsageError("--script needs --dry")
    if dry and arguments:
        raise click.UsageError(f"--dry takes no ROS arguments: {' '.join(arguments)}")
    try:
        from robosc.run.runtime.node import run_gate
        from robosc.tools.gate.admission import Limits
        from robosc.tools.gate.commands import UnknownTypeError, commands
        from robosc.tools.gate.dry import DryNode, ScriptError, play, read_script, robot_events
        from robosc.tools.gate.gate import Gate
        from robosc.tools.gate.server import PATH, serve_http, serve_stdio, serving
    except ModuleNotFoundError as error:
        raise CallError(f"{error.name} is missing: run `pip install 'robosc[mcp]'`") from error
    models, settings = _read(model, chosen, parameter_texts, paths)
    types = models.ros_types or RosTypes(paths.interfaces)
    limits = Limits(rate, total, largest, lease)
    listening = None if port is None else _listen(port)
    tokens = [secrets.token_urlsafe(16) for _ in range(clients)]

    def ready() -> None:
        assert listening is not None
        put(f"http://{_ADDRESS}:{listening.getsockname()[1]}{PATH}")
        for number, token in enumerate(tokens, 1):
            put(f"token of client {number}: {token}")

    def start(graph: rosgraph.RosGraph, safe: SafeMessages) -> None:
        try:
            known = commands(models)
            node = DryNode(settings.layer_name(graph), graph, types, partial(say, err=True)) if dry else None
            events = robot_events(node, graph, types) if node is not None else {}
            steps = [] if script is None else read_script(script, events)
        except (UnknownTypeError, ScriptError) as error:
            raise CallError(str(error)) from None

        def serve(node: RunningNode, layer: GatedLayer) -> AbstractContextManager[None]:
            if isinstance(node, DryNode):
                play(node, steps)
            calls = _log(log, node, settings.layer_name(graph))
            gate = Gate(models.sct, known, node, layer, calls, limits, settings.frame_id, events)
            return serving(serve_stdio(gate) if listening is None else serve_http(gate, listening, tokens, ready), gate)

        run_gate(graph, settings, arguments, safe, serve, node)

    run_node(models, settings, start)


def _read(model: str, chosen: str | None, parameter_texts: Sequence[str], paths: Paths) -> tuple[Models, Configuration]:
    """Return the models of the robot with its supervisor, and the configuration."""
    with Report(aside=True) as report:
        models = read_models(model, paths, report)
        if models.rosgraph is None:
            raise CallError(f"{model} has no ROS graph: use its .rosgraph.xmi or .rscd")
        set_parameters(models.rosgraph, parameter_texts)
        settings = read_configuration(model, chosen, report)
        supervise_models(models, report)
        # A gate sets the frames of headers. A layer between two nodes does not, and would report them as unused.
        report.add(TARGETS["ros2-layer"].findings(models, settings.model_copy(update={"frame_id": {}})))
        report.stop_on_errors()
    return models, settings


def _listen(port: int) -> socket.socket:
    from robosc.tools.view import http_server

    try:
        return http_server.listen(_ADDRESS, port)
    except OSError as error:
        raise CallError(f"{_ADDRESS}:{port}: {error.strerror}") from None


def _log(chosen: str | None, node: RunningNode, package: str) -> EventLog:
    """Open the log of calls."""
    path = chosen or default_log(node.full_name, package).replace("-events.jsonl", "-calls.jsonl")
    try:
        log = EventLog(path)
    except OSError as error:
        raise CallError(f"the log of calls {path} cannot be written: {error.strerror}") from None
    node.info(f"The log of calls is {path}.")
    return log
