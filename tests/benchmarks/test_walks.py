"""No walk over a model takes a time that grows with the square of its length: counted in calls, never in seconds."""

import json
import sys
import tracemalloc
from math import log
from pathlib import Path

import pytest

import robosc
from benchmarks.walk_families import FAMILIES, write
from benchmarks.walks import exponent as slope
from benchmarks.walks import page
from robosc.checks import check
from robosc.diagnostics import ModelError
from robosc.language import Documents, read
from robosc.metamodel import sct

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
SIZES = (30, 120)
#: What grows with n·log n, and what is small beside what is done once, may lie a little above 1.
MOST = 1.3


def calls(work, *arguments):
    """How many functions and built-ins are called; and what came of the work."""
    count = 0

    def counting(_frame, event, _argument):
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(counting)
    try:
        result = work(*arguments)
    finally:
        sys.setprofile(None)
    return count, result


def exponent(few, many):
    return log(many / few) / log(SIZES[1] / SIZES[0])


def reading(path):
    if path.suffix == ".xmi":
        try:
            return check(robosc.load(path))
        except ModelError as error:
            return error.diagnostics
    found = read(path)
    return [*found.findings, *check(found.base, found.findings)]


def memory(work, *arguments):
    """The most bytes that Python had at a time."""
    tracemalloc.start()
    work(*arguments)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return most


@pytest.mark.parametrize("family", FAMILIES)
def test_reading_and_checking(family, tmp_path):
    counts = []
    for number in SIZES:
        (tmp_path / str(number)).mkdir()
        path = write(family, number, tmp_path / str(number))
        reading(path)  # What is loaded and built once is no part of it.
        counts.append(calls(reading, path)[0])
    assert exponent(*counts) < MOST, counts


def test_memory_for_namespaces(tmp_path):
    path = write("namespaces", 4000, tmp_path)
    reading(path)
    assert memory(reading, path) < 50 * path.stat().st_size


def generating(path):
    robot = robosc.load(path)
    models = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    for target in ("supervisor", "cif"):
        robosc.generate(target, models)


@pytest.mark.parametrize("family", ["provides", "operators"])
def test_generating(family, tmp_path):
    counts = []
    for number in SIZES:
        (tmp_path / str(number)).mkdir()
        path = write(family, number, tmp_path / str(number))
        generating(path)
        counts.append(calls(generating, path)[0])
    assert exponent(*counts) < MOST, counts


def test_data_plants_are_as_long_as_the_text(tmp_path):
    model = robosc.to_sct(robosc.load(write("provides", 50, tmp_path)))
    assert sum(1 for each in model.eAllContents() if isinstance(each, sct.Edge)) < 60


def test_the_page_in_the_documentation_is_that_of_the_results():
    results = json.loads((ROOT / "benchmarks" / "walks.json").read_text())
    assert (ROOT / "docs" / "walks.md").read_text() == page(results)
    for family, points in results["families"].items():
        assert slope(points) < MOST, family
        assert slope(points[-2:]) < MOST, f"the two longest of {family}"


def lines(number: int) -> str:
    """A robot of ten lines for each of as many components."""
    parts = [
        f"""component C{i} {{
          outgoing message m{i} with type: none
          incoming message k{i} with type: boolean
          behaviour {{
            variable v: boolean = false
            initial marked state A {{ on response from k{i} do v := value goto B }}
            state B {{ transition if v goto A }}
          }}
        }}
        requirement C{i}.m{i} needs C{i}.A and C{max(i - 1, 0)}.v"""
        for i in range(number)
    ]
    return "\n".join(["robot Long {", *parts, "}", ""])


@pytest.mark.parametrize("broken", [False, True])
def test_a_model_of_thousands_of_lines(broken):
    counts = []
    for number in (1, 100, 400):
        text = lines(number).replace("needs C7.A", "needs needs C7.A" if broken else "needs C7.A")
        documents = Documents({"model.rscd": text})
        read_calls, found = calls(lambda: read("model.rscd", documents=documents))  # noqa: B023
        check_calls, _ = calls(check, found.base, found.findings)
        counts.append(read_calls + check_calls)
    assert log(counts[2] / counts[1]) / log(4) < 1.2
