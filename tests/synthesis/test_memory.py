"""Memory is bounded as a whole, and exhaustion is reported in one sentence."""

import subprocess
import sys
from pathlib import Path
from time import sleep

import pytest

from robosc.synthesis.memory import limit_memory, resident

ROOT = Path(__file__).parents[2]
MODEL = ROOT / "examples" / "line_follower" / "line_follower.rscd"

pytestmark = pytest.mark.skipif(resident() is None, reason="the system does not tell what a process takes")


def test_whoever_takes_the_memory_is_stopped():
    taken = []

    def grow():
        with limit_memory(1 << 20, "growing"):
            while len(taken) < 4096:
                taken.append(b"x" * (1 << 20))
                sleep(0.001)

    with pytest.raises(MemoryError, match=r"growing needs more than \d+ MiB in total"):
        grow()


def test_nothing_comes_later():
    with limit_memory(1 << 40, "nothing"):
        pass
    assert [number for number in range(100_000)][-1] == 99_999  # noqa: C416  # a loop in which it could come


def test_too_few_addresses_are_told():
    resource = pytest.importorskip("resource")

    def limited():
        resource.setrlimit(resource.RLIMIT_AS, (1_000_000 << 10, 1_000_000 << 10))

    done = subprocess.run(
        [sys.executable, "-m", "robosc", "synthesize", MODEL],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=limited,  # safe: the process forks with one thread
    )
    assert done.returncode == 2
    assert "decision diagrams need" in done.stderr
    assert "`ulimit -v` leaves" in done.stderr
    assert "panicked" not in done.stderr
