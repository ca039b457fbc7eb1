"""Long expressions need neither a large stack nor a limit of recursion that stays."""

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.walk_families import write
from robosc.semantics.recursion import deep_recursion

ROOT = Path(__file__).parents[2]
#: All of robosc, on a thread with a stack of 512 KiB.
SCRIPT = """
import sys
import threading
import robosc
from robosc.engine.interpreter import Engine
from robosc.semantics.printing import SctPrinter

limit = sys.getrecursionlimit()
done = []

def run():
    robot = robosc.load(sys.argv[1])
    assert robosc.check(robot) == []
    models = robosc.Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(models.sct)
    assert SctPrinter()(models.sct.requirements[0].condition).count("!=") == 900
    for target in ("cif", "supervisor", "ros1", "ros2", "ros2-layer", "xmi"):
        robosc.generate(target, models)
    Engine(models.sct)
    done.append(sys.getrecursionlimit() == limit)

threading.stack_size(512 * 1024)
thread = threading.Thread(target=run)
thread.start()
thread.join()
assert done == [True]
"""


@pytest.mark.slow
def test_a_long_expression_on_a_small_stack(tmp_path):
    path = write("operators", 1800, tmp_path)
    done = subprocess.run([sys.executable, "-c", SCRIPT, path], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]


def test_the_limit_is_set_back_by_the_last_one():
    before = sys.getrecursionlimit()
    with deep_recursion(before + 10):
        with deep_recursion(before + 20):
            assert sys.getrecursionlimit() == before + 20
        assert sys.getrecursionlimit() > before
    assert sys.getrecursionlimit() == before
    with pytest.raises(KeyError), deep_recursion():
        raise KeyError
    assert sys.getrecursionlimit() == before
