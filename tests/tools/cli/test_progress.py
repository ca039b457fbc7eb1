"""Long work reports its progress, on a terminal only."""

import io
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from robosc.model import sct
from robosc.synthesis import Phase, bdd
from robosc.tools.cli import progress as module
from robosc.tools.cli.progress import progress, show_progress
from tests.sct_models import model, plant

from .conftest import Run


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PATIENCE_SECONDS", 0.02)
    monkeypatch.setenv("TERM", "xterm")


def wait_for(text: str, stream: io.StringIO) -> None:
    deadline = time.monotonic() + 120
    while text not in stream.getvalue():
        assert time.monotonic() < deadline, f"{text!r} was never shown"
        time.sleep(0.01)


def test_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    with progress("thinking hard"):
        wait_for("thinking hard", terminal)
    assert terminal.getvalue().endswith("\x1b[2K")


def test_what_is_quick_is_not_mentioned(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    monkeypatch.setattr(module, "PATIENCE_SECONDS", 120)
    with progress("thinking hard"):
        pass
    assert terminal.getvalue() == ""


def test_not_in_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", file := io.StringIO())
    before = threading.active_count()
    with progress("thinking hard"):
        assert threading.active_count() == before
    assert file.getvalue() == ""


def test_a_failure_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())

    before = set(threading.enumerate())

    def fail() -> None:
        with progress("thinking hard"):
            wait_for("thinking hard", terminal)
            raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        fail()
    said = terminal.getvalue()
    for thread in set(threading.enumerate()) - before:
        thread.join(120)
    assert terminal.getvalue() == said


def test_how_far_a_synthesis_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    monkeypatch.setenv("COLUMNS", "200")
    with show_progress(sct.SupervisoryControlModel()) as statistics:
        wait_for("synthesizing the supervisor", terminal)
        with statistics.during(Phase.FIXPOINT):
            statistics.rounds, statistics.states, statistics.operations, statistics.peak_nodes = 2, 34 * 10**29, 1234, 5
            wait_for("fixpoint, round 2 on 3.4e30 states, 1,234 operations, 5 nodes", terminal)


@pytest.mark.parametrize(
    ("variable", "hint"), [("0..9", "integers smaller ranges"), ("bool", "use fewer states in the model")]
)
def test_too_little_memory(variable: str, hint: str) -> None:
    """The hint mentions integers only if the model has some."""
    given = model([plant("p", {"a": []}, variables={"v": variable})])
    with pytest.raises(MemoryError, match=hint), show_progress(given):
        raise MemoryError


@pytest.fixture
def _pure(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(bdd, "IS_PURE", True)
    module.note_slow_diagrams.cache_clear()
    yield
    module.note_slow_diagrams.cache_clear()


@pytest.mark.usefixtures("_pure")
@pytest.mark.parametrize(
    ("command", "times"),
    [
        (["synthesize"], 1),
        (["synthesize", "--explain-cost"], 1),
        (["explain", "--event=open"], 1),
        (["verify"], 1),
        (["check"], 0),
        (["sweep", "synthesize", "--jobs=1"], 1),
        (["sweep", "check", "--jobs=1"], 0),
    ],
)
def test_slow_diagrams_are_mentioned_once(run: Run, door: Path, command: list[str], times: int) -> None:
    assert run(*command, door).stderr.count("decision diagrams in pure Python: install `oxidd` for speed\n") == times


#: One operation on decision diagrams that takes minutes: all bits of one number, then all of another.
OPERATION = """
import os
import signal
from threading import Timer
from oxidd.bcdd import BCDDManager
from robosc.tools.cli import progress

progress.PATIENCE_SECONDS = 0.02
manager = BCDDManager(1 << 27, 1 << 20, 1)
manager.add_vars(52)
halves = [manager.true(), manager.true()]
for bit in range(26):
    halves[bit // 13] &= manager.var(bit).equiv(manager.var(bit + 26))
with progress.interruptible():
    Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    halves[0] & halves[1]
    print("done")
"""


def test_an_interrupt_amid_an_operation_ends_the_process() -> None:
    done = subprocess.run([sys.executable, "-c", OPERATION], check=False, capture_output=True)
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", b"")
