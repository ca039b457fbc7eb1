"""Faulty models yield located findings and valid models yield code; `benchmarks/fuzz.py` tries many more."""

from __future__ import annotations

import shutil
from random import Random
from typing import TYPE_CHECKING

import pytest

from tests.fuzz.broken_off import broken_off_tried
from tests.fuzz.cif_mutants import cif_mutant
from tests.fuzz.mutants import mutant
from tests.fuzz.special import COMMANDS, KINDS, tried_with
from tests.fuzz.trial import called, cif_tried, saved_tried, time_limit, tried
from tests.fuzz.valid import checked, compared, compiled

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.slow

#: Flags for a short compile time and for an abort at undefined behavior.
FLAGS = ("-O0", "-fsanitize=undefined", "-fno-sanitize-recover=all")
MUTANTS, SAVED, CALLS, VALID = 50, 25, 12, 5


def test_mutants(tmp_path: Path) -> None:
    path = tmp_path / "model.rscd"
    for seed in range(MUTANTS):
        path.write_text(mutant(seed), encoding="utf-8")
        with time_limit(60):
            tried(path, ["cif", "supervisor", ("ros1", "ros2", "xmi")[seed % 3]])


def test_saved_mutants(tmp_path: Path) -> None:
    statuses = set()
    for seed in range(SAVED):
        with time_limit(60):
            statuses.add(saved_tried(tmp_path, seed))
    assert {0, 1} <= statuses


def test_mutants_of_cif(tmp_path: Path) -> None:
    statuses = set()
    for seed in range(14, 24):
        with time_limit(60):
            statuses.add(cif_tried(tmp_path, cif_mutant(seed)))
    assert {0, 1} <= statuses


def test_commands_that_are_broken_off(tmp_path: Path) -> None:
    statuses = {broken_off_tried(tmp_path, seed) for seed in range(12)}
    assert statuses > {0}


@pytest.mark.parametrize("command", COMMANDS)
def test_what_is_no_file(tmp_path: Path, command: str) -> None:
    # These take seconds each; `benchmarks/fuzz.py` tries them.
    # Each kind meets every second command.
    kinds = sorted(KINDS.keys() - {"many brackets"})
    for number, kind in [*enumerate(kinds)][COMMANDS.index(command) % 2 :: 2]:
        tried_with(tmp_path, command, kind, Random(number))  # noqa: S311 - nothing here is secret


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
    assert len(robots) > VALID / 3
    built = compiled(robots, tmp_path, FLAGS)
    for robot in robots:
        compared(robot, built)
