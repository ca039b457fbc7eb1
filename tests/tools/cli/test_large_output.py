"""A model with a thousand faults on one line: the output stays readable and small."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from robosc.base.diagnostics import Diagnostic, Severity, Span, as_text

if TYPE_CHECKING:
    from pathlib import Path

    from tests.tools.cli.conftest import Run

FAULTS = 1000


@pytest.mark.slow
def test_a_line_with_a_thousand_faults(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "line.rscd"
    file.write_text(f"robot R {{{'component A { x } ' * FAULTS}}}", encoding="utf-8")
    answer = run("check", file)
    assert answer.exit_code == 1
    assert len(answer.output) < 100_000
    assert all(len(line) < 300 for line in answer.output.split("\n"))
    everything = json.loads(run("check", file, "--format", "json").stdout)
    assert f"{len(everything) - as_text.MOST} more are not shown" in answer.output
    assert f"{len(everything)} errors" in answer.output
    assert len(everything) >= FAULTS


def test_errors_are_shown_before_warnings() -> None:
    span = Span(1, 1, 1, 2)
    found = [Diagnostic("a", span, Severity.WARNING, "x", f"{number}") for number in range(as_text.MOST)]
    shown = as_text.render([*found, Diagnostic("b", span, Severity.ERROR, "y", "wrong")], {})
    assert shown.count("warning:") == as_text.MOST - 1
    assert shown.index("warning:") < shown.index("b:1:1: error: wrong")
    assert shown.endswith("\n1 more are not shown: `robosc check --format json` prints all\n")


def test_a_long_message_is_cut() -> None:
    finding = Diagnostic("a", Span(1, 1, 1, 2), Severity.ERROR, "x", "m" * 100_000, "h" * 100_000)
    assert len(as_text.render([finding], {})) < 10_000


@pytest.mark.slow
def test_a_number_of_states_with_thousands_of_digits(tmp_path: Path) -> None:
    level = f"integer(0..{10**18})"
    parts = [
        f"component C{number} {{ outgoing message m{number} with type: {level}"
        f" behaviour {{ variable height: {level} = 0"
        f" initial marked state there {{ on response from m{number} do height := value }} }} }}"
        f" requirement go needs C{number}.height > 5"
        for number in range(240)
    ]
    file = tmp_path / "many.rscd"
    file.write_text(f"robot R {{ component B {{ incoming message go with type: none }} {' '.join(parts)} }}")
    command = [sys.executable, "-m", "robosc", "synthesize", "--counts", "--json", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert re.search(r'"uncontrolled_states": 1\d{4320},', done.stdout)
