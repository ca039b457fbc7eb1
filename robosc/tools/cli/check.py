"""Command `robosc check`."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import click

from robosc.base.diagnostics import ModelError
from robosc.base.diagnostics.visible import visible
from robosc.base.files import reading as files
from robosc.base.files.reading import record_inputs
from robosc.base.files.writing import write_file
from robosc.base.ros_types import RosTypes
from robosc.language.checks import check as rules_of
from robosc.language.checks.automatic_edits import safe_edits
from robosc.language.reading import read as read_text
from robosc.language.text import Documents
from robosc.tools.cli import CallError, interruption, say
from robosc.tools.cli.file_watch import watch as watch_files
from robosc.tools.cli.options import FILE, Paths, findings_format, paths
from robosc.tools.cli.reading import read
from robosc.tools.cli.report import Report

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.reading import Reading

#: Maximum number of rounds: an edit may uncover further faults, and edits may undo each other.
_ROUNDS = 10


@click.command("check")
@click.argument("models", type=FILE, nargs=-1, required=True, metavar="MODEL...")
@findings_format
@click.option("--fix", is_flag=True, help="First apply hints that have exactly one edit to the models.")
@click.option("--watch", is_flag=True, help="Check again after each change of a file, until Ctrl-C.")
@paths
def command(models: Sequence[str], form: str, fix: bool, watch: bool, paths: Paths) -> None:
    """Read robots and libraries, resolve their names, and report violations of the rules of the language.

    MODEL is a .rscd file, a .cif or .wmod file, or an .xmi file of one of the metamodels. With --fix, the command first
    edits .rscd files where a hint has exactly one edit (`write 0.0`), and then reports the remaining findings. Exit
    status: 0 no errors, 1 errors.

    \b
    Examples:
      robosc check line_follower.rscd
      robosc check line_follower.rscd --fix
      robosc check line_follower.rscd --watch
      robosc check -I libraries robots/*.rscd --format sarif > findings.sarif
    """
    for model in models if fix else ():
        _mend(model, paths)
    if not watch:
        _check(models, form, paths)
        return

    def check_all() -> None:
        _check(models, form, paths)
        say("no errors", err=True)

    watch_files("checking", check_all, models, (), paths)


class _CheckedModel(NamedTuple):
    """A model and all its findings."""

    reading: Reading
    findings: list[Diagnostic]


def _mend(model: str, paths: Paths) -> None:
    """Apply the edits of findings to a file."""
    if not model.endswith(".rscd"):
        raise CallError(f"{model} is not a .rscd file: --fix edits only text")
    with record_inputs():
        written = files.read(model)
    content, count = mended(model, written, paths)
    if count:
        write_file(model, content)
        say(f"{visible(model)}: {count} edit{'s' * (count != 1)}", err=True)


def mended(model: str, written: bytes, paths: Paths) -> tuple[str, int]:
    """Return the text of a `.rscd` file after the edits of findings, and their number.

    The edits are applied repeatedly, unless they make the text worse. A text that is not UTF-8 stays unchanged: the
    bytes that cannot be decoded would be lost.
    """
    interfaces = RosTypes(paths.interfaces)

    def checked(content: str) -> _CheckedModel:
        interruption.check()
        with record_inputs():  # files that this reads may be overwritten
            reading = read_text(model, paths.libraries, interfaces, Documents({model: content}))
        return _CheckedModel(reading, [*reading.findings, *rules_of(reading.base, reading.findings, interfaces)])

    try:
        content = written.decode("utf-8")
    except UnicodeDecodeError:
        return written.decode("utf-8", errors="replace"), 0
    seen = {content}
    count = 0
    for _ in range(_ROUNDS):
        checked_model = checked(content)
        edits = safe_edits(checked_model, checked)
        if not edits:
            break
        after = checked_model.reading.file.text.after(edits, content)
        if after in seen:
            break
        seen.add(after)
        content = after
        count += len(edits)
    return content, count


def _check(models: Sequence[str], form: str, paths: Paths) -> None:
    """Check each model. An internal error in one model is raised after the findings for all others are reported."""
    faults: list[Exception] = []
    try:
        with Report(form) as report:
            for model in models:
                try:
                    read(model, paths, report)
                except ModelError as error:
                    report.add(error.diagnostics)
                except (click.ClickException, click.exceptions.Exit, OSError):
                    raise
                except Exception as fault:
                    if interruption.was_interrupted():
                        raise
                    faults.append(fault)
    finally:
        if faults:
            raise faults[0]
