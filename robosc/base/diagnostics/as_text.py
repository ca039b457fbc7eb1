"""Findings for people: place, message, the source line with carets under the fault, and the repair."""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING, Literal, TypeAlias

from rich.cells import cell_len

from robosc.base.diagnostics import Diagnostic, Severity, in_order
from robosc.base.diagnostics.visible import visible

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

Part: TypeAlias = Literal["place", "error", "warning", "rule", "caret", "hint"]
_TAB = 4
_MARGIN = "    "
#: Maximum number of findings shown (errors first), and limits of the shown parts of long lines and messages.
MOST = 100
_LONGEST_LINE, _BEFORE_FAULT = 160, 60
_LONGEST_TEXT = 4000


def plain(_part: Part, text: str) -> str:
    """Return a text without color."""
    return text


def render(findings: Iterable[Diagnostic], texts: Mapping[str, str], paint: Callable[[Part, str], str] = plain) -> str:
    """Return all findings in order, each as `file:line:column: severity: message [rule]` with line, carets and hint.

    `texts` maps files to their source; without it, a finding is shown without its line. `paint` colors a part of the
    output. The text is empty for no findings, else it ends with a line break. At most `MOST` findings are shown, errors
    before warnings, followed by the number of the others.
    """
    ordered = in_order(findings)
    shown = in_order(sorted(ordered, key=lambda finding: finding.severity is not Severity.ERROR)[:MOST])
    lines = {file: texts[file].split("\n") for file in {finding.file for finding in shown} if file in texts}
    parts = [_render(finding, lines.get(finding.file, []), paint) for finding in shown]
    if len(ordered) > len(shown):
        parts.append(f"{len(ordered) - len(shown)} more are not shown: `robosc check --format json` prints all\n")
    return "".join(parts)


def summary(findings: Iterable[Diagnostic]) -> str:
    """Return the number of errors and warnings, such as `2 errors, 1 warning`; empty for none."""
    ordered = in_order(findings)
    counts = [(sum(finding.severity is severity for finding in ordered), severity.value) for severity in Severity]
    return ", ".join(f"{count} {word}{'s' if count > 1 else ''}" for count, word in counts if count)


def _render(finding: Diagnostic, lines: list[str], paint: Callable[[Part, str], str]) -> str:
    place = f"{visible(finding.file)}:{finding.span.line}:{finding.span.column}:"
    severity: Part = "error" if finding.severity is Severity.ERROR else "warning"
    head = f"{paint('place', place)} {paint(severity, f'{severity}:')}"
    shown = [f"{head} {_escape(finding.message)} {paint('rule', f'[{finding.rule}]')}"]
    if finding.span.line <= len(lines):
        line, carets = underline(finding, lines[finding.span.line - 1])
        indent = len(carets) - len(carets.lstrip())
        shown += [_MARGIN + line, _MARGIN + carets[:indent] + paint("caret", carets[indent:])]
    if finding.hint:
        shown.append(f"{_MARGIN}{paint('hint', 'hint:')} {_escape(finding.hint)}")
    return "\n".join(shown) + "\n"


def underline(finding: Diagnostic, line: str) -> tuple[str, str]:
    """Return the first line of a finding as a terminal shows it, and the carets under its span.

    Tabs are expanded. A wide character takes two columns and a combining one none. If the span has several lines, the
    rest of its first line is underlined. Only the part of a long line around the start of the span is shown.
    """
    line = line.removesuffix("\r")
    span = finding.span
    start = span.column - 1
    end = span.end_column - 1 if span.end_line == span.line else len(line.rstrip())
    # A combining character belongs to the one before it, so it neither starts nor ends an underline.
    while 0 < start < len(line) and unicodedata.combining(line[start]):
        start -= 1
    before = after = ""
    if len(line) > _LONGEST_LINE:
        first = max(0, min(start - _BEFORE_FAULT, len(line) - _LONGEST_LINE))
        before, after = "…" if first else "", "…" if first + _LONGEST_LINE < len(line) else ""
        line, start, end = line[first : first + _LONGEST_LINE], start - first, min(end - first, _LONGEST_LINE)
    left = _columns(before + line[:start])
    width = _columns(before + line[:end]) - left
    return _shown(before + line + after).rstrip(), " " * left + "^" * max(width, 1)


def _shown(text: str) -> str:
    """Return a text with tabs expanded, and without characters that a terminal would interpret."""
    shown, column = [], 0
    for piece in re.split("(\t)", text):
        part = " " * (_TAB - column % _TAB) if piece == "\t" else visible(piece)
        shown.append(part)
        column += cell_len(part)
    return "".join(shown)


def _escape(text: str) -> str:
    return visible(text if len(text) <= _LONGEST_TEXT else f"{text[:_LONGEST_TEXT]} …")


def _columns(text: str) -> int:
    return cell_len(_shown(text))
