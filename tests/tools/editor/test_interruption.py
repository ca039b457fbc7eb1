"""The server abandons work that is obsolete or takes too long, and answers every request."""

import asyncio
import threading
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import pytest
import pytest_lsp
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.protocol.json_rpc import JsonRPCRequestMessage

from robosc.base.interruption import call_at_checkpoints, checkpoint
from robosc.tools.editor import server as editor_server
from robosc.tools.editor.project import Project
from robosc.tools.editor.server import Server
from tests.tools.editor.server import CONFIG, LIBRARY, ROBOT, Editor, at, findings, initialize, open_text, position

URI = "file:///nowhere/robot.rscd"
DOOR = ROBOT[ROBOT.index("  component Door") : ROBOT.index("  requirement")]
LARGE = "robot Large {\n" + "".join(DOOR.replace("Door", f"Door{number}") for number in range(300)) + "}\n"


class StopError(Exception):
    pass


# Within the process


def test_an_analysis_may_be_interrupted_at_every_checkpoint() -> None:
    """An interrupt does not change later results: nothing is left incomplete, and nothing is cached."""
    made, calls, last = Project(), 0, 0
    path = made.put(URI, 1, ROBOT.replace("Door.open", "Door.opem"))
    made.put("file:///nowhere/wheels.rscd", 1, LIBRARY)
    made.snapshot().analysis(path)
    made.forget()

    def check() -> None:
        nonlocal calls
        calls += 1
        if calls == last:
            raise StopError

    interrupted = 0
    while last < 2000:
        last += 1
        calls = 0
        with call_at_checkpoints(check):
            try:
                whole = made.snapshot().analysis(path)
                break
            except StopError:
                interrupted += 1
        assert path not in made._memory.analyses
    assert interrupted > 100
    assert [found.message for found in whole.findings] == ["component `Door` has no variable or state `opem`"]


def test_a_change_interrupts_the_reading_of_the_text_before() -> None:
    server = Server("0")
    path = server.project.put(URI, 1, LARGE)
    snapshot = server.project.snapshot()
    check = server._check(snapshot)
    server.project.change(URI, 2, [(None, ROBOT)])
    with call_at_checkpoints(check), pytest.raises(JsonRpcException) as error:
        snapshot.analysis(path)
    assert error.value.code == types.LSPErrorCodes.ContentModified
    server.shutdown()


def test_a_canceled_request_is_interrupted() -> None:
    server, canceled = Server("0"), threading.Event()
    check = server._check(server.project.snapshot(), canceled)
    check()
    canceled.set()
    with pytest.raises(JsonRpcException):
        check()
    server.shutdown()


def test_work_that_takes_too_long_is_abandoned_and_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(editor_server, "_LONGEST", 0)
    server = Server("0")
    path = server.project.put(URI, 1, ROBOT)
    with call_at_checkpoints(server._check(server.project.snapshot())), pytest.raises(JsonRpcException) as error:
        server.project.snapshot().analysis(path)
    assert error.value.code == types.LSPErrorCodes.RequestFailed
    (finding,) = server._findings(server.project.snapshot())[path]
    assert "the findings of this file are missing" in finding.message
    server.shutdown()


def test_threads_analyze_a_text_once_and_a_waiting_one_may_be_interrupted() -> None:
    made = Project()
    path = made.put(URI, 1, ROBOT)
    snapshot = made.snapshot()
    with snapshot.memory.only_one(path):
        seen: list[Any] = []

        def stop() -> None:
            raise StopError

        def wait() -> None:
            with call_at_checkpoints(stop):
                try:
                    snapshot.analysis(path)
                except StopError as fault:
                    seen.append(fault)

        thread = threading.Thread(target=wait)
        thread.start()
        thread.join()
        assert len(seen) == 1
    threads = [threading.Thread(target=lambda: seen.append(snapshot.analysis(path))) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert seen[1] is seen[2] is seen[3] is not None


def test_a_checkpoint_without_a_check_does_nothing() -> None:
    checkpoint()


@pytest.mark.parametrize("uri", ["file:///tmp/%00x.rscd", "file:///tmp/\ud800.rscd", "file:///" + "a" * 5000])
def test_a_uri_that_no_file_can_have_is_a_text_as_others(uri: str) -> None:
    made = Project()
    path = made.put(uri, 1, "robot R {")
    analysis = made.snapshot().analysis(path)
    assert [found.rule for found in analysis.findings] == ["syntax"]
    assert made.snapshot().uri(str(path)) == uri
    made.close(uri)
    assert made.snapshot().analysis(path) is None


# Over the protocol


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("robots")
    (made / "wheels.rscd").write_text(LIBRARY)
    return made


@pytest_lsp.fixture(config=CONFIG, scope="module")
async def client(lsp_client: Editor, folder: Path):
    await initialize(lsp_client, folder)
    yield
    await lsp_client.shutdown_session()


async def ask(client: Editor, method: str, parameters: Any) -> Any:
    """Send parameters that the client's own classes do not permit."""
    answer: Future[Any] = Future()
    client.protocol._request_futures[method] = answer
    client.protocol._send_data(JsonRPCRequestMessage(method, method, "2.0", parameters))
    return await asyncio.wrap_future(answer)


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize(
    "position_",
    [
        {"line": -1, "character": 0},
        {"line": "first", "character": 0},
        {"line": 2**70, "character": 0},
        {"line": 0, "character": -5},
        {"line": None, "character": 0},
        {"character": 0},
        [],
        "here",
    ],
    ids=str,
)
@pytest.mark.parametrize(
    "method", [types.TEXT_DOCUMENT_HOVER, types.TEXT_DOCUMENT_COMPLETION, types.TEXT_DOCUMENT_RENAME]
)
async def test_unfit_parameters_are_answered(client: Editor, folder: Path, method: str, position_: Any) -> None:
    parameters = {"textDocument": {"uri": (folder / "unfit.rscd").as_uri()}, "position": position_, "newName": "x"}
    with pytest.raises(JsonRpcException) as error:
        await ask(client, method, parameters)
    assert error.value.code in {-32602, -32603}


@pytest.mark.asyncio(loop_scope="module")
async def test_an_answer_does_not_wait_for_the_findings_of_another_text(client: Editor, folder: Path) -> None:
    small = open_text(client, folder / "small.rscd", ROBOT)
    await findings(client, small, 1)
    large = open_text(client, folder / "large.rscd", LARGE)
    asked = types.HoverParams(**at(small, position(ROBOT, "Door {")))
    answer = await client.text_document_hover_async(asked)
    assert "component Door" in answer.contents.value
    assert not [published for published in client.told if published.uri == large]
    assert await findings(client, large, 1)
