"""Command `robosc dap`."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from robosc.run.simulation.sources import PlayError
from robosc.tools.cli import CallError, say
from robosc.tools.cli.options import Paths, synthesizer
from robosc.tools.cli.parameters import set_parameters
from robosc.tools.cli.reading import read_models, supervise_models
from robosc.tools.cli.report import Report
from robosc.tools.debugger import Adapter, serve_port, serve_stdio

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.m2t.models import Models
    from robosc.tools.debugger import LaunchTarget


class _FindingList(Report):
    """Collects findings for the debugger's client, which shows them."""

    def _show(self) -> None:
        pass


@click.command("dap")
@click.option(
    "--port", type=click.IntRange(0, 65535), help="Listen on this TCP port of this machine; 0 selects a free port."
)
@click.option("--once", is_flag=True, help="With --port: exit after the first client.")
@synthesizer
def command(port: int | None, once: bool) -> None:
    """Debug robots in an editor with the Debug Adapter Protocol: step, step back, break, inspect, explain.

    The editor starts this command and communicates over standard input and output, or over a port. It launches a model
    with a script, an event log or a counterexample of `verify`. docs/debugging.md describes the setup of editors.

    \b
    Examples:
      robosc dap
      robosc dap --port 4711

    Exit status: 0 the client has finished, 2 a wrong call, or a stream that is no Debug Adapter Protocol.
    """
    if port is None:
        if once:
            raise click.UsageError("--once needs --port")
        fault = serve_stdio(lambda connection: Adapter(connection, _load))
        if fault is not None:
            raise CallError(f"this is not the Debug Adapter Protocol: {fault}")
        return
    serve_port(
        port,
        lambda connection: Adapter(connection, _load),
        lambda number: say(f"listening on port {number}", err=True),
        once=once,
    )


def _load(target: LaunchTarget) -> tuple[Models, Sequence[Diagnostic], Mapping[str, str]]:
    report = _FindingList(aside=True)
    parameters = [
        f"{name}={value if isinstance(value, str) else json.dumps(value)}" for name, value in target.parameters.items()
    ]
    models: Models | None = None
    try:
        with report:
            models = read_models(target.program, Paths(target.libraries, target.interfaces), report, cif=True)
            set_parameters(models.rosgraph, parameters)
            supervise_models(models, report)
    except click.ClickException as error:
        raise PlayError(error.format_message(), report.findings, report.texts) from None
    except click.exceptions.Exit:
        errors = [finding for finding in report.findings if finding.severity.value == "error"]
        first = errors[0] if errors else report.findings[0]
        message = f"{first.file}:{first.span.line}:{first.span.column}: {first.message}"
        raise PlayError(message, report.findings, report.texts) from None
    assert models is not None
    return models, report.findings, report.texts
