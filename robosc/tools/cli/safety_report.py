"""Command `robosc report`. The module `robosc.tools.cli.report` collects findings."""

from __future__ import annotations

from pathlib import Path

import click

import robosc.run.report as page
from robosc import __version__
from robosc.analysis.verify import Outcome, verify
from robosc.base.files import reading as files
from robosc.base.files.writing import refuse, write_file
from robosc.tools.cli import ERRORS_FOUND, interruption, put
from robosc.tools.cli.options import Paths, configuration, model, paths, synthesizer
from robosc.tools.cli.progress import note_slow_diagrams, progress
from robosc.tools.cli.reading import read_configuration, read_models, supervise_models
from robosc.tools.cli.report import Report


@click.command("report")
@model
@click.option(
    "-o", "--output", type=click.Path(dir_okay=False), help="The output file.  [default: <robot>.report.html]"
)
@click.option("--json", "as_object", is_flag=True, help="Print one JSON object instead of a page.")
@click.option("--needs", type=click.Path(dir_okay=False), help="Also write the needs of sphinx-needs to FILE.")
@configuration
@synthesizer
@paths
def command(
    model: str,
    output: str | None,
    as_object: bool,
    needs: str | None,
    chosen: str | None,
    paths: Paths,
) -> None:
    """Write a verification report for the person who signs off the robot: one self-contained HTML page.

    MODEL is a model that `verify` accepts, except CIF. For each requirement, the page shows the events that it
    restricts, additions of synthesis, its place in the generated code, the proofs, and the generated tests that cover
    it. It also lists the assumptions, the test coverage of the robot, and the digests of tool, model and generated
    files. See docs/report.md.

    \b
    Examples:
      robosc report line_follower.rscd
      robosc report line_follower.rscd -o report.html --needs needs.json
      robosc report line_follower.rscd --json | jq .coverage.transitions

    Exit status: 0 success, 1 a refuted property or errors in the model, 2 a wrong call, 3 no supervisor exists.
    """
    with Report(aside=True) as report:
        models = read_models(model, paths, report)
        settings = read_configuration(model, chosen, report)
        file = output or f"{models.sct.name}.report.html"
        for written in (file, needs):
            if written:
                refuse(written)
        supervise_models(models, report)
        note_slow_diagrams()
        with progress("verifying"):
            verdicts = verify(models, settings)
        report.add(finding for verdict in verdicts for finding in verdict.findings)
        with progress("generating"):
            texts = {_relative(model, name): files.read(name) for name in files.inputs()}
            contents = page.report(
                models, settings, verdicts, texts=texts, version=__version__, interface_paths=paths.interfaces
            )
    interruption.check()
    if needs:
        write_file(needs, page.as_needs(contents))
    if as_object:
        put(page.as_json(contents), nl=False)
    else:
        write_file(file, page.as_html(contents))
    if any(verdict.outcome is Outcome.REFUTED for verdict in verdicts):
        raise click.exceptions.Exit(ERRORS_FOUND)


def _relative(model: str, name: str) -> str:
    """Return the machine-independent path of an input file: relative to the model's folder, else its name."""
    path, folder = Path(name).resolve(), Path(model).resolve().parent
    return path.relative_to(folder).as_posix() if path.is_relative_to(folder) else path.name
