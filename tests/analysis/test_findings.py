"""Models draw the findings that their first line names, with the golden messages."""

import re
from pathlib import Path

import pytest

from robosc.analysis.supervise import supervise
from robosc.base.diagnostics import Diagnostic, Severity, as_text, in_order
from robosc.language.checks import check
from robosc.language.reading import read
from robosc.m2m import robosc_to_sct
from robosc.tools.cli.report import Report

MODELS = Path(__file__).parent / "models"
ROBOTS = sorted(path for path in MODELS.glob("*.rscd") if path.name != "parts.rscd")
LISTINGS = Path(__file__).parents[4] / "shared" / "thesis" / "models"


def findings(model: Path) -> tuple[list[Diagnostic], dict[str, str]]:
    """Return the findings of synthesis with the paths that the command line shows."""
    reading = read(model)
    errors = [*reading.findings, *check(reading.base, reading.findings)]
    assert [error for error in errors if error.severity is Severity.ERROR] == []
    report = Report()
    report.add(supervise(robosc_to_sct.transform(reading.base)[0]).findings, reading.texts)
    return in_order(report.findings), reading.texts


@pytest.mark.parametrize("model", ROBOTS, ids=lambda path: path.stem)
def test_a_model_draws_what_it_says(model: Path) -> None:
    expected = re.match(r"// expect:(?: (.+))?\n", model.read_text())
    assert expected
    found = [
        f"{finding.rule} {'' if finding.file == str(model) else Path(finding.file).name + ':'}{finding.span.line}"
        for finding in findings(model)[0]
    ]
    assert sorted(found) == sorted((expected[1] or "").replace(", ", "\n").splitlines())


def test_wording(golden) -> None:
    shown = [as_text.render(*findings(model)).replace(f"{MODELS}/", "") for model in ROBOTS]
    golden(MODELS / "findings.txt", "\n".join(filter(None, shown)))


@pytest.mark.skipif(not LISTINGS.is_dir(), reason="the printed listings are not beside the repository")
@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("line-follower", []),
        ("line-follower-supervised", []),
        ("maze-solver", []),
        ("object-finder", []),
        ("obstacle-navigation", []),
        # It may move while a person is in front of it, and must halt then: the printed requirements permit both.
        ("person-follower", ["shared-topic-conflict"]),
        ("simple-navigation", []),
    ],
)
def test_the_printed_listings(name: str, expected: list[str]) -> None:
    assert [finding.rule for finding in findings(LISTINGS / f"{name}.rscd")[0]] == expected
