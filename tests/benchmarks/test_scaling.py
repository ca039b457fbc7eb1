"""The scaling benchmark runs from the models to the page; the tests do not depend on the measured times."""

import json
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from benchmarks.families import FAMILIES
from benchmarks.scaling import disagreements
from benchmarks.scaling_page import TARGETS, growth, plots
from robosc.synthesis import Phase

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent.parent


@pytest.fixture(scope="module")
def quick(tmp_path_factory):
    folder = tmp_path_factory.mktemp("benchmarks")
    command = [sys.executable, ROOT / "benchmarks" / "scaling.py", "--quick", "--families", "services"]
    done = subprocess.run([*command, "--output", folder], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


def test_the_command_measures_every_phase(quick):
    results = json.loads((quick / "scaling.json").read_text())
    tools = results["families"]["services"]
    assert set(tools) == {"robosc", "definition", *(["faudes"] if find_spec("faudes") else [])}
    for measured in tools.values():
        assert [point["states"] for point in measured] == [
            FAMILIES["services"].states(point["n"]) for point in measured
        ]
    for point in (*tools["robosc"], *results["transform"]):
        assert point["finished"]
        assert {*Phase, *TARGETS, "parse", "link", "check", "m2m"} == point["phases"].keys()
    assert results["transform"][0]["bytes"] > 0


def test_the_command_writes_the_page_and_the_plots(quick):
    text = (quick / "benchmarks.md").read_text()
    assert "come from two shared cores" in text
    assert "| N services sharing a resource | 4 |" in text
    assert (quick / "benchmarks-families.svg").exists() == bool(find_spec("matplotlib"))


def test_a_limit_ends_a_series(tmp_path):
    command = [sys.executable, ROOT / "benchmarks" / "scaling.py", "--families", "warehouse", "--tools", "definition"]
    done = subprocess.run([*command, "--limit", "4", "--output", tmp_path], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    *finished, last = json.loads((tmp_path / "scaling.json").read_text())["families"]["warehouse"]["definition"]
    assert all(point["finished"] for point in finished)
    assert not last["finished"]
    assert "states" not in last


def test_plots_are_the_same_each_time(quick):
    pytest.importorskip("matplotlib")
    results = json.loads((quick / "scaling.json").read_text())
    assert plots(results) == plots(results)


def test_disagreements_are_found():
    ours, theirs = ({"n": 2, "states": 15, "uncontrolled": number} for number in (22, 23))
    wrong = {"n": 4, "states": 242, "uncontrolled": 484}
    results = {"families": {"services": {"robosc": [ours, wrong], "faudes": [theirs]}}}
    assert list(disagreements(results)) == [
        "services 4: robosc finds 242 states, the formula says 243",
        "services 2: faudes reaches 23 states, robosc 22",
    ]


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({n: 3 * n**2 for n in (2, 4, 8, 16)}, "N^2.0"),
        ({n: 5 * 3**n for n in (2, 3, 4, 6)}, "3.00^N"),
        (dict.fromkeys((1, 2, 3), 7), "N^0.0"),
        ({1: 1, 2: 2}, "-"),
    ],
)
def test_growth(values, text):
    assert growth([{"n": n, "value": value} for n, value in values.items()], lambda point: point["value"]) == text
