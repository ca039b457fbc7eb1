"""What a finding is: where, what, which rule, how to mend it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence


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


@dataclass(frozen=True)
class Diagnostic:
    """One finding of one rule at one place; `hint` says how to mend it."""

    file: str
    span: Span
    severity: Severity
    rule: str
    message: str
    hint: str | None = None


class ModelError(Exception):
    """A model that can't be used, with all that was found wrong with it."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = list(diagnostics)
        super().__init__("\n".join(each.message for each in self.diagnostics))
