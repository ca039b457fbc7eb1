"""Report of a command's findings, also if it ends with an error, and its exit status."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import click

from robosc.base.diagnostics import ModelError, has_errors
from robosc.base.files import reading as files
from robosc.tools.cli import EMPTY_SUPERVISOR, ERRORS_FOUND, as_call_error, put

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from types import TracebackType
    from typing import Self

    from robosc.base.diagnostics import Diagnostic
    from robosc.base.diagnostics.as_text import Part

_PAINTS: Mapping[Part, Callable[[str], str]] = {
    "place": partial(click.style, bold=True),
    "error": partial(click.style, fg="red", bold=True),
    "warning": partial(click.style, fg="magenta", bold=True),
    "rule": partial(click.style, dim=True),
    "caret": partial(click.style, fg="green", bold=True),
    "hint": partial(click.style, fg="cyan"),
}


class Report:
    """Collects findings and shows them at the end of its `with` block, also after an exception.

    Findings as text go to standard error if the command prints something else (`aside`). Other formats go to standard
    output; with the format `none`, they are only collected. Ends the program with the status that the errors require.
    """

    def __init__(self, form: str = "text", *, aside: bool = False) -> None:
        self.form = form
        self.aside = aside
        self.findings: list[Diagnostic] = []
        self.texts: dict[str, str] = {}
        self._quotable: set[str] = set()
        self.status = 0

    def add(self, findings: Iterable[Diagnostic], texts: Mapping[str, str] | None = None) -> None:
        """Add findings, and the source texts of their files."""
        self.texts |= texts or {}
        self.findings += findings

    def may_quote(self, file: str) -> None:
        """Allow findings to show lines of a file that is not yet read as text. Lines of other files are never shown.

        A saved model names the files of its findings itself: they may be any files.
        """
        self._quotable.add(file)

    def stop_on_errors(self) -> None:
        """Leave the `with` block if there are errors: the next steps need a valid model."""
        if has_errors(self.findings):
            raise click.exceptions.Exit(ERRORS_FOUND)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, _type: type[BaseException] | None, error: BaseException | None, _traceback: TracebackType | None
    ) -> Literal[False]:
        if isinstance(error, ModelError):
            self.add(error.diagnostics)
            self.status = EMPTY_SUPERVISOR if _is_empty(error) else ERRORS_FOUND
        elif error is None:
            self.status = ERRORS_FOUND if has_errors(self.findings) else 0
        elif not isinstance(error, click.exceptions.Exit):
            return False
        self._show()
        if self.status:
            raise click.exceptions.Exit(self.status)
        return False

    def _show(self) -> None:
        if self.form == "json":
            from robosc.base.diagnostics import as_json

            put(as_json.render(self.findings), nl=False)
        elif self.form == "sarif":
            from robosc import __version__
            from robosc.base.diagnostics import as_sarif

            put(as_sarif.render(self.findings, __version__), nl=False)
        elif self.findings and self.form != "none":
            from robosc.base.diagnostics import as_text

            paint = as_text.plain if os.environ.get("NO_COLOR") else _paint
            shown = {finding.file for finding in self.findings}
            texts = {file: text for file in shown if (text := self._text(file)) is not None}
            put(as_text.render(self.findings, texts, paint), nl=False, err=self.aside)
            put(as_text.summary(self.findings), err=True)

    def _text(self, file: str) -> str | None:
        """Return the source of a file: as read before, else from the file if quoting is allowed, else None."""
        if file not in self.texts and file in self._quotable:
            with suppress(OSError):
                self.texts[file] = files.read(file).decode("utf-8", errors="replace")
        return self.texts.get(file)


def attempt(work: Callable[[Report], int]) -> tuple[int, str | None, list[Any]]:
    """Return the exit status that `work` would have as a command, its error, and its findings as objects.

    `work` gets a report that prints nothing, and returns its status without errors.
    """
    report = Report("none")
    status, error = 0, None
    try:
        with report:
            status = work(report)
    except click.exceptions.Exit as end:
        status = end.exit_code
    except click.ClickException as fault:
        status, error = fault.exit_code, fault.format_message()
    except Exception as fault:
        failed = as_call_error(fault)
        status, error = failed.exit_code, failed.format_message()
    from robosc.base.diagnostics import as_json

    findings: list[Any] = json.loads(as_json.render(report.findings))
    return status, error, findings


def _paint(part: Part, text: str) -> str:
    return _PAINTS[part](text)


def _is_empty(error: ModelError) -> bool:
    return any(finding.rule == "empty-supervisor" for finding in error.diagnostics)
