"""Verdicts of synthesis arrive while the user types, and refer to the current text."""

import asyncio
import sys
from pathlib import Path

import pytest
from lsprotocol import types

from robosc.tools.editor.answers import Request, Verdict
from robosc.tools.editor.project import Project
from robosc.tools.editor.synthesis import RUNNING, Verdicts, lenses, question
from robosc.tools.editor.verdict import verdict
from tests.analysis.test_causes import TURNS
from tests.tools.editor.server import (
    COMMAND,
    LIBRARY,
    LONGEST,
    ROBOT,
    Editor,
    at,
    findings,
    initialize,
    of,
    open_text,
    position,
    replace,
)

ROBOT_PATH = "/nowhere/cart.rscd"
TEXTS = {ROBOT_PATH: ROBOT, "/nowhere/wheels.rscd": LIBRARY}


def test_what_synthesis_says() -> None:
    said = verdict(Request(ROBOT_PATH, TEXTS, (), ()))
    assert said.robot == "8 states under its supervisor, 8 without requirements"
    line = str(position(ROBOT, "requirement").line + 1)
    assert said.requirements == {line: "restricts the robot in 4 states"}
    assert said.guards == {"Base.drive": ["request: Door.open"]}


def test_no_supervisor() -> None:
    text = ROBOT.replace("provide", "requirement never Door.closed\n  provide")
    said = verdict(Request(ROBOT_PATH, TEXTS | {ROBOT_PATH: text}, (), ()))
    assert said.robot.startswith("no supervisor: the supervisor is empty")


def test_a_cause_counts_its_consequences() -> None:
    path = "/nowhere/drill.rscd"
    lenses_of = verdict(Request(path, {path: TURNS}, (), ())).requirements
    assert lenses_of["29"] == "forbids 4 states; `Spindle.lower` can never be sent; therefore, 5 more findings"


def asked(text: str) -> object:
    project = Project()
    project.put("file:///nowhere/wheels.rscd", 1, LIBRARY)
    path = project.put("file:///nowhere/cart.rscd", 1, text)
    snapshot = project.snapshot()
    return question(snapshot, snapshot.analysis(path))


def test_nothing_is_asked_of_what_has_errors() -> None:
    assert asked(ROBOT.replace("Door.open", "Door.opem")) is None
    assert asked(LIBRARY) is None
    assert asked("") is None


@pytest.mark.asyncio
async def test_a_process_ends_when_its_text_changes() -> None:
    sleeping = "import sys, time; sys.stdin.close(); time.sleep(1000)"
    found = Verdicts([sys.executable, "-c", sleeping], lambda: None)
    first = asked(ROBOT)
    assert found.ask(first, (), ()) is None
    ((_, task),) = found._running.values()
    await asyncio.sleep(0)
    other = asked(ROBOT.replace("0.5", "0.25"))
    assert found.ask(other, (), ()) is None
    with pytest.raises(asyncio.CancelledError):
        await task
    ((_, second),) = found._running.values()
    found.cancel()
    with pytest.raises(asyncio.CancelledError):
        await second
    assert found.lookup(first.path, first.texts) is None


@pytest.mark.asyncio
async def test_a_process_that_fails_is_told() -> None:
    news = asyncio.Event()
    found = Verdicts([sys.executable, "-c", "import sys; sys.stdin.read(); sys.exit(1)"], news.set)
    about = asked(ROBOT)
    assert [lens.command.title for lens in lenses(about, found.ask(about, (), ()))] == [RUNNING]
    await asyncio.wait_for(news.wait(), LONGEST)
    assert found.ask(about, (), ()) == "synthesis failed: `robosc synthesize` shows the error"


def test_lenses_stand_at_names() -> None:
    about = asked(ROBOT)
    line = position(ROBOT, "requirement").line + 1
    shown = lenses(about, Verdict("4 states", {str(line): "matters in no state", "999": "elsewhere"}, {}))
    assert [(of(ROBOT, lens.range), lens.command.title) for lens in shown] == [
        ("Cart", "4 states"),
        ("R1", "matters in no state"),
    ]


def test_what_an_editor_can_do_with_a_robot() -> None:
    shown = lenses(asked(ROBOT), None, "file:///nowhere/cart.rscd", commands=True)
    assert [(lens.command.title, lens.command.command, lens.command.arguments) for lens in shown[1:]] == [
        ("simulate", "robosc.debug", ["file:///nowhere/cart.rscd"]),
        ("run", "robosc.run", ["file:///nowhere/cart.rscd"]),
        ("verify", "robosc.verify", ["file:///nowhere/cart.rscd"]),
    ]


@pytest.mark.slow
@pytest.mark.asyncio
async def test_over_the_protocol(tmp_path: Path) -> None:
    (tmp_path / "wheels.rscd").write_text(LIBRARY)
    client = Editor()
    await client.start_io(*COMMAND)
    await initialize(client, tmp_path)
    uri = open_text(client, tmp_path / "cart.rscd", ROBOT)
    assert await findings(client, uri, 1) == []
    about = types.CodeLensParams(types.TextDocumentIdentifier(uri))
    assert [lens.command.title for lens in await client.text_document_code_lens_async(about)] == [RUNNING]
    await asyncio.wait_for(client.refreshed.wait(), LONGEST)
    titles = [lens.command.title for lens in await client.text_document_code_lens_async(about)]
    assert titles == ["8 states under its supervisor, 8 without requirements", "restricts the robot in 4 states"]
    hover = await client.text_document_hover_async(types.HoverParams(**at(uri, position(ROBOT, "drive needs", 1))))
    assert "The supervisor allows its\n- request: Door.open" in hover.contents.value
    replace(client, uri, 2, ROBOT.replace("needs Door.open", "needs Door.open or Door.closed"))
    # The results of another text are not shown.
    assert [lens.command.title for lens in await client.text_document_code_lens_async(about)] == [RUNNING]
    hover = await client.text_document_hover_async(types.HoverParams(**at(uri, position(ROBOT, "drive needs", 1))))
    assert "The supervisor allows" not in hover.contents.value
    await client.shutdown_session()
    await client.stop()
