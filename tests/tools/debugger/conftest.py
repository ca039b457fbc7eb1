"""Sessions with `robosc dap`; a hanging session is ended."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from ..cli.conftest import not_longer_than
from .client import ROOT, OverPort, Program


@pytest.fixture
def program(tmp_path: Path) -> Iterator[Program]:
    """Return a session over standard input and output."""
    with not_longer_than(120):
        started = Program(tmp_path)
        yield started
        started.process.kill()
        started.process.communicate()


@pytest.fixture(scope="session")
def port() -> Iterator[int]:
    """Yield the port of a process that serves all sessions."""
    command = [sys.executable, "-m", "robosc", "dap", "--port", "0"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        yield int(process.stderr.readline().rpartition(" ")[2])
        process.kill()


@pytest.fixture
def session(port: int, tmp_path: Path) -> Iterator[OverPort]:
    """Return a session over the port."""
    with not_longer_than(120):
        client = OverPort(port, tmp_path)
        yield client
        client.close()
