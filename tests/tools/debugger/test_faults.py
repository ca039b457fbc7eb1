"""Malformed, misordered or wrong requests are answered with an error, and the session continues if possible."""

import asyncio
import json
import os
import re
import signal
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import robosc
from robosc.m2t.models import Models
from robosc.tools.debugger import Adapter, Connection
from robosc.tools.debugger.launch import _KEYS
from robosc.tools.debugger.protocol import FramingError
from robosc.tools.debugger.stops import FILTERS
from tests.searching import examples

from ..cli.conftest import DOOR, not_longer_than
from .client import ROOT, Client, OverPort, Program

BODIES = [
    b"",
    b"{",
    b"[]",
    b"null",
    b"7",
    b'"text"',
    b"\xff\xfe",
    b"[" * 5000,
    b'{"seq": 1e999}',
    b'{"type": "request"}',
    b'{"seq": "1", "type": "request", "command": "threads"}',
    b'{"seq": 1, "type": "event", "event": "x"}',
]
#: Malformed requests, each with the number and the command that the response names.
MALFORMED = [
    (b'{"seq": 7, "type": "request", "command": "evaluate", "arguments": {"expression": ' + b"[" * 200, 7, "evaluate"),
    (b'{"seq":8,"command":"threads"', 8, "threads"),
    (b'{"command": "next", "seq" : 9, "a": 1e999}', 9, "next"),
    (b'{"seq": 10, "command": "next", "a": "\xff"}', 10, "next"),
    (b'{"seq": 11, "type": "request", "command": ["threads"]}', 11, ""),
    (b'{"seq": 12, "type": "request"}', 12, ""),
]
HEADERS = [
    b"Content-Length: many\r\n\r\n{}",
    b"Content-Length: -4\r\n\r\n{}",
    b"Content-Length: 99999999999999999999\r\n\r\n{}",
    b"Content-Length: 900000000\r\n\r\n{}",
    b"Content-Type: x\r\n\r\n{}",
    b"\r\n\r\n",
    b"GET / HTTP/1.1\r\nHost: x\r\n\r\n",
    b"x" * 100_000 + b"\r\n\r\n",
    b"Content-Length: 100\r\n\r\n{}",
    b"Content-Length: 2",
]


@pytest.fixture
def door(tmp_path: Path) -> Path:
    path = tmp_path / "door.rscd"
    path.write_text(DOOR)
    return path


def test_messages_that_are_none_are_left_out(program: Program, door: Path) -> None:
    session = program
    for number, body in enumerate(BODIES, 1):
        session.send(body)
        assert session.event("output")["category"] == "stderr"
        assert session.do("threads"), number
    session.send({"seq": 1, "type": "response", "request_seq": 1, "command": "runInTerminal", "success": True})
    # Blanks and other headers, in any case, are ignored.
    session.write(
        b'content-length:  52 \r\nContent-Type: x\r\n\r\n{"seq": 1, "type": "request", "command": "threads"}  '
    )
    answer = session.read()
    assert answer is not None
    assert answer["success"]
    session.launch(door)
    session.do("disconnect")
    assert session.end() == (0, "")


@pytest.mark.parametrize("header", HEADERS, ids=lambda header: repr(header[:24]))
def test_a_header_that_is_none(header: bytes) -> None:
    async def receive() -> None:
        reader = asyncio.StreamReader(limit=1 << 16)
        reader.feed_data(header)
        reader.feed_eof()
        with pytest.raises(FramingError):
            await Connection(reader, bytes).receive()

    asyncio.run(receive())


def test_a_stream_that_is_no_protocol_ends_the_session(tmp_path: Path) -> None:
    with not_longer_than(60):
        done = subprocess.run(
            [sys.executable, "-m", "robosc", "dap"],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            input=HEADERS[0],
            capture_output=True,
            check=False,
        )
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr == b"Error: this is not the Debug Adapter Protocol: a header has no Content-Length\n"


def test_malformed_requests_are_answered(program: Program) -> None:
    for body, number, command in MALFORMED:
        program.send(body)
        answer = program.read()
        assert answer is not None
        assert (answer["type"], answer["request_seq"], answer["command"]) == ("response", number, command)
        assert not answer["success"]
        assert answer["message"].startswith("a message is not ")
    program.do("disconnect")


def test_requests_out_of_order(session: Client, door: Path) -> None:
    for command in ("next", "continue", "stackTrace", "configurationDone", "pause", "stepBack", "evaluate"):
        assert session.refused(command) == "no robot is launched yet"
    assert session.refused("attach") == "the request `attach` is unknown"
    answer = session.ask("initialize", [1])
    assert answer["message"] == "`arguments` are no object"
    session.launch(door)
    model = {"path": str(door)}
    wrong: list[tuple[str, dict[str, Any], str]] = [
        ("setBreakpoints", {}, "`source` needs a `path`"),
        ("setBreakpoints", {"source": model, "breakpoints": [{"line": "1"}]}, "`line` must be a number"),
        ("setBreakpoints", {"source": model, "breakpoints": 3}, "expected a list of objects"),
        ("setFunctionBreakpoints", {"breakpoints": ["open"]}, "expected a list of objects"),
        ("scopes", {"frameId": 99}, "there is no such frame"),
        ("variables", {"variablesReference": 0}, "this variable does not exist any more: the robot has continued"),
        ("exceptionInfo", {}, "the robot has stopped for another reason"),
    ]
    for command, arguments, message in wrong:
        assert session.refused(command, **arguments) == message
    assert session.do("setBreakpoints", source={"path": "nowhere\0"}, breakpoints=[])["breakpoints"] == []
    assert session.frames()


@pytest.mark.usefixtures("door")
def test_what_can_not_be_launched(program: Program, tmp_path: Path) -> None:
    session = program
    stuck = DOOR.replace("initial marked", "initial").replace("needs Leaf.closed", "needs Leaf.opened")
    (tmp_path / "stuck.rscd").write_text(stuck)
    (tmp_path / "broken.rscd").write_text(DOOR.replace("needs Leaf.closed", "needs Leaf.x"))
    (tmp_path / "library.rscd").write_text("library Parts {}\n")
    (tmp_path / "bad.script").write_text('message_open.c_trigger {"value": \nmessage_opne.c_trigger\ntick\n')
    session.do("initialize", linesStartAt1=True)
    wrong: list[tuple[dict[str, Any], str]] = [
        ({}, "launch: `program` names the model"),
        ({"program": 7}, "launch: `program` is 7, expected the path of a model"),
        ({"program": "missing.rscd"}, "missing.rscd: No such file or directory"),
        ({"program": str(tmp_path)}, "Is a directory"),
        ({"program": "door\0.rscd"}, "launch: `program` has a null character: no path has one"),
        ({"program": "door.rscd", "script": "\0"}, "launch: `script` has a null character"),
        ({"program": "door.rscd", "libraries": ["\0"]}, "launch: `libraries` has a null character"),
        ({"program": "door.rscd", "interfaces": ["a", "\0"]}, "launch: `interfaces` has a null character"),
        ({"program": "door.rscd", "seed": True}, "launch: `seed` is true, expected a whole number"),
        ({"program": "door.rscd", "script": "x", "counterexample": True}, "exclude each other"),
        ({"program": "door.rscd", "script": "missing.script"}, "missing.script: No such file or directory"),
        ({"program": "door.rscd", "script": "bad.script"}, "bad.script: not JSON"),
        ({"program": "door.rscd", "counterexample": True}, "no property is refuted, so there is no counterexample"),
        ({"program": "door.rscd", "counterexample": "nonblocking"}, "did you mean `non-blocking`?"),
        ({"program": "broken.rscd"}, "broken.rscd:17:"),
        ({"program": "stuck.rscd"}, "the supervisor is empty"),
        ({"program": "library.rscd"}, "has a library"),
    ]
    for arguments, message in wrong:
        assert message in session.refused("launch", **arguments)
        session.event("terminated")
    # All findings are shown in the usual format, with their lines.
    assert "did you mean `message_open.c_trigger`?" in session.said()
    assert "      requirement open needs Leaf.x\n" in session.said()
    # A mended program can then be launched.
    (tmp_path / "broken.rscd").write_text(DOOR)
    session.do("launch", program="broken.rscd")
    session.event("initialized")
    assert session.begin()["reason"] == "entry"


def test_lines_that_are_counted_from_0(session: Client, door: Path) -> None:
    session.do("initialize", linesStartAt1=False, columnsStartAt1=False)
    session.do("launch", program=str(door))
    session.event("initialized")
    (point,) = session.do("setBreakpoints", source={"path": str(door)}, breakpoints=[{"line": 7}])["breakpoints"]
    assert (point["verified"], point["line"]) == (True, 7)
    locations = session.do("breakpointLocations", source={"path": str(door)}, line=5, endLine=8)["breakpoints"]
    assert [location["line"] for location in locations] == [6, 7]
    session.begin()
    leaf = session.frames()[1]
    assert (leaf["line"], leaf["column"]) == (6, 6)


def test_sessions_over_a_port(tmp_path: Path, door: Path) -> None:
    with not_longer_than(60):
        process = subprocess.Popen(
            [sys.executable, "-m", "robosc", "dap", "--port", "0"],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stderr=subprocess.PIPE,
            text=True,
        )
        try:
            assert process.stderr is not None
            port = int(process.stderr.readline().rpartition(" ")[2])
            # Two sessions at a time, each with its own run; an invalid third one harms neither.
            first, second, third = (OverPort(port, tmp_path) for _ in range(3))
            third.write(b"GET / HTTP/1.1\r\n\r\n")
            assert third.read() is None
            for client in (first, second):
                client.launch(door)
            first.console("open")
            assert second.scope("Components")["Leaf"]["value"] == "closed"
            assert first.scope("Components")["Leaf"]["value"] == "opened"
            first.do("disconnect")
            assert first.read() is None
            second.close()
        finally:
            process.send_signal(signal.SIGINT)
            told = process.communicate()[1]
    assert process.returncode == 130
    assert "Traceback" not in told


def test_one_session_over_a_port(tmp_path: Path, door: Path) -> None:
    with (
        not_longer_than(60),
        subprocess.Popen(
            [sys.executable, "-m", "robosc", "dap", "--port", "0", "--once"],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stderr=subprocess.PIPE,
            text=True,
        ) as process,
    ):
        assert process.stderr is not None
        client = OverPort(int(process.stderr.readline().rpartition(" ")[2]), tmp_path)
        client.launch(door)
        client.do("disconnect")
        assert process.wait() == 0


class Heard:
    """A connection that stores the sent messages."""

    def __init__(self) -> None:
        self.sent: list[dict[str, Any]] = []

    def send(self, kind: str, **content: Any) -> None:
        self.sent.append(json.loads(json.dumps({"type": kind, **content})))


@cache
def models() -> Models:
    robot = robosc.load("door.rscd", text=DOOR)
    found = Models(robosc.to_sct(robot), robosc.to_rosgraph(robot), robot)
    robosc.synthesize(found.sct)
    return found


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-2, 5) | st.text(max_size=3),
    lambda inner: st.lists(inner, max_size=2) | st.dictionaries(st.text(max_size=5), inner, max_size=2),
    max_leaves=4,
)
KEYS = [
    "source",
    "breakpoints",
    "line",
    "endLine",
    "name",
    "filters",
    "filterOptions",
    "expression",
    "context",
    "levels",
]
KEYS += [
    "frameId",
    "variablesReference",
    "start",
    "count",
    "targetId",
    "text",
    "column",
    "program",
    "startFrame",
    "seed",
]
FITTING = {
    "source": {"path": "door.rscd"},
    "expression": "open",
    "frameId": 1,
    "variablesReference": 1,
    "program": "door.rscd",
    "line": 8,
}


@pytest.mark.slow
@settings(max_examples=examples(30))
@given(
    st.lists(
        st.tuples(
            st.sampled_from(sorted(Adapter._answers)),
            VALUES | st.dictionaries(st.sampled_from(KEYS), VALUES).map(lambda given: FITTING | given),
        ),
        max_size=8,
    )
)
def test_no_request_is_a_fault_of_the_adapter(asked: list[tuple[str, Any]]) -> None:
    """Each request has exactly one response, and none reports an internal fault of robosc."""
    heard = Heard()

    async def session() -> None:
        adapter = Adapter(heard, lambda _: (models(), [], {}))  # type: ignore[arg-type]
        requests = [("launch", FITTING), ("configurationDone", {}), *asked]
        for number, (command, arguments) in enumerate(requests, 1):
            await adapter.handle({"seq": number, "type": "request", "command": command, "arguments": arguments})

    asyncio.run(session())
    answers = [message for message in heard.sent if message["type"] == "response"]
    assert [answer["request_seq"] for answer in answers] == list(range(1, len(asked) + 3))
    assert [answer["message"] for answer in answers if "internal error of robosc" in answer.get("message", "")] == []


def test_the_page_tells_of_all_there_is() -> None:
    page = (ROOT / "docs" / "debugging.md").read_text()
    told = page.partition("## Actions in a session")[0]
    assert set(re.findall(r"`(\w+)`(?=[^\n]*? \| )", told)) >= set(_KEYS)
    answered = page.partition("answers these requests:")[2].partition(". It sends")[0]
    assert set(re.findall(r"`(\w+)`", answered)) == set(Adapter._answers)
    assert {known["filter"] for known in FILTERS} == set(re.findall(r"\(`(\w+)`\) \|", page))
    for code in re.findall(r"```json\n(.*?)```", page, re.DOTALL):
        json.loads(code)
