"""What takes long is said, on a terminal only."""

import io
import sys
import time

import pytest

from robosc.cli import progress as module
from robosc.cli.progress import progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PATIENCE_SECONDS", 0.02)
    monkeypatch.setenv("TERM", "xterm")


def wait_for(text: str, stream: io.StringIO) -> None:
    deadline = time.monotonic() + 5
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
    with progress("thinking hard"):
        pass
    time.sleep(0.1)
    assert terminal.getvalue() == ""


def test_not_in_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", file := io.StringIO())
    with progress("thinking hard"):
        time.sleep(0.1)
    assert file.getvalue() == ""


def test_a_failure_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())

    def fail() -> None:
        with progress("thinking hard"):
            wait_for("thinking hard", terminal)
            raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        fail()
    said = terminal.getvalue()
    time.sleep(0.2)
    assert terminal.getvalue() == said
