"""docs/cif-simulator.md is correct: its commands, its event names, and the lines that it adds to the file."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from robosc.tools.cli import main

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "cif-simulator.md").read_text(encoding="utf-8")
MODEL = "examples/line_follower/line_follower.rscd"
PRESSED = 'message_pressed.u_response {"value": true}'


def call(*words: str, given: str = "") -> str:
    """Return the output of a command that succeeds."""
    done = CliRunner().invoke(main, words, input=given)
    assert done.exit_code == 0, done.output
    return done.stdout


@pytest.fixture
def supervised(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the file that the page's first command writes."""
    monkeypatch.chdir(ROOT)
    [command] = re.findall(r"^robosc (transform .*) -o build/cif$", PAGE, re.MULTILINE)
    call(*command.split(), "-o", str(tmp_path))
    return tmp_path / "LineFollower.supervised.cif"


def test_the_inputs_and_events_are_there(supervised: Path) -> None:
    text = supervised.read_text()
    plants = dict(re.findall(r"^plant (\w+):\n(.*?)^end$", text, re.MULTILINE | re.DOTALL))
    for plant, name in re.findall(r"--init=(\w+)\.(\w+):(?:clear|obstructed)", PAGE):
        assert f"input FrontView {name};" in plants[plant]
    for plant, name in re.findall(r"`((?:message|component)_\w+)\.(\w+)`", PAGE):
        assert re.search(rf"controllable {name};", plants[plant])
    assert "CIF counts 384" in text


@pytest.mark.parametrize("option", [[], ["--counts"]])
def test_states_are_counted_as_cif_counts_them(option: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    for inputs, states in (([], 96), (["--count-inputs"], 384)):
        told = json.loads(call("synthesize", MODEL, "--json", *option, *inputs))
        assert (told["controlled_states"], told["uncontrolled_states"]) == (states, states)
        assert call("synthesize", MODEL, *option, *inputs).startswith(f"LineFollower: {states} states, of {states} ")


def test_the_same_steps_on_the_desk(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    [given] = re.findall(r"^printf '%s\\n' (.*) \|$", PAGE, re.MULTILINE)
    events = [event.strip("'") for event in re.findall(r"'[^']*'|\S+", given)]
    script = "\n".join([*events, PRESSED, "message_move.c_trigger"])
    told = [json.loads(line) for line in call("simulate", MODEL, "--script", "-", given=script).splitlines()]
    assert [step["accepted"] for step in told] == [*[True] * len(events), True, False]
    call("explain", MODEL, "--event", "move")


def test_an_input_that_changes(supervised: Path) -> None:
    """The test uses the plants and requirements, since a model with an input has no synthesized supervisor."""
    model = supervised.with_name("LineFollower.cif")
    [plant] = re.findall(r"^```\n(plant world:.*?)```$", PAGE, re.MULTILINE | re.DOTALL)
    [(old, new)] = re.findall(r"replace the line `(.*?)`\s+with\s+`(alg .*?)`", PAGE)
    text = model.read_text()
    assert text.count(old) == supervised.read_text().count(old) == 1
    model.write_text(f"{text.replace(old, new)}\n{plant}")
    # The value of the input is now part of the state.
    assert json.loads(call("synthesize", str(model), "--json"))["controlled_states"] == 384
