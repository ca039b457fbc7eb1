"""Findings for people: place, message, the source line with carets under the fault, and the repair."""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING, Literal, TypeAlias

from rich.cells import cell_len

from robosc.diagnostics import Diagnostic, Severity, in_order

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

Part: TypeAlias = Literal["place", "error", "warning", "rule", "caret", "hint"]
_TAB = 4
_MARGIN = "    "
#: What would move a terminal's cursor or reorder its text shows as a replacement character.
_UNPRINTABLE = re.compile("[\x00-\x08\x0a-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def plain(_part: Part, text: str) -> str:
    """No colour."""
    return text


def render(findings: Iterable[Diagnostic], texts: Mapping[str, str], paint: Callable[[Part, str], str] = plain) -> str:
    """All findings in order, each as `file:line:column: severity: message [rule]` with its line, carets and hint.

    `texts` holds the source of each file; of a file that is not there no line is shown. `paint` colours a part of the
    output. Empty for no findings, else it ends with a line break.
    """
    lines = {file: text.split("\n") for file, text in texts.items()}
    return "".join(_render(each, lines.get(each.file, []), paint) for each in in_order(findings))


def summary(findings: Iterable[Diagnostic]) -> str:
    """How many errors and warnings there are, such as `2 errors, 1 warning`; empty for none."""
    found = in_order(findings)
    counts = [(sum(each.severity is severity for each in found), severity.value) for severity in Severity]
    return ", ".join(f"{count} {word}{'s' if count > 1 else ''}" for count, word in counts if count)


def _render(finding: Diagnostic, lines: list[str], paint: Callable[[Part, str], str]) -> str:
    place = f"{_safe(finding.file)}:{finding.span.line}:{finding.span.column}:"
    severity: Part = "error" if finding.severity is Severity.ERROR else "warning"
    head = f"{paint('place', place)} {paint(severity, f'{severity}:')}"
    shown = [f"{head} {_safe(finding.message)} {paint('rule', f'[{finding.rule}]')}"]
    if finding.span.line <= len(lines):
        line, carets = underlined(finding, lines[finding.span.line - 1])
        indent = len(carets) - len(carets.lstrip())
        shown += [_MARGIN + line, _MARGIN + carets[:indent] + paint("caret", carets[indent:])]
    if finding.hint:
        shown.append(f"{_MARGIN}{paint('hint', 'hint:')} {_safe(finding.hint)}")
    return "\n".join(shown) + "\n"


def underlined(finding: Diagnostic, line: str) -> tuple[str, str]:
    """The first line of the finding as a terminal shows it, and the carets that stand under its span there.

    Tabs are expanded; a wide character takes two columns and a combining one none. Of a span over several lines the
    rest of the first is underlined.
    """
    line = line.removesuffix("\r")
    span = finding.span
    start = span.column - 1
    end = span.end_column - 1 if span.end_line == span.line else len(line.rstrip())
    # A combining character belongs to the one before it: it neither starts nor ends an underline.
    while 0 < start < len(line) and unicodedata.combining(line[start]):
        start -= 1
    left = _columns(line[:start])
    width = _columns(line[:end]) - left
    return _shown(line).rstrip(), " " * left + "^" * max(width, 1)


def _shown(text: str) -> str:
    """The text with tabs expanded to columns, and nothing in it that a terminal would obey."""
    shown, column = [], 0
    for piece in re.split("(\t)", text):
        visible = " " * (_TAB - column % _TAB) if piece == "\t" else _safe(piece)
        shown.append(visible)
        column += cell_len(visible)
    return "".join(shown)


def _safe(text: str) -> str:
    return _UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", text)


def _columns(text: str) -> int:
    return cell_len(_shown(text))
