"""Operations and peak nodes of synthesis are pinned: they are the same on every run and every machine.

`pytest tests/synthesis/test_costs.py --accept` accepts new numbers. ROBOSC_ESCET_BENCHMARKS names the folder with the
models that Eclipse ESCET uses to time synthesis. They are not part of this repository; `benchmarks/cif_models.py` gives
their source.
"""

import os
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

import robosc
from benchmarks.cif_models import models
from benchmarks.costs import INTERFACES, counted, robots
from benchmarks.dcs_families import FAMILIES
from benchmarks.requirement_costs import KINDS, synthesis_of
from robosc.synthesis import synthesize

HERE = Path(__file__).parent
EXAMPLES = HERE.parent.parent / "examples"
ESCET = "ROBOSC_ESCET_BENCHMARKS"

#: Instances of the families of directed controller synthesis that take about a second.
_INSTANCES = [
    ("AT", 5, 5),
    ("BW", 15, 15),
    ("CM", 3, 3),
    ("DP", 10, 10),
    ("TA", 10, 10),
    ("TL", 8, 8),
    ("CLUSTER", 15, 1),
    ("LINE", 10, 5),
]

Golden = Callable[[Path, str], None]
#: The name of a model, its operations and its peak nodes.
Row = tuple[str, int, int]


def table(rows: Iterable[Row]) -> str:
    head = "| model | operations | peak nodes |\n|---|---:|---:|\n"
    return head + "".join(f"| {name} | {operations:,} | {nodes:,} |\n" for name, operations, nodes in rows)


def count_row(name: str, path: Path) -> Row:
    costs = counted(path)
    return name, costs["operations"], costs["nodes"]


@pytest.mark.slow
def test_robots_of_the_families(golden: Golden, tmp_path: Path) -> None:
    path = tmp_path / "robot.rscd"

    def row(name: str, text: str) -> Row:
        path.write_text(text, encoding="utf-8")
        return count_row(name, path)

    golden(HERE / "costs" / "families.md", table(row(name, text) for name, text in robots().items()))


def test_examples_and_kinds_of_requirements_with_their_guards(golden: Golden) -> None:
    rows = []
    for path in sorted(EXAMPLES.glob("*/*.rscd")):
        if any(line.startswith("robot ") for line in path.read_text(encoding="utf-8").splitlines()):
            statistics = synthesize(robosc.to_sct(robosc.load(path, (), [INTERFACES]))).statistics
            rows.append((path.stem, statistics.operations, statistics.peak_nodes))
    for kind in KINDS:
        statistics = synthesis_of(10, kind).statistics
        rows.append((f"10 stations, {kind}", statistics.operations, statistics.peak_nodes))
    golden(HERE / "costs" / "synthesis.md", table(rows))


@pytest.mark.slow
def test_families_of_directed_controller_synthesis(golden: Golden, tmp_path: Path) -> None:
    path = tmp_path / "instance.cif"

    def row(family: str, n: int, k: int) -> Row:
        path.write_text(FAMILIES[family].instance(n, k).text, encoding="utf-8")
        return count_row(f"{family}_{n}_{k}", path)

    golden(HERE / "costs" / "dcs.md", table(row(*instance) for instance in _INSTANCES))


def test_models_of_escet(golden: Golden) -> None:
    folder = os.environ.get(ESCET)
    if not folder:
        pytest.skip(f"{ESCET} names no folder with ESCET's benchmark models")
    found = models(Path(folder))
    assert found, f"{folder} has no benchmark_*.tooldef"
    golden(HERE / "costs" / "escet.md", table(count_row(name, path) for name, path in found.items()))
