"""The process of calls: its time limit, its end, and how often it starts."""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path
from typing import Any

import pytest
from mcp import Client

from robosc.tools.mcp import server, worker
from robosc.tools.mcp.worker import CallFailedError, Worker

pytestmark = pytest.mark.xdist_group("mcp")

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").glob("*/*.rscd"))
#: A process that echoes calls, dies of `die`, never answers `sleep`, and does not start with the setting `bad`.
PROGRAM = """
import json, sys, time
settings = json.loads(sys.stdin.readline())
assert "bad" not in settings
print(flush=True)
for line in sys.stdin:
    call = json.loads(line)
    if call == "die":
        sys.exit()
    if call == "sleep":
        time.sleep(1000)
    print(json.dumps([settings, call]), flush=True)
"""
COMMAND = (sys.executable, "-c", PROGRAM)


@pytest.fixture
def starts(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The processes that are started."""
    started: list[Any] = []
    start = asyncio.create_subprocess_exec

    async def noted(*command: Any, **options: Any) -> Any:
        started.append(await start(*command, **options))
        return started[-1]

    monkeypatch.setattr(worker.asyncio, "create_subprocess_exec", noted)
    return started


def test_a_process_answers_until_it_ends(starts: list[Any]) -> None:
    async def calls() -> None:
        running = Worker(COMMAND, {"a": 1}, 60)
        assert await asyncio.gather(*(running.call(number) for number in range(9))) == [
            [{"a": 1}, number] for number in range(9)
        ]
        assert len(starts) == 1
        with pytest.raises(CallFailedError, match="ended without an answer"):
            await running.call("die")
        assert await running.call("again") == [{"a": 1}, "again"]
        assert len(starts) == 2
        await running.stop()

    asyncio.run(calls())
    assert all(process.returncode is not None for process in starts)


def test_a_call_that_takes_too_long_or_is_canceled_ends_the_process(starts: list[Any]) -> None:
    async def calls() -> None:
        running = Worker(COMMAND, {}, 0.5)
        with pytest.raises(CallFailedError, match=r"took more than 0\.5 seconds"):
            await running.call("sleep")
        running._seconds = 60
        call, second = (asyncio.create_task(running.call(words)) for words in ("sleep", "second"))
        while len(starts) < 2:
            await asyncio.sleep(0.01)
        call.cancel()
        assert await second == [{}, "second"]
        assert len(starts) == 3
        await running.stop()

    asyncio.run(calls())
    assert all(process.returncode is not None for process in starts)


def test_a_process_that_does_not_start() -> None:
    async def calls() -> None:
        running = Worker(COMMAND, {"bad": 1}, 60)
        await running.start()
        with pytest.raises(CallFailedError, match="does not start"):
            await running.call("a")

    asyncio.run(calls())


def test_all_examples_are_checked_by_one_process(starts: list[Any]) -> None:
    """A check of an example takes little time after the first: the process keeps the grammar and the tools."""
    folder = EXAMPLES[0].parents[1]

    async def calls() -> list[Any]:
        async with Client(server.create(server.Settings([str(folder)]), 120)) as client:
            paths = [{"path": str(path.relative_to(folder))} for path in EXAMPLES]
            return [await client.call_tool("check", arguments) for arguments in paths]

    results = asyncio.run(calls())
    assert [result.structured_content["exit_status"] for result in results] == [0] * len(EXAMPLES)
    assert (len(EXAMPLES) > 9, len(starts)) == (True, 1)
