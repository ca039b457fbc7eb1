"""Every rule that synthesis checks has a page, and the models on it draw the findings that the page shows."""

from pathlib import Path

import pytest

from robosc.analysis.supervise import supervise
from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.base.diagnostics.rules import page, summary
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.m2m import robosc_to_sct
from tests.language.checks.test_rule_pages import models

RULES = {
    "empty-supervisor": Severity.ERROR,
    "cancel-held-back": Severity.ERROR,
    "self-cancelling": Severity.ERROR,
    "never-enabled": Severity.WARNING,
    "silent-restricted": Severity.WARNING,
    "provide-gap": Severity.WARNING,
    "shared-topic-conflict": Severity.WARNING,
    "unrestricted-call": Severity.WARNING,
    "unreachable-state": Severity.WARNING,
    "assumption-unused": Severity.WARNING,
    "goal-never-ends": Severity.WARNING,
    "goal-rejected": Severity.WARNING,
}


def findings(folder: Path, text: str) -> list[Diagnostic]:
    (folder / "model.rscd").write_text(text)
    reading = read(folder / "model.rscd")
    assert [finding for finding in check(reading.base, reading.findings) if finding.severity is Severity.ERROR] == []
    try:
        return supervise(robosc_to_sct.transform(reading.base)[0]).findings
    except ModelError as error:
        return error.diagnostics


@pytest.mark.parametrize("rule", RULES)
def test_wrong_model_draws_the_rule_alone(rule: str, tmp_path: Path) -> None:
    [wrong] = models(rule, "Wrong")
    [finding] = findings(tmp_path, wrong)
    assert (finding.rule, finding.severity) == (rule, RULES[rule])
    assert Path(finding.file).name == "model.rscd"
    assert finding.hint


@pytest.mark.parametrize("rule", RULES)
def test_right_model_draws_nothing(rule: str, tmp_path: Path) -> None:
    [right] = models(rule, "Right")
    assert findings(tmp_path, right) == []


@pytest.mark.parametrize("rule", RULES)
def test_page_names_rule_and_severity(rule: str) -> None:
    text = page(rule)
    assert text is not None
    assert text.startswith(f"# {rule}\n")
    assert f"\nSeverity: {RULES[rule]}. `synthesize` and `transform` find it" in text
    assert summary(text).endswith(".")
