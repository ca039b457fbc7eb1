"""The guards of the gallery: short, shown on their page, and in front of a random agent with a judge of their own."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from click.testing import CliRunner

from examples.guards.command import FOLDER, model_of, trial_of
from examples.guards.gallery import GALLERY
from examples.simulator.engine import load
from robosc.tools.cli import main

if TYPE_CHECKING:
    from pathlib import Path

EACH = pytest.mark.parametrize("name", GALLERY)
PAGE = FOLDER.parents[1] / "docs" / "guards.md"
#: Commands of the agent: enough for each to pass and to be blocked; enough for each missing part to be noticed.
COMMANDS, MOST = 400, 3000
#: Statements without which a guard lets pass what must not pass, or blocks what may pass.
PART = re.compile(r"^  (?:requirement|limit) .*\n(?:    .*\n)*(?:  \}.*\n)?|^ *after .*\n", re.MULTILINE)


def text_of(name: str) -> str:
    return model_of(name).read_text(encoding="utf-8")


def test_there_are_twelve() -> None:
    assert len(GALLERY) == 12
    assert {*GALLERY} == {model.stem for model in FOLDER.glob("*/*.rscd")}


@EACH
def test_a_guard_is_short_and_on_the_page(name: str) -> None:
    text = text_of(name)
    assert len([line for line in text.splitlines() if line.strip()]) <= 20
    page = PAGE.read_text(encoding="utf-8")
    assert f"```robosc\n{text}```" in page
    assert f"](../examples/guards/{name})" in page


@EACH
def test_nothing_is_wrong(name: str, tmp_path: Path) -> None:
    path = model_of(name)
    done = CliRunner().invoke(main, ["transform", str(path), "--to", "ros2-layer", "-o", str(tmp_path)])
    assert (done.exit_code, done.output.count("\n")) == (0, 1), done.output
    done = CliRunner().invoke(main, ["test", str(path), str(path.with_suffix(".scenarios"))])
    assert done.exit_code == 0, done.output


@EACH
def test_a_random_agent_is_guarded(name: str) -> None:
    """Only permitted commands reach the world, all permitted ones do, and nothing dangerous happens there."""
    tally = trial_of(name).run(COMMANDS)
    assert tally.faults == []
    assert tally.commands == COMMANDS
    free = {"/teleop/cmd_vel"}
    assert {command for command, count in tally.reached.items() if count} == {*GALLERY[name][1].commands}
    assert {command for command, count in tally.withheld.items() if count} == {*GALLERY[name][1].commands} - free


def test_a_trial_is_always_the_same() -> None:
    first, second, other = (trial_of("stop_button", seed).run(200) for seed in (0, 0, 1))
    assert first == second != other


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "part"),
    [
        pytest.param(name, part, id=f"{name}-{part.split()[1]}")
        for name in GALLERY
        for part in PART.findall(text_of(name))
    ],
)
def test_a_missing_part_is_noticed(name: str, part: str, tmp_path: Path) -> None:
    model = tmp_path / model_of(name).name
    model.write_text(text_of(name).replace(part, ""), encoding="utf-8")
    trial = trial_of(name, models=load(model))
    assert trial.run(MOST, until=lambda: bool(trial.tally.faults)).faults != []
