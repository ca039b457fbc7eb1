"""Command `robosc verify`."""

from __future__ import annotations

from functools import lru_cache
from time import time_ns
from typing import TYPE_CHECKING

import click
from rich.console import Console
from rich.table import Table
from rich.text import Text

from robosc.analysis.verify import PARTS, Outcome, verify
from robosc.analysis.verify.verdict import TRUSTED, as_json, as_junit, details, summary
from robosc.base.diagnostics.visible import visible
from robosc.base.files.writing import refuse, write_file
from robosc.tools.cli import ERRORS_FOUND, CallError, interruption, put, say
from robosc.tools.cli.options import Paths, configuration, jobs, model, paths, require_own_synthesis, synthesizer
from robosc.tools.cli.progress import progress
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report
from robosc.tools.cli.tuning import chosen_tuning, tuning
from robosc.tools.workers import completed

if TYPE_CHECKING:
    from collections.abc import Sequence

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
@configuration
@synthesizer
@tuning
@jobs
@paths
def command(
    model: str,
    as_object: bool,
    junit: str | None,
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

    Exit status: 0 no property refuted, 1 refuted or errors in the model, 2 a wrong call, 3 no supervisor exists.
    """
    require_own_synthesis(jobs)
    with Report(aside=True) as report:
        models = read_models(model, paths, report, cif=True)
        settings = read_configuration(model, chosen, report)
        if junit:
            refuse(junit)
        supervise_models(models, report)
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
    console = Console(highlight=False)
    if not console.is_terminal:
        console.width = _WIDTH
    table = Table()
    for heading in ("property", "verdict", "evidence"):
        table.add_column(heading)
    table.add_column("seconds", justify="right")
    for verdict in verdicts:
        outcome = Text(verdict.outcome.value, _STYLES[verdict.outcome])
        table.add_row(Text(verdict.property), outcome, Text(visible(verdict.evidence)), f"{verdict.seconds:.3f}")
    console.print(table)
    for verdict in verdicts:
        text = details(verdict, model)
        if text:
            say(f"\n{text}")
    say(f"\n{TRUSTED}\n\n{model.name}: {summary(verdicts)}")
