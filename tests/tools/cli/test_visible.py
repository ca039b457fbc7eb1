"""Texts of models, paths and arguments: no output controls a terminal, hides characters, or forges lines."""

from __future__ import annotations

import json
import re
from pathlib import Path
from xml.etree.ElementTree import fromstring

import pytest

from robosc.base.diagnostics.visible import HIDDEN, code, visible, visible_lines
from robosc.tools import cli
from tests.tools.cli.conftest import DOOR, Run

CODES = [number for first, last in HIDDEN for number in {first, (first + last) // 2, last}]
#: Every kind of hidden character, except line breaks and tabs.
HOSTILE = "".join(chr(number) for number in CODES if number not in (0, 9, 10, 13)) + "\x1b[31m\u202e\x85"


def hidden(text: str) -> set[str]:
    """Return the characters of a text that must not be printed."""
    return {character for character in text if visible(character) != character} - {"\n", "\t"}


@pytest.mark.parametrize("number", CODES)
def test_hidden_characters_show_their_code(number: int) -> None:
    shown = visible(f"a{chr(number)}b")
    assert shown.isprintable()
    assert json.loads(f'"{shown}"') == f"a{chr(number)}b"


def test_what_can_be_seen_stays() -> None:
    assert visible("größer 漢字 🤖 \\u202e") == "größer 漢字 🤖 \\u202e"
    assert visible_lines("one\n\ttwo\r\n\u2028") == "one\n\ttwo\\u000d\n\\u2028"
    assert code("\U000e0041") == "\\udb40\\udc41"


@pytest.fixture
def hostile(tmp_path: Path) -> Path:
    """Return a robot with hidden characters in comments, strings and its file's name."""
    file = tmp_path / f"do{HOSTILE.replace('/', '')[:40]}or.rscd"
    text = DOOR.replace(
        "    behaviour {\n", f'    behaviour {{ variable s: string = "{HOSTILE}" // {HOSTILE}\n      state lost {{}}\n'
    )
    file.write_text(text.replace("needs Leaf.closed", f"/* {HOSTILE} */ needs Leaf.closed"), encoding="utf-8")
    return file


@pytest.fixture
def broken_hostile(hostile: Path) -> Path:
    """Return the same robot with errors on such lines, one of which concerns such a text."""
    text = hostile.read_text(encoding="utf-8").replace("needs Leaf.closed", "needs Leaf.clsed")
    hostile.write_text(text.replace("variable s: string", "variable s: integer"), encoding="utf-8")
    return hostile


CALLS = (
    "synthesize",
    "explain --event open",
    "explain --why-never close",
    "verify",
    "simulate --random 3",
    "simulate",
    "format --check",
    "format --diff",
    "transform --to cif,ros2",
    "diagram",
    "diagram --kind plants --format dot",
    "diagram --kind ros-graph --format svg",
    f"explain --event open{HOSTILE}",
    f"explain --event open --state Leaf=open{HOSTILE}",
    f"transform --to cif{HOSTILE}",
    f"transform --to cif -o /dev/null/{HOSTILE}",
    f"check --{HOSTILE}",
    f"{HOSTILE}",
)


@pytest.mark.parametrize("call", CALLS, ids=lambda call: re.sub(r"[^ -~]+", "…", call))
def test_no_command_prints_what_is_hidden(run: Run, hostile: Path, call: str) -> None:
    command, *rest = call.split(" ")
    answer = run(command, hostile, *rest)
    assert answer.exit_code != 70
    assert answer.output
    assert not hidden(answer.output)


@pytest.mark.parametrize("command", ["check", "synthesize", "verify", "diagram", "simulate", "run --ros2"])
def test_findings_show_none_of_it(run: Run, broken_hostile: Path, command: str) -> None:
    command, *rest = command.split()
    answer = run(command, broken_hostile, *rest)
    assert answer.exit_code == 1
    assert "2 errors" in answer.output
    assert not hidden(answer.output)


def test_options_of_the_program_itself(run: Run) -> None:
    answer = run(f"--{HOSTILE}")
    assert answer.exit_code == 2
    assert not hidden(answer.output)


@pytest.mark.parametrize("feature", ["origin", "text"])
@pytest.mark.parametrize("value", ["a&#10;forged", "\x9b31m", "\u2028", "\u202e"])
def test_a_saved_model_forges_no_lines(run: Run, tmp_path: Path, door: Path, feature: str, value: str) -> None:
    run("transform", door, "--to", "xmi", "-o", tmp_path)
    saved = tmp_path / "Door.sct.xmi"
    text = re.sub(rf' {feature}="[^"]*"', f' {feature}="{value}"', saved.read_text(encoding="utf-8"))
    saved.write_text(text, encoding="utf-8")
    answer = run("explain", saved, "--event", "open")
    assert answer.exit_code == 1
    assert f"'{feature}' must be one line" in answer.output
    assert not hidden(answer.output)
    assert not re.search(r"^forged", answer.output, re.MULTILINE)


@pytest.mark.parametrize("form", ["json", "sarif"])
def test_forms_for_programs_escape_it(run: Run, broken_hostile: Path, form: str) -> None:
    answer = run("check", broken_hostile, "--format", form)
    assert answer.output.isascii()
    assert json.loads(answer.stdout)


def test_junit_is_xml(run: Run, hostile: Path, tmp_path: Path) -> None:
    answer = run("verify", hostile, "--junit", tmp_path / "verify.xml")
    assert answer.exit_code == 0, answer.output
    text = (tmp_path / "verify.xml").read_text(encoding="utf-8")
    assert fromstring(text).tag == "testsuites"  # noqa: S314 - our own
    assert not hidden(text)


def test_commands_print_through_one_module() -> None:
    texts = {path.name: path.read_text(encoding="utf-8") for path in Path(cli.__file__).parent.glob("*.py")}
    # Three of them print tables and pages with rich.
    printing = {name for name, text in texts.items() if re.search(r"click\.s?echo|\bprint\(", text)}
    assert printing == {"__init__.py", "rule.py", "sweep.py", "verify.py"}
