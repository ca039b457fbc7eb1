"""Every rule has a page, and the models on it draw the findings that the page shows."""

import re
from pathlib import Path

import pytest

from robosc.base.diagnostics import Diagnostic, Severity
from robosc.base.diagnostics.rules import page, rules, summary
from robosc.language.checks import check
from robosc.language.checks.rule import RULES
from robosc.language.reading import read

#: Rules whose violations are reported before there is a model to check.
READING = {"syntax", "unresolved-reference", "import-cycle", "unique-enum-value"}
CHECKED = sorted({*RULES, *READING})


def models(rule: str, heading: str) -> list[str]:
    text = page(rule)
    assert text is not None
    section = re.split(r"^## ", text, flags=re.MULTILINE)
    (found,) = [part for part in section if part.startswith(f"{heading}\n")]
    return re.findall(r"^```robosc\n(.*?)^```$", found, flags=re.MULTILINE | re.DOTALL)


def findings(folder: Path, texts: list[str], rule: str) -> list[Diagnostic]:
    """Return the findings of the first of several files in one folder; action packages may be unknown."""
    assert texts
    for number, text in enumerate(texts):
        (folder / f"model{number}.rscd").write_text(text)
    reading = read(folder / "model0.rscd")
    found = [*reading.findings, *check(reading.base, reading.findings)]
    return [finding for finding in found if finding.rule != "interface-unknown" or rule == "interface-unknown"]


@pytest.mark.parametrize("rule", CHECKED)
def test_wrong_model_draws_the_rule_alone(rule: str, tmp_path: Path) -> None:
    found = findings(tmp_path, models(rule, "Wrong"), rule)
    assert [finding.rule for finding in found] == [rule]


@pytest.mark.parametrize("rule", CHECKED)
def test_right_model_draws_nothing(rule: str, tmp_path: Path) -> None:
    assert findings(tmp_path, models(rule, "Right"), rule) == []


@pytest.mark.parametrize("rule", CHECKED)
def test_page_names_rule_and_severity(rule: str) -> None:
    text = page(rule)
    assert text is not None
    severity = RULES[rule].severity if rule in RULES else Severity.ERROR
    assert text.startswith(f"# {rule}\n")
    assert f"\nSeverity: {severity}.\n" in text
    assert summary(text).endswith(".")


def test_no_page_without_a_rule() -> None:
    assert set(CHECKED) <= set(rules())


@pytest.mark.parametrize("rule", ["", "nothing", "../architecture", "Type", "type.md"])
def test_unknown_rule_has_no_page(rule: str) -> None:
    assert page(rule) is None
