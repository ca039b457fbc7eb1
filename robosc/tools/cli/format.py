"""Command `robosc format`."""

from __future__ import annotations

from difflib import unified_diff
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from robosc.base.diagnostics.visible import visible
from robosc.base.files import reading as files
from robosc.base.files.search import files_below
from robosc.base.files.writing import write_file
from robosc.language.formatting import format_text
from robosc.language.text import decode
from robosc.tools.cli import ERRORS_FOUND, CallError, interruption, say
from robosc.tools.cli.report import Report

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

#: File name of the standard input in findings.
_STDIN = "<stdin>"


@click.command("format")
@click.argument("models", type=click.Path(exists=True, allow_dash=True), nargs=-1, required=True, metavar="MODEL...")
@click.option("--check", is_flag=True, help="Do not write; list the files that would change.")
@click.option("--diff", is_flag=True, help="Do not write; print the changes.")
def command(models: Sequence[str], check: bool, diff: bool) -> None:
    """Format robots and libraries in the canonical layout. Their meaning and comments do not change.

    MODEL is a .rscd file, a folder (all .rscd files in it and below), or `-` (standard input to standard output). Files
    with syntax errors stay unchanged. Names need not resolve.

    \b
    Examples:
      robosc format line_follower.rscd
      robosc format --check --diff robots libraries
      robosc format - < line_follower.rscd

    Exit status: 0 success, 1 syntax errors or, with --check, files that would change, 2 a wrong call.
    """
    changing = False
    with Report(aside=True) as report:
        for file in dict.fromkeys(file for model in models for file in _files(model)):
            before = files.read_stdin(_STDIN) if file == _STDIN else files.read(file, is_input=False)
            text, findings = decode(file, before)
            after = None
            if not findings:
                after, findings = format_text(text)
            report.add(findings, {file: text.content})
            if after is not None:
                changing = changing or after.encode() != before
                _show(file, before, after, diff=diff) if check or diff else _write(file, after)
    if check and changing:
        raise click.exceptions.Exit(ERRORS_FOUND)


def _files(model: str) -> Iterator[str]:
    """Return the files of one argument, those of a folder in the order of their paths."""
    if model == "-":
        yield _STDIN
    elif model.endswith(".xmi"):
        raise CallError(f"{model} is not a .rscd file: only text can be formatted")
    elif not Path(model).is_dir():
        yield model
    else:
        yield from files_below(model, ".rscd", _refuse)


def _refuse(error: OSError) -> NoReturn:
    raise error


def _show(file: str, before: bytes, after: str, *, diff: bool) -> None:
    if diff:
        old, new = (_lines(content) for content in (before.decode(), after))
        say("".join(unified_diff(old, new, visible(file), visible(file))), nl=False)
    elif after.encode() != before:
        say(visible(file))


def _lines(text: str) -> list[str]:
    lines = text.split("\n")
    last = [f"{lines[-1]}\n\\ No newline at end of file\n"] if lines[-1] else []
    return [f"{line}\n" for line in lines[:-1]] + last


def _write(file: str, text: str) -> None:
    if file == _STDIN:
        click.open_file("-", "wb").write(text.encode())
        return
    interruption.check()
    write_file(file, text)
