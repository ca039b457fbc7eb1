"""Findings for programs: the array that `--format json` prints."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from robosc.diagnostics import in_order

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.diagnostics import Diagnostic


def render(findings: Iterable[Diagnostic]) -> str:
    """A JSON array of all findings in order; `hint` is null where there is none. Ends with a line break."""
    return json.dumps([_object(each) for each in in_order(findings)], indent=2) + "\n"


def _object(finding: Diagnostic) -> dict[str, str | int | None]:
    return {
        "file": finding.file,
        "line": finding.span.line,
        "column": finding.span.column,
        "end_line": finding.span.end_line,
        "end_column": finding.span.end_column,
        "severity": finding.severity.value,
        "rule": finding.rule,
        "message": finding.message,
        "hint": finding.hint,
    }
