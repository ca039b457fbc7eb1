"""Long expressions need neither a large stack nor a higher recursion limit than Python's default."""

import subprocess
import sys
from pathlib import Path

import pytest

import robosc
from benchmarks.walk_families import write

ROOT = Path(__file__).parents[3]
#: Run all of robosc on a thread with a stack of 512 KiB.
SCRIPT = """
import sys
import threading
from pathlib import Path

from click.testing import CliRunner

import robosc
from robosc.tools.cli import main
from robosc.engine.interpreter import Engine
from robosc.model.semantics.printing import SctPrinter
from robosc.model.validity import load

limit = sys.getrecursionlimit()
done = []

def run():
    path = Path(sys.argv[1])
    robot = robosc.load(path)
    assert robosc.check(robot) == []
    models = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    assert SctPrinter()(models.sct.requirements[0].condition).count("!=") == 550
    for target in ("cif", "supervisor", "ros1", "ros2", "ros2-layer"):
        robosc.generate(target, models)
    for name, text in robosc.generate("xmi", models).items():
        (path.parent / name).write_text(text)
    load(str(path.parent / "Long.sct.xmi"))
    Engine(models.sct)
    for command in (["explain", "--why-never", "message_stop.c_trigger"], ["verify"]):
        outcome = CliRunner().invoke(main, [*command, str(path)])
        assert outcome.exception is None or isinstance(outcome.exception, SystemExit), outcome.exception
    done.append(sys.getrecursionlimit() == limit)

threading.stack_size(512 * 1024)
thread = threading.Thread(target=run)
thread.start()
thread.join()
assert done == [True]
"""


@pytest.mark.slow
def test_a_long_expression_on_a_small_stack(tmp_path: Path) -> None:
    path = write("operators", 1100, tmp_path)
    done = subprocess.run([sys.executable, "-c", SCRIPT, path], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]


@pytest.mark.slow
@pytest.mark.parametrize("operator", ["=>", "or", "="])
def test_chains_of_either_associativity(operator: str) -> None:
    condition = f" {operator} ".join(["Lamp.lit"] * 2000)
    robot = robosc.load(
        text="robot Long { component Lamp { outgoing message lit_up with identifier: '/lit', type: none"
        " incoming message ring with identifier: '/ring', type: none behaviour { initial marked state lit {"
        f" on response from lit_up goto lit }} }} }} requirement ring needs {condition} }}"
    )
    models = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    assert robosc.generate("cif", models)
    assert robosc.generate("supervisor", models)
