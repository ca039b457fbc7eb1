"""What hints say to write mends the finding, in all models that break a rule."""

from pathlib import Path

import pytest

from robosc.checks import check
from robosc.diagnostics import Diagnostic, Edit
from robosc.language import Documents, Reading, read
from robosc.ros_types import RosTypes

HERE = Path(__file__).parent
INTERFACES = RosTypes([HERE / "interfaces"])
MODELS = sorted((HERE / "rejected").glob("*/*.rscd"))
#: Of the models that break a rule at least one has a hint that says what to write.
MENDED = {
    "argument",
    "data-provisioning",
    "duration",
    "enum-default",
    "initial-state",
    "integer-range",
    "interface-link",
    "interface-type",
    "interface-unknown",
    "interface-unused",
    "marked-state",
    "result-type",
    "type",
}


def findings(path: Path, text: str | None = None) -> tuple[Reading, list[Diagnostic]]:
    documents = None if text is None else Documents({str(path): text})
    reading = read(path, [HERE / "libraries"], INTERFACES, documents)
    return reading, [*reading.findings, *check(reading.base, reading.findings, INTERFACES)]


def edited(text: str, edits: tuple[Edit, ...]) -> str:
    lines = text.split("\n")
    for edit in sorted(edits, reverse=True):
        span = edit.span
        before, behind = lines[span.line - 1][: span.column - 1], lines[span.end_line - 1][span.end_column - 1 :]
        lines[span.line - 1 : span.end_line] = (before + edit.text + behind).split("\n")
    return "\n".join(lines)


def like(finding: Diagnostic, others: list[Diagnostic]) -> int:
    key = (finding.rule, finding.message, finding.span.line)
    return sum((other.rule, other.message, other.span.line) == key for other in others)


@pytest.mark.parametrize("rule", sorted(MENDED))
def test_rules_have_edits(rule: str) -> None:
    models = [path for path in MODELS if path.parent.name == rule]
    assert any(finding.rule == rule and finding.edits for path in models for finding in findings(path)[1])


@pytest.mark.parametrize("path", MODELS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_an_edit_mends_its_finding(path: Path) -> None:
    reading, before = findings(path)
    for finding in before:
        if finding.edits and finding.file == str(path):
            text = edited(reading.file.text.content, finding.edits)
            _, after = findings(path, text)
            assert like(finding, after) < like(finding, before), text
            assert "syntax" not in {other.rule for other in after}, text
