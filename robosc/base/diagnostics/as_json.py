"""Findings for programs: the array that `--format json` prints."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import in_order

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.base.diagnostics import Diagnostic, Edit, Span


def render(findings: Iterable[Diagnostic]) -> str:
    """Return a JSON array of all findings in order, ended by a line break.

    `hint` is null if there is none.
    """
    return json.dumps([_object(finding) for finding in in_order(findings)], indent=2) + "\n"


def _object(finding: Diagnostic) -> dict[str, Any]:
    return {
        "file": finding.file,
        **_place(finding.span),
        "severity": finding.severity.value,
        "rule": finding.rule,
        "message": finding.message,
        "hint": finding.hint,
        "follows": finding.follows,
        "related": [{"file": other.file, **_place(other.span), "message": other.message} for other in finding.related],
        "edits": _edits(finding.edits),
        "alternatives": [{"title": way.title, "edits": _edits(way.edits)} for way in finding.alternatives],
    }


def _edits(edits: Iterable[Edit]) -> list[dict[str, Any]]:
    return [{**_place(edit.span), "text": edit.text} for edit in edits]


def _place(span: Span) -> dict[str, int]:
    return {"line": span.line, "column": span.column, "end_line": span.end_line, "end_column": span.end_column}
