"""The command that times models from CIF finds them by ESCET's scripts, and says where one has no answer."""

from pathlib import Path

import pytest

from benchmarks.cif_models import models, robosc_measured


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
