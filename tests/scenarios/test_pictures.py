"""The pictures in the docs match the runs, and pages show all of them."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from examples.simulator.picture import picture
from examples.simulator.scenarios import SCENARIOS
from tests.scenarios.runs import run_of
from tests.searching import slow_but

ROOT = Path(__file__).parents[2]
#: The group shares the runs of the scenarios.
pytestmark = pytest.mark.xdist_group("scenarios")
EACH = pytest.mark.parametrize("name", slow_but(["line_follower", "push_ball", "supervised_line_follower"], SCENARIOS))


@EACH
def test_pictures_are_up_to_date(name: str, golden) -> None:
    golden(ROOT / "docs" / "simulator" / f"{name}.svg", picture(run_of(name).simulation))
    assert f"](simulator/{name}.svg)" in (ROOT / "docs" / "simulator.md").read_text()
    assert f"](../../docs/simulator/{name}.svg)" in (ROOT / "examples" / name / "README.md").read_text()


@EACH
def test_a_picture_shows_all_that_happened(name: str) -> None:
    run = run_of(name)
    drawing = ElementTree.fromstring(picture(run.simulation))  # noqa: S314  # our own
    texts = [node.text or "" for node in drawing.iter("{http://www.w3.org/2000/svg}text")]
    assert [
        happening.words for happening in run.simulation.happenings if not any(happening.words in text for text in texts)
    ] == []
    assert len(list(drawing.iter("{http://www.w3.org/2000/svg}line"))) == len(run.simulation.world.walls) + 1
