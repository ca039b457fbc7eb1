"""`robosc check`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from robosc.cli import say
from robosc.cli.options import FILE, Paths, findings_format, paths
from robosc.cli.reading import read
from robosc.cli.report import Report
from robosc.cli.watching import whenever_files_change
from robosc.diagnostics import ModelError
from robosc.diagnostics.visible import visible
from robosc.language.libraries import search_folders

if TYPE_CHECKING:
    from collections.abc import Sequence


@click.command("check")
@click.argument("models", type=FILE, nargs=-1, required=True, metavar="MODEL...")
@findings_format
@click.option("--watch", is_flag=True, help="Check again whenever a file changes, until Ctrl-C.")
@paths
def command(models: Sequence[str], form: str, watch: bool, paths: Paths) -> None:
    """Read robots and libraries, resolve their names and say what breaks a rule of the language.

    MODEL is a .rscd file, a .cif file, or an .xmi file of one of the metamodels. Exit status: 0 no errors, 1 errors.

    \b
    Examples:
      robosc check line_follower.rscd
      robosc check line_follower.rscd --watch
      robosc check -I libraries robots/*.rscd --format sarif > findings.sarif
    """
    if not watch:
        _check(models, form, paths)
        return

    def again(changed: Sequence[str]) -> None:
        because = f": {', '.join(map(visible, changed))} changed" if changed else ""
        say(f"checking {', '.join(map(visible, models))}{because}", err=True)
        try:
            _check(models, form, paths)
            say("no errors", err=True)
        except click.exceptions.Exit:
            pass  # the errors are counted
        except OSError as error:
            say(f"{visible(str(error.filename))}: {error.strerror}", err=True)
        say("waiting for changes, Ctrl-C ends", err=True)

    whenever_files_change(
        again, models, [*dict.fromkeys(Path(model).parent for model in models), *search_folders(paths.libraries)]
    )


def _check(models: Sequence[str], form: str, paths: Paths) -> None:
    with Report(form) as report:
        for model in models:
            try:
                read(model, paths, report)
            except ModelError as error:
                report.add(error.diagnostics)
