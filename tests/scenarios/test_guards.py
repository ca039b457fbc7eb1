"""A random agent behind the guard of each scenario: the judge, which does not know the model, has no objection."""

from __future__ import annotations

import re
import shutil
from collections import Counter
from typing import TYPE_CHECKING

import pytest

from examples.simulator.engine import load
from examples.simulator.guarding import Tally, guard_scenario, report
from examples.simulator.restless import GUARDED
from examples.simulator.scenarios import SCENARIOS
from examples.simulator.simulation import Simulation
from tests.searching import slow_but

if TYPE_CHECKING:
    from pathlib import Path

EACH = pytest.mark.parametrize("name", slow_but(["line_follower", "supervised_line_follower"], SCENARIOS))
#: Commands of the agent. `benchmarks/guards.py` sends 10,000.
COMMANDS, MOST = 500, 4000
#: Statements without which a guard lets pass what must not pass, or blocks what may pass.
PART = re.compile(r"^  (?:requirement|limit) .*\n(?:    .*\n)*(?:  \}.*\n)?", re.MULTILINE)
#: The parts of each model, with the first scenario that it guards.
PARTS = {
    (guarded.model, part): name
    for name, guarded in reversed(GUARDED.items())
    for part in PART.findall(guarded.model.read_text(encoding="utf-8"))
}
#: A run of all tests omits the first part of each model; `benchmarks/matrix.py` omits the others.
FIRST = {name: part for (_, part), name in reversed(PARTS.items())}


def test_each_scenario_has_a_guard_for_all_its_commands() -> None:
    assert list(GUARDED) == list(SCENARIOS)
    for name, guarded in GUARDED.items():
        world = Simulation(SCENARIOS[name])
        assert {*guarded.judge.commands} == {*world.hears, *world.answers, *world.serves} - {*world.says}


@EACH
def test_nothing_forbidden_reaches_the_world(name: str) -> None:
    tally = guard_scenario(name).run(COMMANDS)
    assert tally.faults == []
    assert tally.reached.total() > 5
    assert tally.withheld.total() > 5


def test_a_trial_is_always_the_same() -> None:
    first, second, other = (guard_scenario("supervised_line_follower", seed).run(200) for seed in (0, 0, 1))
    assert first == second != other


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "part"),
    [
        pytest.param(
            name,
            part,
            id=f"{name}-{' '.join(part.split()[1:3])}",
            marks=[] if part == FIRST[name] else [pytest.mark.matrix],
        )
        for (_, part), name in PARTS.items()
    ],
)
def test_a_missing_part_is_noticed(name: str, part: str, tmp_path: Path) -> None:
    model = GUARDED[name].model
    for library in model.parent.glob("parts.rscd"):
        shutil.copy(library, tmp_path)
    (tmp_path / model.name).write_text(model.read_text(encoding="utf-8").replace(part, ""), encoding="utf-8")
    trial = guard_scenario(name, models=load(tmp_path / model.name))
    assert trial.run(MOST, until=lambda: bool(trial.tally.faults)).faults != []


def test_an_objection_is_printed_and_ends_with_1(capsys: pytest.CaptureFixture[str]) -> None:
    tally = Tally(Counter({"/cmd_vel": 1}), faults=["at 1.00: it must not pass"])
    assert report("wheels", tally) == 1
    assert "1 passed" in capsys.readouterr().out
    assert report("wheels", Tally()) == 0
