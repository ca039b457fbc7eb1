"""`verify` refutes no property of the examples, the thesis listings, or their code; the page shows the table."""

import re
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main

from .conftest import MODELS, PAGES, SHOWCASES

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
LISTINGS = ROOT.parent / "shared" / "thesis" / "models"
#: All listings except the one with deliberate faults.
LISTED = [path for path in sorted(LISTINGS.glob("*.rscd")) if path.stem != "language-concepts"]


#: Examples whose control loops take little time; each other one takes seconds.
QUICK = ("supervised_line_follower", "simple_navigation")
CASES = [
    pytest.param(path, id=path.stem, marks=[] if path.stem in QUICK else [pytest.mark.slow])
    for path in (*MODELS.values(), *LISTED)
]


@pytest.mark.parametrize("path", CASES)
def test_all_is_proved(path: Path, verified: Callable[[Path], Any]) -> None:
    said = verified(path)
    assert said["proved"]
    sampled = {answered["property"] for answered in said["properties"] if answered["outcome"] == "sampled"}
    assert {answered["outcome"] for answered in said["properties"]} <= {"proved", "sampled"}
    assert sampled <= {"loop-translation", *(["c-translation", "model-translation"] if path.stem in SHOWCASES else [])}


@pytest.mark.slow
def test_the_page_shows_the_table(
    verified_once: Callable[[Path], Callable[..., Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The page shows the whole table, except for the seconds."""
    page = (ROOT / "docs" / "verify.md").read_text()
    shown = page.partition("$ robosc verify examples/line_follower/line_follower.rscd\n")[2].partition("```")[0]
    monkeypatch.setattr(import_module("robosc.tools.cli.verify"), "verify", verified_once(MODELS["line_follower"]))
    told = CliRunner().invoke(main, ["verify", str(MODELS["line_follower"])])
    assert _without_seconds(shown) == _without_seconds(told.stdout)


#: Examples with properties that `verify` samples instead of proving in all states, as on the page.
SAMPLED = {
    "line_follower": {"loop-translation"},
    "maze_solver": {"loop-translation"},
    "object_finder": {"loop-translation"},
    "obstacle_navigation": {"loop-translation"},
    "person_follower": {"loop-translation"},
    "push_ball": {"loop-translation"},
    "sprayer": {"c-translation", "loop-translation"},
    "supervised_line_follower": {"loop-translation"},
    "warehouse_robot": {"c-translation", "loop-translation", "model-translation"},
}


@pytest.mark.parametrize("path", [case for case in CASES[: len(MODELS)] if case.id in PAGES])
def test_the_page_sums_up_the_examples(path: Path, verified: Callable[[Path], Any]) -> None:
    page = (ROOT / "docs" / "verify-examples.md").read_text()
    name, answered = path.stem, verified(path)["properties"]
    by_name = {verdict["property"]: verdict["evidence"] for verdict in answered}
    row = [name, by_name["controllability"].partition(" state")[0], str(len(by_name))]
    row += [re.findall(r"at most (\d+)", by_name["bounded response"])[0], by_name["c-translation"]]
    assert f"| {' | '.join(row)} |" in page, f"| {' | '.join(row)} |"
    assert {verdict["property"] for verdict in answered if verdict["outcome"] == "sampled"} == SAMPLED.get(name, set())


def test_the_page_shows_what_is_refuted(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "verify.md").read_text()
    model = re.search(r"^```robosc\n(robot Lock .*?)^```", page, re.MULTILINE | re.DOTALL)
    shown = page.partition("The output of `robosc verify lock.rscd` ends with\n\n```\n")[2].partition("```")[0]
    file = tmp_path / "lock.rscd"
    file.write_text(model[1])
    told = CliRunner().invoke(main, ["verify", str(file)])
    assert told.exit_code == 1
    assert told.stdout.endswith(f"┘\n\n{shown}")


def _without_seconds(text: str) -> str:
    return re.sub(r" +\d+\.\d{3} │", "", text)
