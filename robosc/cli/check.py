"""`robosc check`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from robosc.cli.options import FILE, findings_format, interface_path, library_path
from robosc.cli.reading import read
from robosc.cli.report import Report
from robosc.diagnostics import ModelError

if TYPE_CHECKING:
    from collections.abc import Sequence


@click.command("check")
@click.argument("models", type=FILE, nargs=-1, required=True, metavar="MODEL...")
@findings_format
@library_path
@interface_path
def command(models: Sequence[str], form: str, library_paths: Sequence[str], interface_paths: Sequence[str]) -> None:
    """Read robots and libraries, resolve their names and say what breaks a rule of the language.

    MODEL is a .rscd file, or an .xmi file of one of the metamodels. Exit status: 0 no errors, 1 errors.

    \b
    Examples:
      robosc check line_follower.rscd
      robosc check -I libraries robots/*.rscd --format sarif > findings.sarif
    """
    with Report(form) as report:
        for model in models:
            try:
                read(model, library_paths, report, interface_paths)
            except ModelError as error:
                report.add(error.diagnostics)
