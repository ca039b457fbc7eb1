"""Models with faults end in located findings, valid ones in code; `benchmarks/fuzz.py` tries many more."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest

from tests.fuzz.mutants import mutant
from tests.fuzz.trial import called, time_limit, tried
from tests.fuzz.valid import checked, compared, compiled

if TYPE_CHECKING:
    from pathlib import Path

#: Quick to compile, and nothing undefined passes.
FLAGS = ("-O0", "-fsanitize=undefined", "-fno-sanitize-recover=all")
MUTANTS, CALLS, VALID = 250, 25, 12


@pytest.mark.parametrize("first", range(0, MUTANTS, 50))
def test_mutants(tmp_path: Path, first: int) -> None:
    path = tmp_path / "model.rscd"
    for seed in range(first, first + 50):
        path.write_text(mutant(seed), encoding="utf-8")
        with time_limit(60):
            tried(path, ["cif", "supervisor", ("ros1", "ros2", "xmi")[seed % 3]])


def test_calls(tmp_path: Path) -> None:
    path = tmp_path / "model.rscd"
    statuses = set()
    for seed in range(CALLS):
        path.write_text(mutant(seed), encoding="utf-8")
        statuses.add(called(path, seed))
    assert {0, 1} <= statuses


@pytest.mark.skipif(shutil.which("gcc") is None, reason="no C compiler")
def test_valid_robots(tmp_path: Path) -> None:
    robots = [robot for seed in range(VALID) for _, robot in [checked(seed, tmp_path / "robot.rscd")] if robot]
    assert len(robots) > VALID / 2
    built = compiled(robots, tmp_path, FLAGS)
    for each in robots:
        compared(each, built)
