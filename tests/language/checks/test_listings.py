"""The thesis' eight printed listings draw the findings that the language reference lists."""

from pathlib import Path

import pytest

from robosc.base.diagnostics import Diagnostic, Severity
from robosc.language.checks import check
from robosc.language.reading import read

LISTINGS = Path(__file__).parents[4] / "shared" / "thesis" / "models"
pytestmark = pytest.mark.skipif(not LISTINGS.is_dir(), reason="the printed listings are not beside the repository")


def errors(name: str) -> list[Diagnostic]:
    reading = read(LISTINGS / f"{name}.rscd")
    found = [*reading.findings, *check(reading.base, reading.findings)]
    return [finding for finding in found if finding.severity is Severity.ERROR]


@pytest.mark.parametrize(
    "name",
    [
        "line-follower",
        "line-follower-supervised",
        "maze-solver",
        "object-finder",
        "obstacle-navigation",
        "person-follower",
        "simple-navigation",
    ],
)
def test_scenario_draws_no_error(name: str) -> None:
    assert errors(name) == []


def test_language_concepts_lacks_marked_states() -> None:
    found = errors("language-concepts")
    assert {finding.rule for finding in found} == {"marked-state"}
    assert [finding.message.split("`")[1] for finding in found] == [
        "DistanceSensor.sensing",
        "ObstacleGrabber.idle",
        "ObstacleGrabber.grabbing",
        "LineDetector.no_line",
        "LineDetector.line_found",
    ]
