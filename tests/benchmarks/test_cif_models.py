"""The benchmark command for CIF models finds the models in ESCET's scripts and reports each tool without a result."""

from pathlib import Path

import pytest

from benchmarks.cif_models import models, robosc_measured
from benchmarks.cif_models_page import page

ROOT = Path(__file__).parents[2]


def test_models_are_those_that_the_scripts_name(tmp_path: Path) -> None:
    script = 'from "x" import *;\nbenchmark("lamp", "lamps/one", "lamp.cif");\n'
    (tmp_path / "benchmark_lamp.tooldef").write_text(script)
    (tmp_path / "benchmark__base.tooldef").write_text("def benchmark(string name):\nend\n")
    assert models(tmp_path) == {"lamp": tmp_path / "lamps" / "one" / "lamp.cif"}


@pytest.mark.slow
def test_each_is_counted_by_a_process_of_its_own(tmp_path: Path) -> None:
    path = tmp_path / "lamp.cif"
    path.write_text("controllable c; plant P: location a: initial; marked; edge c goto b; location b: marked; end")
    said = robosc_measured(path, 1, 60)
    assert said is not None
    assert said["states"] == 2
    path.write_text("controllable c")
    assert robosc_measured(path, 1, 60) is None


def test_the_page_names_the_models_that_are_slower() -> None:
    def measured(cold: float) -> dict[str, float]:
        written = {"whole": 2 * cold, "guards": 0.25} if cold < 5 else {}
        costs = {"cold": cold, "seconds": cold, "states": 4, "operations": 7, "nodes": 9, "memory": 50}
        return costs | written

    pairs = {"fast": (1, 2), "slow": (3, 2), "endless": (5, None)}
    found = {
        name: {"robosc": measured(ours), "cif": {} if theirs is None else measured(theirs)}
        for name, (ours, theirs) in pairs.items()
    }
    text = page({"escet": 2, "rounds": 1, "seconds": 30.0, "models": found})
    assert "completes 2 of ESCET's 2 models, in 4 s" in text
    assert "slower than CIF's tool on 1 of these 3 models (`slow`)" in text
    assert "With guards, it is slower on 1 (`slow`)." in text
    assert "| fast | 4 | 1.00 | 2.00 | 1.0 | 2.00 | 2.0 | 4.00 | 25% | 7 | 9 | 50 |" in text
    assert "| endless | 4 | 5.00 | over 30 | 5.0 | over 30 | over 30 | over 30 |  | 7 | 9 | 50 |" in text
