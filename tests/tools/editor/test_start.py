"""Start of the server: over a port, and not without its packages."""

import asyncio
import io
import os
import re
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from lsprotocol import types

from robosc.tools.cli import main
from robosc.tools.editor.server import Server
from tests.tools.editor.server import COMMAND, LIBRARY, ROBOT, ROOT, Editor, findings, initialize, open_text


@pytest.mark.slow
@pytest.mark.asyncio
async def test_over_a_port(tmp_path: Path) -> None:
    server = await asyncio.create_subprocess_exec(
        *COMMAND, "--port", "0", stderr=asyncio.subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(ROOT)}
    )
    port = None
    while port is None:
        line = (await server.stderr.readline()).decode()
        assert line, "the server tells its port"
        found = re.search(r"Serving on .*'127\.0\.0\.1', (\d+)", line)
        port = int(found[1]) if found else None
    client = Editor()
    await client.start_tcp("127.0.0.1", port)
    await initialize(client, tmp_path, "neovim")
    uri = open_text(client, tmp_path / "robot.rscd", ROBOT)
    (finding,) = await findings(client, uri, 1)
    assert finding.message.startswith("there is no library `Wheels`")
    await client.shutdown_async(None)
    client.exit(None)
    assert await server.wait() == 0


@pytest.mark.slow
@pytest.mark.asyncio
async def test_libraries_of_the_call_and_of_the_editor(tmp_path: Path) -> None:
    for folder, name in (("first", "Wheels"), ("second", "Feet")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "library.rscd").write_text(LIBRARY.replace("Wheels", name))
    text = "robot R { component A from Wheels import Motors component B from Feet import Motors }"
    client = Editor()
    await client.start_io(*COMMAND, "-I", str(tmp_path / "first"), env={**os.environ, "PYTHONPATH": str(ROOT)})
    capabilities = types.ClientCapabilities(general=types.GeneralClientCapabilities(position_encodings=["utf-8"]))
    started = await client.initialize_session(
        types.InitializeParams(
            capabilities,
            root_uri=tmp_path.as_uri(),
            initialization_options={"libraryPaths": [str(tmp_path / "second")], "pause": 0},
        )
    )
    assert started.capabilities.position_encoding == types.PositionEncodingKind.Utf16
    found = await findings(client, open_text(client, tmp_path / "robot.rscd", text), 1)
    assert "unresolved-reference" not in {finding.code for finding in found}
    await client.shutdown_session()
    await client.stop()


def test_without_its_packages_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.startswith("robosc.tools.editor")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "pygls", None)
    monkeypatch.setitem(sys.modules, "pygls.uris", None)
    done = CliRunner().invoke(main, ["lsp"])
    assert done.exit_code == 2
    assert done.output.startswith("Error: pygls")
    assert "pip install 'robosc[editor]'" in done.output


@pytest.mark.asyncio
async def test_nothing_is_kept_of_what_was_handled() -> None:
    """Otherwise the server would grow with each key."""
    server, written = Server("0"), io.BytesIO()
    server.protocol.set_writer(written)
    options = {"pause": 0}
    started = types.InitializeParams(types.ClientCapabilities(), initialization_options=options)
    server.protocol.handle_message(types.InitializeRequest(1, started))
    uri = "file:///nowhere/robot.rscd"
    opened = types.DidOpenTextDocumentParams(types.TextDocumentItem(uri, "robosc", 1, ROBOT))
    server.protocol.handle_message(types.DidOpenTextDocumentNotification(opened))
    for version in range(2, 12):
        change = types.DidChangeTextDocumentParams(
            types.VersionedTextDocumentIdentifier(version, uri), [types.TextDocumentContentChangeWholeDocument(ROBOT)]
        )
        server.protocol.handle_message(types.DidChangeTextDocumentNotification(change))
    assert b'"id": 1' in written.getvalue()
    assert server.protocol._request_futures == {}  # pygls has no public API for this
    server.shutdown()
