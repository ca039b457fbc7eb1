"""What a finding is: where, what, which rule, how to mend it.

How findings are shown is in `as_text`, `as_json` and `as_sarif`; what their rules mean is in `rules`.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


class Severity(StrEnum):
    """How much a finding matters: an error keeps the model from being used."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, order=True)
class Span:
    """A range of text, counted from 1 in lines and code points, the end exclusive."""

    line: int
    column: int
    end_line: int
    end_column: int

    def contains(self, other: Span) -> bool:
        """Whether the other span lies within this one."""
        starts = (self.line, self.column) <= (other.line, other.column)
        return starts and (other.end_line, other.end_column) <= (self.end_line, self.end_column)


#: Where a finding stands that concerns a whole file.
START = Span(1, 1, 1, 1)


@dataclass(frozen=True, order=True)
class Edit:
    """A change of a text: `text` takes the place of what stands in a span, which may be empty."""

    span: Span
    text: str


@dataclass(frozen=True, order=True)
class Alternative:
    """One way of several to do what a hint says, among which a person chooses: in words, and the edits."""

    title: str
    edits: tuple[Edit, ...]


class Repair(NamedTuple):
    """How to mend a finding.

    `hint`: the sentence for a person. `text`: replaces the text of the finding's span; None: no single replacement
    mends it. `choices`: replacements of which a person picks one. `elsewhere`: further replacements in the same file,
    as (start, end, text), offsets in code points from 0, the end exclusive.
    """

    hint: str
    text: str | None = None
    choices: tuple[str, ...] = ()
    elsewhere: tuple[tuple[int, int, str], ...] = ()


@dataclass(frozen=True, order=True)
class Related:
    """A place that a finding speaks of, and what is there."""

    file: str
    span: Span
    message: str


@dataclass(frozen=True)
class Diagnostic:
    """One finding of one rule at one place.

    `hint` says how to mend it. Where there is one way, and a program can go it, `edits` do it in the finding's file;
    where a person is to choose, `alternatives` are the ways. `related` are other places that it speaks of. `follows` is
    0, or the number of findings from its cause to it, each of which follows from the one before.
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
    """A model that can't be used, with all that was found wrong with it."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = list(diagnostics)
        super().__init__("\n".join(finding.message for finding in self.diagnostics))


def in_order(findings: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Each finding once, by file, position and rule; causes before what follows from them."""
    return sorted(
        dict.fromkeys(findings),
        key=lambda found: (
            found.file,
            found.follows,
            found.span,
            found.rule,
            found.message,
            found.hint or "",
            found.edits,
            found.alternatives,
        ),
    )


def has_errors(findings: Iterable[Diagnostic]) -> bool:
    """Whether one of the findings keeps the model from being used."""
    return any(finding.severity is Severity.ERROR for finding in findings)
