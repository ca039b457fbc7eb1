"""An interrupt is reported as one at any time, and nothing is written after it."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from robosc.tools.cli import main
from tests.interruptions import interrupted, interruptions

from .conftest import DOOR

#: Run the command line with a reading in `robosc.tools.cli.transform` that is interrupted and hides this: `{hiding}`.
PROGRAM = """
import os, signal, sys
import robosc.tools.cli.transform as transform
read_models = transform.read_models

def read(*arguments, **options):
    try:
        os.kill(os.getpid(), signal.SIGINT)
        import json  # a moment for Python to hear of it
    except KeyboardInterrupt:
        {hiding}
    return read_models(*arguments, **options)

transform.read_models = read
from robosc.tools.cli import run
run()
"""


@pytest.mark.slow
@pytest.mark.parametrize("hiding", ["pass", "raise SyntaxError('interrupted import')", "raise OSError('interrupted')"])
def test_an_interrupt_that_comes_out_otherwise(door: Path, hiding: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(hiding=hiding), "transform", door, "--to", "cif"],
        cwd=door.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (130, "")
    assert [path.name for path in door.parent.iterdir()] == [door.name]


def test_an_ignored_interrupt_stays_ignored(door: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(hiding="pass"), "transform", door, "--to", "cif"],
        cwd=door.parent,
        check=False,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN),
    )
    assert done.returncode == 0
    assert (door.parent / "build" / "Door" / "Door.cif").exists()


@pytest.mark.slow
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_a_command_is_interrupted_at_any_change(tmp_path: Path, sent: signal.Signals) -> None:
    """`format` is the fastest command that writes: the model is the old one or the new one."""
    model = tmp_path / "door.rscd"
    untidy = DOOR.replace("  component", "component")

    def format_model() -> None:
        raise SystemExit(main(["format", str(model)], standalone_mode=False))

    def run(number: int) -> int:
        for stage in tmp_path.glob(".robosc-*"):
            shutil.rmtree(stage)  # each run then makes the same changes
        model.write_text(untidy)
        return interrupted(format_model, number, sent)

    seen = []
    for _, _ in interruptions(run):
        seen.append(model.read_text())
        assert seen[-1] in (untidy, DOOR)
        if sent != signal.SIGKILL:
            assert list(tmp_path.iterdir()) == [model]
    assert {untidy, DOOR} == set(seen)
    assert model.read_text() == DOOR
    assert list(tmp_path.iterdir()) == [model]


#: A compiler that starts a child process, and ends neither it nor itself before robosc receives a signal.
COMPILER = """#!/bin/sh
sleep 1000 &
echo $! > {number}
sleep 0.5
kill -{signal} $PPID
wait
"""


@pytest.mark.slow
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_verify_leaves_neither_files_nor_processes(door: Path, tmp_path: Path, sent: signal.Signals) -> None:
    number, tools, temporary = tmp_path / "number", tmp_path / "tools", tmp_path / "temporary"
    tools.mkdir()
    temporary.mkdir()
    compiler = tools / "cc"
    compiler.write_text(COMPILER.format(number=number, signal=sent.name.removeprefix("SIG")))
    compiler.chmod(0o755)
    done = subprocess.run(
        [sys.executable, "-m", "robosc", "verify", door],
        env={**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "TMPDIR": str(temporary)},
        capture_output=True,
        text=True,
        check=False,
        # `nohup` would make the process ignore one of the signals.
        preexec_fn=lambda: signal.signal(sent, signal.SIG_DFL),
    )
    assert (done.returncode, done.stderr) == (130 if sent == signal.SIGINT else -sent, "")
    assert list(temporary.iterdir()) == []
    # The process was killed: it is gone or a zombie. A busy machine needs a moment for this.
    state = Path("/proc", number.read_text().strip(), "status")
    deadline = time.monotonic() + 120
    while state.exists() and "State:\tZ" not in state.read_text():
        assert time.monotonic() < deadline, "the compiler's process goes on"
        time.sleep(0.05)


def test_an_interrupt_while_the_program_loads_is_no_traceback() -> None:
    program = """
import os, signal, sys
class Interrupting:
    def find_spec(self, name, path=None, target=None):
        if name == "click":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Interrupting())
from robosc.__main__ import run
run()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (-signal.SIGINT, "")
