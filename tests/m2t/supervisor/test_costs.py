"""The engine's promises on its cost (docs/engine.md): counts that are the same on every machine."""

import re
import shutil
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

import robosc
from benchmarks.engine_costs import Costs, measured, stack
from benchmarks.families import FAMILIES
from robosc.m2m.sct_to_engine import POLLED
from robosc.model import sct

pytestmark = pytest.mark.build

DISPATCH = 64
#: The maximum stack of any engine, whatever its number of events.
STACK = {"x86-64": 360, "Cortex-M3": 240}


def _model(cells: int, folder: Path) -> sct.SupervisoryControlModel:
    path = folder / "cells.rscd"
    path.write_text(FAMILIES["cells"].text(cells))
    made = robosc.to_sct(robosc.load(path))
    robosc.synthesize(made)
    return made


@cache
def _costs(cells: int) -> Costs:
    with TemporaryDirectory() as folder:
        return measured(_model(cells, Path(folder)), Path(folder))


@pytest.fixture(params=[1, 5, 20], ids=["17 events", "85 events", "340 events"])
def costs(request: pytest.FixtureRequest) -> Costs:
    return _costs(request.param)


def _counted(costs: Costs) -> Costs:
    if shutil.which("valgrind") is None:
        pytest.skip("valgrind is not installed")
    assert costs.perform is not None
    return costs


def test_the_dispatch_of_an_event_does_not_grow_with_their_number(costs: Costs) -> None:
    most = _counted(costs).perform.most
    # An event that moves a plant costs more than this: the bound detects a walk without events.
    assert 20 < most <= DISPATCH


def test_an_idle_tick_does_not_grow_with_the_number_of_events() -> None:
    medium, large = _counted(_costs(5)), _counted(_costs(20))
    assert medium.events > POLLED
    assert large.events == 4 * medium.events
    assert large.idle <= 1.1 * medium.idle
    assert large.batch.mean <= 1.5 * medium.batch.mean


def test_what_happens_in_a_tick_is_within_its_bound(costs: Costs) -> None:
    assert 1 <= costs.steps.most <= costs.bound


def test_the_stack_does_not_grow_with_the_number_of_events(costs: Costs) -> None:
    for target, size in costs.sizes.items():
        assert 0 < size.stack <= STACK[target]
        assert size.data == size.bss == 0


def test_the_stack_is_that_of_the_deepest_calls() -> None:
    graph = "\n".join(
        [f'node: {{ title: "{name}" label: "{name}\\na.c:1:1\\n{used} bytes (static)" }}' for name, used in
         (("a", 8), ("a.c:b", 16), ("a.c:c", 100), ("a.c:d", 24))]
        + [f'edge: {{ sourcename: "{caller}" targetname: "{called}" label: "x" }}' for caller, called in
           (("a", "a.c:b"), ("a.c:b", "a.c:c"), ("a.c:b", "__indirect_call"), ("a.c:d", "a.c:b"))]
    )  # fmt: skip
    assert stack(graph) == 24 + 16 + 100
    with pytest.raises(RecursionError):
        stack(graph + '\nedge: { sourcename: "a.c:c" targetname: "a" }')


def test_the_page_keeps_its_aims() -> None:
    """The page has the benchmark's tables, which meet its aim for cells of every size."""
    text = (Path(__file__).parents[3] / "docs" / "engine.md").read_text()
    cells = [line.split("|") for line in text.splitlines() if re.match(r"\| \d+ independent cells", line)]
    performs = [int(row[4]) for row in cells if len(row) == 13]
    assert len(performs) >= 4
    assert max(performs) <= DISPATCH
