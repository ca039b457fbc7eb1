"""Findings: place, message, rule, and repair.

`as_text`, `as_json` and `as_sarif` render findings. `rules` finds the pages of their rules.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


class Severity(StrEnum):
    """Severity of a finding: a model with errors is unusable."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, order=True)
class Span:
    """A range of text in lines and code points, counted from 1, the end exclusive."""

    line: int
    column: int
    end_line: int
    end_column: int

    def contains(self, other: Span) -> bool:
        """Return whether the other span lies within this one."""
        starts = (self.line, self.column) <= (other.line, other.column)
        return starts and (other.end_line, other.end_column) <= (self.end_line, self.end_column)


#: Span of a finding about a whole file.
START = Span(1, 1, 1, 1)


@dataclass(frozen=True, order=True)
class Edit:
    """A change of a text: `text` replaces the contents of a span, which may be empty."""

    span: Span
    text: str


@dataclass(frozen=True, order=True)
class Alternative:
    """One of several ways to apply a hint, for a user to choose: a title and the edits."""

    title: str
    edits: tuple[Edit, ...]


class Repair(NamedTuple):
    """A way to fix a finding.

    `hint` is a sentence for the user. `text` replaces the text of the finding's span; None if no single replacement
    fixes the finding. `choices` are replacements of which the user picks one. `elsewhere` lists further replacements in
    the same file as (start, end, text), with offsets in code points from 0, the end exclusive. If `is_offered`, `text`
    and `elsewhere` together are one choice: they may be wrong.
    """

    hint: str
    text: str | None = None
    choices: tuple[str, ...] = ()
    elsewhere: tuple[tuple[int, int, str], ...] = ()
    is_offered: bool = False


@dataclass(frozen=True, order=True)
class Related:
    """A further place of a finding, with its message."""

    file: str
    span: Span
    message: str


@dataclass(frozen=True)
class Diagnostic:
    """One finding of one rule at one place.

    `hint` explains how to fix it. If exactly one fix can be applied automatically, `edits` apply it in the finding's
    file. If the user must choose, `alternatives` are the fixes. `related` are further places. `follows` is the number
    of steps in the chain from the original finding to this consequence, or 0. The first related place of a consequence
    is that of the original finding.
    """

    file: str
    span: Span
    severity: Severity
    rule: str
    message: str
    hint: str | None = None
    edits: tuple[Edit, ...] = ()
    related: tuple[Related, ...] = ()
    alternatives: tuple[Alternative, ...] = ()
    follows: int = 0


class ModelError(Exception):
    """A model that cannot be used, with all findings."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = list(diagnostics)
        super().__init__("\n".join(finding.message for finding in self.diagnostics))


def in_order(findings: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return each finding once, sorted by file, position and rule; consequences stand after their original finding."""
    return sorted(
        dict.fromkeys(findings),
        key=lambda finding: (
            *original_place(finding),
            finding.follows,
            finding.file,
            finding.span,
            finding.rule,
            finding.message,
            finding.hint or "",
            finding.edits,
            finding.alternatives,
        ),
    )


def original_place(finding: Diagnostic) -> tuple[str, Span]:
    """Return the place of a finding, or that of the original one if it is a consequence."""
    original = finding.related[0] if finding.follows and finding.related else finding
    return original.file, original.span


def has_errors(findings: Iterable[Diagnostic]) -> bool:
    """Return whether one of the findings makes the model unusable."""
    return any(finding.severity is Severity.ERROR for finding in findings)
