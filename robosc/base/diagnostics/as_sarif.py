"""Findings for code hosts and editors: SARIF 2.1.0 (OASIS, 2020)."""

from __future__ import annotations

import json
from pathlib import PurePath
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from robosc.base.diagnostics import in_order
from robosc.base.diagnostics.rules import page, summary

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.base.diagnostics import Diagnostic, Edit, Span

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"


def render(findings: Iterable[Diagnostic], version: str) -> str:
    """Return a SARIF log of one run by this version of the tool, with the findings in order. Ends with a line break.

    Regions count columns in code points. Edits become fixes, and so does each alternative. Rules with findings have the
    description of their page.
    """
    ordered = in_order(findings)
    rules = sorted({finding.rule for finding in ordered})
    run = {
        "tool": {"driver": {"name": "robosc", "version": version, "rules": [_rule(rule) for rule in rules]}},
        "columnKind": "unicodeCodePoints",
        "results": [_result(finding, rules.index(finding.rule)) for finding in ordered],
    }
    return json.dumps({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2) + "\n"


def _rule(rule: str) -> dict[str, Any]:
    text = page(rule)
    if text is None:
        return {"id": rule}
    return {"id": rule, "shortDescription": {"text": summary(text)}, "help": {"text": text, "markdown": text}}


def _result(finding: Diagnostic, rule_index: int) -> dict[str, Any]:
    hint = f"\n\nHint: {finding.hint}" if finding.hint else ""
    artifact = {"uri": _uri(finding.file)}
    result: dict[str, Any] = {
        "ruleId": finding.rule,
        "ruleIndex": rule_index,
        "level": finding.severity.value,
        "message": {"text": finding.message + hint},
        "locations": [{"physicalLocation": {"artifactLocation": artifact, "region": _region(finding.span)}}],
    }
    if finding.related:
        result["relatedLocations"] = [
            {
                "physicalLocation": {"artifactLocation": {"uri": _uri(other.file)}, "region": _region(other.span)},
                "message": {"text": other.message},
            }
            for other in finding.related
        ]
    ways = [(finding.hint or finding.message, finding.edits)] if finding.edits else []
    ways += [(way.title, way.edits) for way in finding.alternatives]
    if ways:
        result["fixes"] = [_fix(artifact, title, edits) for title, edits in ways]
    return result


def _fix(artifact: Mapping[str, str], title: str, edits: Iterable[Edit]) -> dict[str, Any]:
    replacements = [{"deletedRegion": _region(edit.span), "insertedContent": {"text": edit.text}} for edit in edits]
    return {
        "description": {"text": title},
        "artifactChanges": [{"artifactLocation": artifact, "replacements": replacements}],
    }


def _region(span: Span) -> dict[str, int]:
    return {
        "startLine": span.line,
        "startColumn": span.column,
        "endLine": span.end_line,
        "endColumn": span.end_column,
    }


def _uri(file: str) -> str:
    path = PurePath(file)
    # Undecodable bytes of a file name stay as they are.
    return path.as_uri() if path.is_absolute() else quote(path.as_posix().encode(errors="surrogateescape"))
