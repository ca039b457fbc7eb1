"""No walk over a model takes quadratic time. The tests count function calls, not seconds."""

import gc
import sys
import tracemalloc
from math import log, log2
from pathlib import Path

import pytest

import robosc
from benchmarks.walk_families import FAMILIES, write
from robosc.base.diagnostics import Edit, ModelError
from robosc.language import grammar, recovery
from robosc.language.checks import check
from robosc.language.document_symbols import around, folds, outline
from robosc.language.reading import read
from robosc.language.text import Text
from robosc.model import sct

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
SIZES = (25, 75)
#: Largest accepted exponent. Work of order n·log n and fixed costs raise it a little above 1.
MOST = 1.3
#: Largest accepted exponent after subtracting fixed costs.
MOST_WITHOUT_ONCE = 1.1


@pytest.fixture(autouse=True)
def parsed_each_time(monkeypatch):
    """Parse in every measured call, in place of the cache of `tests.conftest.remember_trees`."""
    monkeypatch.setattr(recovery, "parse", grammar.parse)


def calls(work, *arguments):
    """Return the number of calls of functions and built-ins, and the result of the work."""
    count = 0

    def counting(_frame, event, _argument):
        nonlocal count
        count += event in ("call", "c_call")

    # The garbage collector calls finalizers at arbitrary moments, which would change the count.
    gc.disable()
    sys.setprofile(counting)
    try:
        result = work(*arguments)
    finally:
        sys.setprofile(None)
        gc.enable()
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
    """Return the peak of the memory that Python allocates during the work, in bytes."""
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
        reading(path)  # The first call loads and builds everything that later calls reuse.
        counts.append(calls(reading, path)[0])
    assert exponent(*counts) < MOST, counts


def outlining(file):
    return outline(file), folds(file), around(file, 0)


@pytest.mark.parametrize("family", ["operators", "states", "lines"])
def test_outlining(family, tmp_path):
    counts = []
    for number in (4 * size for size in SIZES):
        (tmp_path / str(number)).mkdir()
        path = write(family, number, tmp_path / str(number))
        file = read(path).file
        outlining(file)
        counts.append(calls(outlining, file)[0])
    assert exponent(*counts) < MOST, counts


def test_findings_that_can_be_mended(tmp_path):
    """Each finding with an edit has a position; computing it does not scan the text from its start."""
    counts = []
    for number in (100, 200, 400):
        (tmp_path / str(number)).mkdir()
        base = read(write("topics", number, tmp_path / str(number))).base
        check(base)
        count, found = calls(check, base)
        assert len([finding for finding in found if finding.alternatives]) >= number - 1
        counts.append(count)
    few, more, many = counts
    assert log2((many - more) / (more - few)) < MOST_WITHOUT_ONCE, counts


def test_an_offset_in_a_long_text_copies_nothing():
    text = Text("long.rscd", "\n" * 100_000)
    assert text.offset(1, 1) == 0
    assert memory(text.offset, 1, 1) < 1000


class Copied(str):
    """A string that counts the characters copied out of it."""

    characters = 0

    def __getitem__(self, part):
        piece = Copied(super().__getitem__(part))
        Copied.characters += len(piece)
        return piece

    def __add__(self, other):
        return Copied(super().__add__(other))


def test_many_edits_copy_a_text_once():
    content = Copied("needs\n" * 1000)
    text = Text("long.rscd", content)
    edits = [Edit(text.span(start, start + 1), "N") for start in range(0, len(content), 6)]
    Copied.characters = 0
    assert text.after(edits) == "Needs\n" * 1000
    assert Copied.characters <= len(content)


def test_memory_for_namespaces(tmp_path):
    path = write("namespaces", 4000, tmp_path)
    reading(path)
    assert memory(reading, path) < 50 * path.stat().st_size


def generating(path, *targets):
    robot = robosc.load(path)
    models = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    for target in targets:
        robosc.generate(target, models)


@pytest.mark.parametrize("family", ["provides", "operators"])
def test_generating(family, tmp_path):
    counts = []
    for number in SIZES:
        (tmp_path / str(number)).mkdir()
        path = write(family, number, tmp_path / str(number))
        generating(path, "supervisor", "cif")
        counts.append(calls(generating, path, "supervisor", "cif")[0])
    assert exponent(*counts) < MOST, counts


@pytest.mark.parametrize(
    ("family", "ros"),
    [
        ("components", ("ros1", "ros2", "ros2-layer")),
        ("reactions", ("ros2",)),
        ("states", ("ros1", "ros2-layer")),
        ("topics", ("ros1", "ros2")),
    ],
)
def test_generating_for_ros(family, ros, tmp_path):
    paths = []
    for number in (8, 16, 32):
        (tmp_path / str(number)).mkdir()
        paths.append(write(family, number, tmp_path / str(number)))
    generating(paths[-1], *ros)
    few, more, many = (calls(generating, path, *ros)[0] for path in paths)
    # The differences cancel the fixed parts of a package, which would hide quadratic growth in the exponent.
    assert log2((many - more) / (more - few)) < MOST_WITHOUT_ONCE, (few, more, many)


def test_data_plants_are_as_long_as_the_text(tmp_path):
    model = robosc.to_sct(robosc.load(write("provides", 50, tmp_path)))
    assert sum(1 for element in model.eAllContents() if isinstance(element, sct.Edge)) < 60


def test_thousands_of_lines_after_a_fault(tmp_path):
    counts = []
    for number in SIZES:
        (tmp_path / str(number)).mkdir()
        path = write("lines", number, tmp_path / str(number))
        path.write_text(path.read_text().replace("needs C7.A", "needs needs C7.A"))
        reading(path)
        counts.append(calls(reading, path)[0])
    assert exponent(*counts) < MOST, counts
