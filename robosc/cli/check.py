"""`robosc check`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from robosc.cli.options import FILE, Paths, findings_format, paths
from robosc.cli.reading import read
from robosc.cli.report import Report
from robosc.diagnostics import ModelError

if TYPE_CHECKING:
    from collections.abc import Sequence


@click.command("check")
@click.argument("models", type=FILE, nargs=-1, required=True, metavar="MODEL...")
@findings_format
@paths
def command(models: Sequence[str], form: str, paths: Paths) -> None:
    """Read robots and libraries, resolve their names and say what breaks a rule of the language.

    MODEL is a .rscd file, a .cif file, or an .xmi file of one of the metamodels. Exit status: 0 no errors, 1 errors.

    \b
    Examples:
      robosc check line_follower.rscd
      robosc check -I libraries robots/*.rscd --format sarif > findings.sarif
    """
    with Report(form) as report:
        for model in models:
            try:
                read(model, paths, report)
            except ModelError as error:
                report.add(error.diagnostics)
