"""`robosc gate` as a program: clients over standard input and output, and several over HTTP."""

from __future__ import annotations

import asyncio
import json
import os
import re
import subprocess
import sys
from contextlib import asynccontextmanager, contextmanager
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import httpx2
import pytest
from click.testing import CliRunner
from mcp import Client, StdioServerParameters
from mcp.client.streamable_http import streamable_http_client

from robosc.run.runtime.core.event_loop import EventLoop
from robosc.tools.cli import main
from robosc.tools.gate.dry import RobotEvent, play, read_script
from robosc.tools.gate.shapes import Fields, Flag
from tests.tools.gate.bench import CONFIGURATION, PORTER, call

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Iterator, Sequence
    from pathlib import Path

    from robosc.tools.gate.dry import DryNode

_PATIENCE = 60


def command(folder: Path, *options: str) -> list[str]:
    """Return the command that starts a gate of the porter."""
    configured = ["--config", str(CONFIGURATION), "--log", str(folder / "calls.jsonl")]
    return [sys.executable, "-m", "robosc", "gate", str(PORTER), "--dry", *configured, *options]


def calls(folder: Path) -> list[dict[str, Any]]:
    """Return the log of calls."""
    return [json.loads(line) for line in (folder / "calls.jsonl").read_text(encoding="utf-8").splitlines()]


def test_a_gate_uses_the_frames_of_headers(tmp_path: Path) -> None:
    settings = tmp_path / "settings.json"
    settings.write_text('{"retryMs": 5, "frameId": {"go_to": "map"}}')
    program = command(tmp_path, "--config", str(settings))
    done = subprocess.run(program, input="", capture_output=True, text=True, check=True, timeout=_PATIENCE)
    assert re.findall(r'warning: "(\w+)" has no effect', done.stderr) == ["retryMs"]


def test_a_client_on_standard_input(tmp_path: Path) -> None:
    script = tmp_path / "script.jsonl"
    script.write_text('{"event": "Person.seen", "data": {"data": true}}\n', encoding="utf-8")
    program, *arguments = command(tmp_path, "--script", str(script))

    async def drive() -> None:
        async with Client(StdioServerParameters(command=program, args=arguments, env=dict(os.environ))) as client:
            assert (await call(client, "Navigation_go_to"))["because"] == ["requirement go_to needs Person.away"]
            await call(client, "robot", event="Person.seen", data={"data": False})
            assert (await call(client, "Navigation_go_to"))["verdict"] == "accepted"

    asyncio.run(drive())
    assert [entry["verdict"] for entry in calls(tmp_path)] == ["refused", "happened", "accepted", "released"]


def test_a_new_guard_limits_and_refuses(tmp_path: Path) -> None:
    """The guard of `robosc new --guard` in front of a dry robot."""
    folder = tmp_path / "guard"
    assert CliRunner().invoke(main, ["new", "Porter", "--guard", "--yes", "-o", str(folder)]).exit_code == 0
    arguments = ["-m", "robosc", "gate", str(folder / "porter.rscd"), "--dry", "--log", str(tmp_path / "calls.jsonl")]

    async def drive() -> None:
        parameters = StdioServerParameters(command=sys.executable, args=arguments, env=dict(os.environ))
        async with Client(parameters) as client:
            refused = await call(client, "Commands_cmd_vel", linear={"x": 0.25})
            assert (refused["verdict"], refused["reason"]) == ("refused", "requirement")
            limited = refused
            while limited["verdict"] == "refused":  # a slow machine loses the button, which must repeat
                await call(client, "robot", event="EmergencyStop.pressed", data={"data": False})
                await call(client, "robot", event="EmergencyStop.continue")
                limited = await call(client, "Commands_cmd_vel", linear={"x": 9.0})
            assert (limited["verdict"], limited["sent"]["linear"]["x"]) == ("limited", 0.5)
            await call(client, "robot", event="EmergencyStop.pressed", data={"data": True})
            assert (await call(client, "Commands_cmd_vel", linear={"x": 0.25}))["verdict"] == "refused"

    asyncio.run(asyncio.wait_for(drive(), _PATIENCE))


def test_a_script_repeats_an_event_until_its_next_line(tmp_path: Path) -> None:
    caused: list[Any] = []
    event = RobotEvent("Person.seen", Fields({"data": Flag()}), caused.append)
    script = tmp_path / "script.jsonl"
    script.write_text(
        '{"event": "Person.seen", "data": {"data": true}, "every": 0.25}\n'
        '{"after": 0.9, "event": "Person.seen", "data": {"data": false}}\n',
        encoding="utf-8",
    )

    clock = [0.0]
    loop = EventLoop(lambda: clock[0])
    play(cast("DryNode", SimpleNamespace(event_loop=loop)), read_script(str(script), {event.name: event}))
    for tick in range(12):
        clock[0] = tick * 0.25
        loop.run_pending()
    assert caused == [*[{"data": True}] * 4, {"data": False}]


def test_raw_lines_on_standard_input(tmp_path: Path) -> None:
    """Lines that no client of the library sends: the answers are lines of the protocol only."""
    started = {"protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "raw", "version": "1"}}
    velocity = '{"name": "Base_velocity", "arguments": {"linear": {"x": %s}}}'
    lines = [
        _request(1, "initialize", json.dumps(started)),
        '{"jsonrpc": "2.0", "method": "notifications/initialized"}',
        _request(2, "tools/call", velocity % "NaN"),
        _request(3, "tools/call", velocity % "-Infinity"),
        _request(4, "tools/call", velocity % "1e999"),
        _request(5, "tools/call", velocity % ("9" * 500)),
        _request(6, "tools/call", '{"name": "Base_horn", "arguments": [1]}'),
        _request(7, "tools/call", '{"name": 3}'),
        "this is no JSON",
        _request(11, "tools/call", velocity % ("9" * 5000)),  # more digits than the library reads
        "[" * 100_000,
        _request(8, "tools/call", '{"name": "Base_text", "arguments": {"data": "%s"}}' % ("x" * 1_000_000)),
        _request(9, "robot/explode", "{}"),
        _request(10, "tools/call", '{"name": "Base_horn", "arguments": {}}'),
    ]
    with subprocess.Popen(
        command(tmp_path), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as program:
        assert program.stdin is not None
        assert program.stdout is not None
        program.stdin.write("".join(f"{line}\n" for line in lines))
        program.stdin.flush()
        answers: dict[int, dict[str, Any]] = {}
        while 10 not in answers:
            answer = json.loads(program.stdout.readline())
            answers[answer["id"]] = answer
        program.stdin.close()
        assert program.wait(_PATIENCE) == 0
        assert program.stderr is not None
        printed = program.stderr.read()
        assert "Traceback" not in printed
        assert "frameId" not in printed
    for number in (2, 3, 4, 5):
        assert answers[number]["result"]["structuredContent"]["reason"] == "schema"
    assert {"error"} <= answers[6].keys() & answers[7].keys() & answers[9].keys()
    assert answers[10]["result"]["structuredContent"] == {"verdict": "sent"}
    logged = sorted((entry["verdict"], entry.get("reason", "")) for entry in calls(tmp_path))
    refused = [("refused", "schema")] * 9 + [("refused", "size")]
    assert logged == [*refused, ("released", ""), ("sent", "")]


def _request(number: int, method: str, parameters: str) -> str:
    return f'{{"jsonrpc": "2.0", "id": {number}, "method": "{method}", "params": {parameters}}}'


@contextmanager
def served(folder: Path, *options: str) -> Iterator[tuple[str, list[str]]]:
    """Run a gate over HTTP; yield its address and its tokens."""
    with subprocess.Popen(
        command(folder, "--http", "0", *options), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True
    ) as program:
        assert program.stdout is not None
        address = program.stdout.readline().strip()
        tokens = [program.stdout.readline().rpartition(" ")[2].strip() for _ in range(2)]
        try:
            yield address, tokens
        finally:
            program.terminate()
            assert program.wait(_PATIENCE) == 0


@asynccontextmanager
async def connected(address: str, token: str, mode: str) -> AsyncIterator[Client]:
    """Connect a client with a token."""
    headers = {"Authorization": f"Bearer {token}"}
    async with (
        httpx2.AsyncClient(headers=headers, timeout=_PATIENCE) as http,
        Client(streamable_http_client(address, http_client=http), mode=mode) as client,
    ):
        yield client


def test_two_clients_over_http(tmp_path: Path) -> None:
    async def drive(address: str, tokens: Sequence[str]) -> None:
        async with connected(address, tokens[1], "auto") as second:
            async with connected(address, tokens[0], "legacy") as first:
                assert (await call(first, "Base_velocity", linear={"x": 0.5}))["verdict"] == "sent"
                assert (await call(first, "Navigation_go_to"))["verdict"] == "accepted"
                for tool in ("Base_horn", "release"):
                    refused = await call(second, tool)
                    assert (refused["verdict"], refused["reason"]) == ("refused", "writer")
                assert (await call(second, "cancel", command="Navigation_go_to"))["reason"] == "writer"
                assert (await call(second, "state"))["writer"] == "another client"
                assert (await call(first, "state"))["goals"]["Navigation_go_to"]["status"] == "executing"
            # The first one ends its session: its goal is canceled.
            assert (await call(second, "wait", command="Navigation_go_to", seconds=30))["status"] == "canceled"
            assert (await call(second, "Base_horn"))["verdict"] == "sent"
            async with connected(address, tokens[0], "legacy") as first:
                assert (await call(first, "Base_horn"))["reason"] == "writer"
                assert (await call(second, "release"))["verdict"] == "released"
                assert (await call(first, "Base_horn"))["verdict"] == "sent"

    with served(tmp_path, "--clients", "2") as (address, tokens):
        asyncio.run(drive(address, tokens))
    clients = {entry["client"].partition("/")[0] for entry in calls(tmp_path)}
    assert clients == {"client 1", "client 2"}
    assert [entry["tool"] for entry in calls(tmp_path) if entry.get("reason") == "writer"] == [
        "Base_horn",
        "release",
        "cancel",
        "Base_horn",
    ]


def test_http_needs_a_token_and_this_host(tmp_path: Path) -> None:
    body = {"jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": {"name": "Base_horn", "arguments": {}}}
    headers = {"Accept": "application/json, text/event-stream", "Content-Type": "application/json"}
    with served(tmp_path, "--clients", "2") as (address, tokens):
        statuses = [
            httpx2.post(address, json=body, headers={**headers, **more}).status_code
            for more in (
                {},
                {"Authorization": "Basic none"},
                {"Authorization": f"Bearer {tokens[0]}x"},
                {"Authorization": f"Bearer {tokens[0]}", "Host": "robot.example"},
                {"Authorization": f"Bearer {tokens[0]}", "Origin": "http://robot.example"},
                {"Authorization": f"Bearer {tokens[0]}", "mcp-session-id": "someone-else"},
            )
        ]
        assert statuses == [401, 401, 401, 421, 403, 404]
        large = {**body, "params": {"name": "Base_text", "arguments": {"data": "x" * 1_000_000}}}
        answer = httpx2.post(address, json=large, headers={**headers, "Authorization": f"Bearer {tokens[0]}"})
        assert answer.status_code == 413
    assert [(entry["client"], entry["verdict"]) for entry in calls(tmp_path)] == [("unknown", "refused")] * 3


def refused(*words: str) -> str:
    """Return the errors of a call that cannot be executed."""
    done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert "Traceback" not in done.stderr
    return " ".join(done.stderr.split())


def test_all_faults_of_a_script_are_reported(tmp_path: Path) -> None:
    script = tmp_path / "script.jsonl"
    script.write_text(
        '{"event": "Person"}\n\n{"event": "Person.seen", "data": {"data": 1}}\n{"after": -1, "every": 0}\n{\n',
        encoding="utf-8",
    )
    errors = refused(*command(tmp_path, "--script", str(script)))
    for fault in (
        "1: event is not one of: Person.seen,",
        "3: data is a number, expected true or false",
        "4: after is not between 0 and 86400",
        "4: every is not between 0.01 and 86400",
        "4: event is missing",
        "5: ",
    ):
        assert f"script.jsonl:{fault}" in errors


def test_a_log_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    errors = refused(*command(tmp_path, "--log", str(tmp_path / "nowhere" / "calls.jsonl")))
    assert re.search(r"the log of calls \S+/nowhere/calls\.jsonl cannot be written: No such file or directory", errors)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--dry", "--http", "70000"], "70000 is not in the range"),
        (["--dry", "--ros-args"], "--dry takes no ROS arguments: --ros-args"),
        (["--script", str(PORTER)], "--script needs --dry"),
        (["--dry", "--rate", "0"], "0.0 is not in the range"),
    ],
)
def test_wrong_calls(options: list[str], message: str) -> None:
    result = CliRunner().invoke(main, ["gate", str(PORTER), *options])
    assert (result.exit_code, result.stdout) == (2, "")
    assert message in " ".join(result.stderr.split())
