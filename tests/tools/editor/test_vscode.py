"""The extension for VS Code agrees with the tool: commands, options, targets, words. Building it is manual."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import pytest

import robosc
from robosc.base.diagnostics import ModelError, as_text
from robosc.language import formatting
from robosc.language.text import Text
from robosc.m2t.targets import TARGETS
from robosc.tools import cli
from robosc.tools.editor.findings import ADD_LIBRARY_FOLDER
from robosc.tools.editor.snippets import for_vscode
from robosc.tools.editor.synthesis import COMMANDS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

ROOT = Path(__file__).parents[3]
EXTENSION = ROOT / "editors" / "vscode"
MANIFEST: Mapping[str, Any] = json.loads((EXTENSION / "package.json").read_text())
SNIPPETS: Mapping[str, Mapping[str, Any]] = json.loads((EXTENSION / "snippets" / "robosc.json").read_text())
ROBOT = "robot that moves while a sensor lets it"
SOURCES = {path.name: path.read_text() for path in sorted((EXTENSION / "src").glob("*.ts"))}


def expanded(snippet: Mapping[str, Any]) -> str:
    """Return the expansion of an unedited snippet: each placeholder's first text, also in its mirrors."""
    text = "\n".join(snippet["body"])
    first: dict[str, str] = {}
    for number, default in re.findall(r"\$\{(\d+):([^}]*)\}", text):
        first.setdefault(number, default)
    text = re.sub(r"\$\{(\d+):[^}]*\}", lambda found: first[found[1]], text)
    return re.sub(r"\$\d+", "", text)


def rules(text: str) -> list[str]:
    """Return the rules that a text violates."""
    try:
        found = robosc.check(robosc.load(text=text))
    except ModelError as error:
        found = error.diagnostics
    return [finding.rule for finding in found]


def test_snippets_are_those_of_the_server(golden: Callable[[Path, str], None]) -> None:
    golden(EXTENSION / "snippets" / "robosc.json", for_vscode())


def test_the_snippet_of_a_robot_is_a_robot() -> None:
    text = expanded(SNIPPETS[ROBOT])
    assert rules(text) == []
    assert formatting.format_edits(Text("robot.rscd", text)) == []


@pytest.mark.parametrize("name", [name for name in SNIPPETS if name != ROBOT])
def test_snippets_are_what_stands_in_a_robot(name: str) -> None:
    assert "syntax" not in rules(f"robot Example {{\n{expanded(SNIPPETS[name])}\n}}\n")


def test_the_problem_matcher_reads_what_check_prints() -> None:
    [matcher] = MANIFEST["contributes"]["problemMatchers"]
    pattern = matcher["pattern"]
    with pytest.raises(ModelError) as raised:
        robosc.load("models/a.rscd", text="robot R {\n  component C from Nowhere import C\n}\n")
    [finding] = raised.value.diagnostics
    found = re.match(pattern["regexp"], as_text.render([finding], {}).splitlines()[0])
    assert found is not None
    told = {name: found[pattern[name]] for name in ("file", "line", "column", "severity", "message", "code")}
    assert told == {
        "file": "models/a.rscd",
        "line": "2",
        "column": "20",
        "severity": "error",
        "message": finding.message,
        "code": finding.rule,
    }


def test_what_is_launched_is_what_the_debugger_takes() -> None:
    [debugger] = MANIFEST["contributes"]["debuggers"]
    keys = debugger["configurationAttributes"]["launch"]["properties"]
    table = (ROOT / "docs" / "debugging.md").read_text().partition("| key |")[2].partition("\n\n")[0]
    told = [name for row in re.findall(r"^\| (`.*?) \|", table, re.MULTILINE) for name in re.findall(r"`(\w+)`", row)]
    assert list(keys) == told


def test_targets() -> None:
    offered = re.search(r"const targets = \[(.*?)\];", SOURCES["extension.ts"], re.DOTALL)
    assert offered is not None
    assert set(re.findall(r'"([^"]+)"', offered[1])) == set(TARGETS)


def test_commands_are_those_that_it_registers() -> None:
    told = {command["command"] for command in MANIFEST["contributes"]["commands"]}
    assert set(re.findall(r'"(robosc\.\w+)": (?:async )?\(', SOURCES["extension.ts"])) == told
    assert {
        called for step in steps() for called in re.findall(r"\(command:(robosc\.\w+)\)", step["description"])
    } <= told


def test_the_server_names_commands_that_it_registers() -> None:
    told = {command["command"] for command in MANIFEST["contributes"]["commands"]}
    assert set(COMMANDS.values()) <= told
    assert f'command === "{ADD_LIBRARY_FOLDER}"' in SOURCES["extension.ts"]


def test_tasks_are_commands_of_the_tool() -> None:
    [task] = MANIFEST["contributes"]["taskDefinitions"]
    assert set(task["properties"]["command"]["enum"]) <= set(cli.main.list_commands(click.Context(cli.main)))


def test_what_the_manifest_names_is_there_or_copied() -> None:
    contributed = MANIFEST["contributes"]
    named = [
        MANIFEST["icon"],
        contributed["languages"][0]["configuration"],
        *(entry["path"] for entry in (*contributed["grammars"], *contributed["snippets"])),
        *(step["media"]["markdown"] for step in steps()),
    ]
    assert [name for name in named if not (EXTENSION / name).is_file()] == []
    [schema] = contributed["jsonValidation"]
    assert Path(schema["url"]).name in (EXTENSION / "copy.mjs").read_text()
    assert (ROOT / "robosc" / "schemas" / Path(schema["url"]).name).is_file()


def steps() -> list[dict[str, Any]]:
    [walkthrough] = MANIFEST["contributes"]["walkthroughs"]
    return list(walkthrough["steps"])


def test_a_folder_that_is_not_trusted_names_no_programs_or_folders() -> None:
    restricted = MANIFEST["capabilities"]["untrustedWorkspaces"]["restrictedConfigurations"]
    settings = MANIFEST["contributes"]["configuration"]["properties"]
    assert set(restricted) == {name for name in settings if name.endswith((".path", ".package", "Paths"))}
    assert len(restricted) == 4


def test_restarts_of_the_server_wait_for_each_other() -> None:
    text = (EXTENSION / "src" / "extension.ts").read_text()
    # Only `restart` stops and starts a client, and only the chain of `serving` calls it.
    assert re.findall(r"\brestart\(context", text) == ["restart(context"] * 3
    assert "serving = serving.then(" in text
