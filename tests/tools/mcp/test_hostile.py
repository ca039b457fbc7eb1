"""Hostile calls change nothing, and each gets an answer: wrong arguments, paths that lead out, endless models."""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from mcp.shared.exceptions import MCPError

from robosc.tools.mcp.tools import Calls
from tests.tools.mcp.assistant import LONG, LONGEST, ROOT, Assistant, assistant, command

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.xdist_group("mcp")

DOOR = """\
robot Door {
  component Leaf {
    incoming message open with identifier: "/open", type: none
  }
}
"""
HIDDEN = "library Secret { component Hidden { } }\n"


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The user's folder `robots`, beside files that are not for the assistant."""
    place = tmp_path_factory.mktemp("place")
    folder = place / "robots"
    folder.mkdir()
    (folder / "door.rscd").write_text(DOOR)
    (folder / "note.txt").write_text("nothing\n")
    (folder / "bytes.rscd").write_bytes(b"robot \xff {}\n")
    (place / "secret.rscd").write_text(HIDDEN)
    (place / "out.cif").write_text("group secret: end\n")
    (folder / "secret.rscd").symlink_to(place / "secret.rscd")
    (folder / "circle.rscd").symlink_to(folder / "circle.rscd")
    (folder / "up").symlink_to(place)
    (folder / "inner.rscd").symlink_to(folder / "door.rscd")
    (folder / "import.cif").write_text('import "../out.cif";\n')
    return folder


@pytest.fixture(scope="module")
def robosc(desk: Path) -> Iterator[Assistant]:
    with assistant(desk) as client:
        yield client


def contents(desk: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in desk.parent.rglob("*") if path.is_file()}


@pytest.fixture(autouse=True)
def _nothing_changes(desk: Path) -> Iterator[None]:
    before = contents(desk)
    yield
    assert contents(desk) == before


@pytest.mark.parametrize(
    ("tool", "arguments", "message"),
    [
        ("check", {"path": 3}, "`path` must be a string, not 3"),
        ("check", {"path": ["door.rscd"]}, '`path` must be a string, not ["door.rscd"]'),
        ("check", {"pth": "door.rscd"}, "the arguments must not have `pth`; did you mean `path`?"),
        ("check", {}, "name a file with `path`, or give the model itself with `text`"),
        ("check", {"path": ""}, "`path` must not be empty"),
        ("check", {"text": "x" * 4_000_001}, "`text` has 4,000,001 characters; the most is 4,000,000"),
        ("check", {"path": "x" * 1001}, "`path` has 1,001 characters; the most is 1,000"),
        ("check", {"path": "a", "library_paths": ["x"] * 101}, "`library_paths` has 101 entries; the most is 100"),
        ("check", {"path": "door.rscd", "library_paths": [1, ""]}, "`library_paths[0]` must be a string, not 1\n"),
        ("check", {"path": "door.rscd", "library_paths": ["none"]}, "`library_paths`: there is no folder none"),
        ("rule", {"name": "marked-stat"}, "there is no rule `marked-stat`; did you mean `marked-state`?"),
        ("new", {}, "the arguments must have `name`"),
        ("new", {"name": "../Porter"}, "`../Porter` cannot name a robot"),
        ("new", {"name": "Porter", "ros": 3}, "`ros` must be one of 1, 2, not 3"),
        ("new", {"name": "Porter", "sensors": ["robot"]}, "`robot` is a keyword"),
        ("new", {"name": "Porter", "topics": ["/a:std_msgs/Bool"]}, "`topics` needs `guard`"),
        ("new", {"name": "Porter", "guard": True, "stop": "halt"}, "`stop` has no meaning for a guard"),
        ("new", {"name": "Porter", "guard": True}, "a guard needs a topic, service or action of the robot"),
        ("new", {"name": "Porter", "guard": True, "topics": ["/a"]}, "`/a` is not NAME:TYPE of a topic"),
        ("search_docs", {"query": "limit", "most": 0}, "`most` must be at least 1, not 0"),
        ("search_docs", {"query": "limit", "most": 1e300}, "`most` must be at most 20, not 1e+300"),
        ("search_docs", {"query": "limit", "most": "many"}, '`most` must be an integer, not "many"'),
        ("simulate", {"path": "door.rscd"}, "give one of `script` and `random`"),
        ("simulate", {"path": "door.rscd", "random": 10_001}, "`random` must be at most 10000, not 10001"),
        ("simulate", {"random": 1, "parameters": {"v": [1]}}, "`parameters.v` must be true or false or a number or"),
        ("simulate", {"path": "door.rscd", "random": 1, "parameters": {"v": 1}}, "the model has no parameter v"),
        ("explain", {"path": "door.rscd"}, "give one of `event`, `why_never` and `why_empty`"),
        ("explain", {"path": "door.rscd", "event": "opn"}, "opn"),
        ("test", {"path": "door.rscd"}, "name files with `scenarios`"),
        ("test", {"path": "door.rscd", "scenarios": ["door.rscd"]}, "door.rscd must end with .scenarios"),
        ("verify", {"path": "door.rscd", "config": "none.json"}, "there is no file none.json; relative paths start at"),
    ],
)  # fmt: skip
def test_wrong_arguments(robosc: Assistant, tool: str, arguments: dict[str, Any], message: str) -> None:
    assert message in robosc.refusal(tool, **arguments)


@pytest.mark.parametrize(
    "path",
    [
        "../secret.rscd",
        "/etc/passwd",
        "secret.rscd",
        "up/secret.rscd",
        "up/../secret.rscd",
        "circle.rscd",
        "door.rscd\0",
        "none/../../secret.rscd",
        "~/secret.rscd",
        "file:///etc/passwd",
        "note.txt",
        ".",
    ],
)
def test_no_other_file_is_read(robosc: Assistant, path: str) -> None:
    for tool, name in (("check", "path"), ("fix", "path"), ("test", "scenarios"), ("verify", "config")):
        source = {} if name == "path" else {"path": "door.rscd"}
        message = robosc.refusal(tool, **source, **{name: [path] if name == "scenarios" else path})
        assert "outside of the folders" in message or "must end with" in message or "there is no file" in message
        assert "Hidden" not in message
    is_inside = path in ("note.txt", ".", "~/secret.rscd", "file:///etc/passwd")
    assert is_inside == ("is outside of the folders" not in robosc.refusal("check", path=path))


@pytest.mark.parametrize("folder", ["..", "up", "/", "../new", "up/new"])
def test_no_other_folder_is_used(robosc: Assistant, folder: str) -> None:
    assert "outside of the folders" in robosc.refusal("new", name="Porter", folder=folder)
    for name in ("library_paths", "interface_paths"):
        assert "outside of the folders" in robosc.refusal("check", path="door.rscd", **{name: [folder]})


def test_links_within_the_folders_are_followed(robosc: Assistant, desk: Path) -> None:
    assert robosc.answer("check", path="inner.rscd")["exit_status"] == 0
    assert robosc.answer("check", path=str(desk / "door.rscd"))["exit_status"] == 0
    assert robosc.answer("check", path="up/robots/door.rscd")["exit_status"] == 0


def test_imports_do_not_lead_out(robosc: Assistant) -> None:
    """The link `secret.rscd` beside the model leads to a library outside; a specification imports another one."""
    text = "robot Thief {\n  component Loot from Secret import Hidden\n}\n"
    findings = robosc.answer("check", text=text)["findings"]
    assert [finding["message"] for finding in findings] == ["there is no library `Secret`"]
    answer = robosc.call("check", path="import.cif")
    assert "outside of the folders that may be read" in str(answer.content)


def test_folders_of_the_command_line_hold_libraries(desk: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(desk)
    text = "robot User {\n  component Own from Secret import Hidden\n}\n"
    answers = [Calls([str(desk)], folders, [], 1 << 30).answer("check", {"text": text}) for folders in ([], [".."])]
    assert [finding["message"] for finding in answers[0]["findings"]] == ["there is no library `Secret`"]
    assert answers[1]["findings"] == []


def test_nothing_is_overwritten(robosc: Assistant) -> None:
    assert "door.rscd exists already" in robosc.refusal("new", name="Porter", folder="door.rscd")
    assert "exists already" in robosc.refusal("new", name="Porter", folder=".")


def test_a_file_that_is_not_text(robosc: Assistant) -> None:
    (finding,) = robosc.answer("check", path="bytes.rscd")["findings"][:1]
    assert finding["message"] == "the byte 0xff is not UTF-8"
    fixed = robosc.answer("fix", path="bytes.rscd")
    assert (fixed["result"]["edits"], fixed["findings"][0]) == (0, finding)


def test_unknown_tools_and_resources(robosc: Assistant) -> None:
    with pytest.raises(MCPError, match="there is no tool `chek`; did you mean `check`"):
        robosc.call("chek")
    for uri in ("robosc://docs/../pyproject.toml", "file:///etc/passwd", "robosc://docs/none.md", "x" * 5000):
        with pytest.raises(MCPError, match="there is no resource"):
            robosc.wait(robosc.client.read_resource(uri))


@pytest.mark.parametrize(
    "text",
    ["", "\0", "robot" * 100_000, "(" * 100_000, "robot A {" * 10_000, "\N{FULL BLOCK}\u202e", "/*" * 1000, '"' * 9999],
    ids=range(8),
)
def test_texts_that_are_no_models(robosc: Assistant, text: str) -> None:
    answer = robosc.answer("check", text=text)
    assert answer["exit_status"] == 1
    assert robosc.answer("check", path="door.rscd")["exit_status"] == 0


@pytest.mark.slow
def test_a_long_synthesis_ends(desk: Path) -> None:
    """It delays no quick call."""
    with assistant(desk, "--seconds", "2") as client:

        async def calls() -> tuple[Any, Any]:
            long = asyncio.create_task(client.client.call_tool("synthesize", {"text": LONG}))
            quick = await client.client.call_tool("rule", {})
            assert not long.done()
            return await long, quick

        long, quick = client.wait(calls())
    assert not quick.is_error
    assert "took more than 2 seconds" in long.content[0].text


def test_a_canceled_call_ends(robosc: Assistant) -> None:
    async def calls() -> None:
        await asyncio.wait_for(robosc.client.call_tool("verify", {"text": LONG}), 0.5)

    with pytest.raises(TimeoutError):
        robosc.wait(calls())
    assert robosc.answer("synthesize", path="door.rscd", counts=True)["result"]["robot"] == "Door"


@pytest.mark.slow
def test_a_thousand_calls_at_once(robosc: Assistant) -> None:
    """A hundred of them may wait; the others are refused. All are answered."""

    async def calls() -> list[Any]:
        call = robosc.client.call_tool
        return await asyncio.gather(*(call("rule", {"name": "marked-state"}) for _ in range(1000)))

    results = robosc.wait(calls())
    refused = [result for result in results if result.is_error]
    assert len(results) == 1000
    assert all("100 calls are waiting already" in result.content[0].text for result in refused)
    assert len(results) - len(refused) >= 100
    assert robosc.answer("check", path="door.rscd")["exit_status"] == 0


class Raw:
    """A server to which a test writes lines itself."""

    def __init__(self, desk: Path) -> None:
        pipe = subprocess.PIPE
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        self.process = subprocess.Popen(command(desk), stdin=pipe, stdout=pipe, stderr=pipe, env=environment)
        begin = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "raw", "version": "0"}}
        self.write({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": begin})
        self.write({"jsonrpc": "2.0", "method": "notifications/initialized"})

    def write(self, line: dict[str, Any] | bytes) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write((line if isinstance(line, bytes) else json.dumps(line).encode()) + b"\n")
        self.process.stdin.flush()

    def call(self, number: int, tool: str, arguments: Any) -> None:
        params = {"name": tool, "arguments": arguments}
        self.write({"jsonrpc": "2.0", "id": number, "method": "tools/call", "params": params})

    def answers(self, last: int) -> dict[Any, Any]:
        """Return all answers until the one to the call with this number."""
        assert self.process.stdout is not None
        answers: dict[Any, Any] = {}
        while last not in answers:
            answer = json.loads(self.process.stdout.readline())
            answers[answer.get("id")] = answer
        return answers


def test_lines_that_are_no_messages(desk: Path) -> None:
    """The server drops them and answers the next message."""
    raw = Raw(desk)
    for line in (
        b"",
        b"\xff\xfe",
        b"null",
        b"[]",
        b"{}",
        b"[" * 100_000,
        b'{"jsonrpc": "2.0", "id": 3, "method": "tools/call", "params": {"name": NaN}}',
        b'{"jsonrpc": "2.0", "id": 5, "method": "\xff"}',
        b'{"jsonrpc": "2.0", "id": 6, "method": "tools/call", "params": {"name": "\\ud800"}}',
    ):
        raw.write(line)
    raw.call(7, "check", [])
    raw.call(2, "check", {"path": 1})
    answers = raw.answers(2)
    _, errors = raw.process.communicate(timeout=LONGEST)
    assert raw.process.returncode == 0
    assert answers[2]["result"]["content"][0]["text"] == "`path` must be a string, not 1"
    assert "error" in answers[7]
    assert "Traceback" not in json.dumps(answers) + errors.decode()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ends a process with its parent")
def test_the_processes_of_calls_end_with_the_server(desk: Path) -> None:
    """Also one that is busy, after SIGKILL."""
    raw = Raw(desk)
    raw.call(2, "synthesize", {"text": DOOR})
    raw.answers(2)
    raw.call(3, "synthesize", {"text": LONG})
    time.sleep(0.5)  # it reads the model
    server = raw.process.pid
    children = Path(f"/proc/{server}/task/{server}/children").read_text().split()
    raw.process.kill()
    raw.process.communicate(timeout=LONGEST)
    assert len(children) == 2
    until = time.monotonic() + LONGEST
    while any(runs(child) for child in children) and time.monotonic() < until:
        time.sleep(0.05)
    assert [child for child in children if runs(child)] == []


def runs(process: str) -> bool:
    """Whether a process exists and has not ended."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(") ")[2][0] != "Z"
    except OSError:
        return False
