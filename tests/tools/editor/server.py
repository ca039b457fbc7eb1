"""A server with an editor, as a separate process, and texts for it."""

from __future__ import annotations

import asyncio
import os
import sys
from pathlib import Path
from typing import Any

from lsprotocol import types
from pygls.protocol import default_converter
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

from robosc.language.text import Text

ROOT = Path(__file__).parents[3]
COMMAND = [sys.executable, "-m", "robosc", "lsp"]

#: The number of seconds after which an unresponsive server counts as hanging, on any machine.
LONGEST = 120


def edited(content: str, edits: list[types.TextEdit]) -> str:
    """Return a text after non-overlapping edits, as an editor applies them."""
    text = Text("", content)
    for edit in sorted(edits, key=lambda edit: edit.range.start, reverse=True):
        start, end = edit.range.start, edit.range.end
        first, last = text.from_utf16(start.line, start.character), text.from_utf16(end.line, end.character)
        content = content[:first] + edit.new_text + content[last:]
    return content


class Editor(LanguageClient):
    """An editor that stores all published findings, in order, until a test has read them."""

    def __init__(self) -> None:
        super().__init__(converter_factory=default_converter)
        self.told: list[types.PublishDiagnosticsParams] = []
        self.news = asyncio.Event()
        self.refreshed = asyncio.Event()
        self.watched: list[types.Registration] = []

        @self.feature(types.CLIENT_REGISTER_CAPABILITY)
        def register(params: types.RegistrationParams) -> None:
            self.watched += params.registrations

        @self.feature(types.WORKSPACE_CODE_LENS_REFRESH)
        def refresh(_: None) -> None:
            self.refreshed.set()

        @self.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
        def publish(params: types.PublishDiagnosticsParams) -> None:
            self.told.append(params)
            self.news.set()


CONFIG = ClientServerConfig(
    server_command=COMMAND, client_factory=Editor, server_env={**os.environ, "PYTHONPATH": str(ROOT)}
)

LIBRARY = """library Wheels {
  component Motors {
    incoming message drive with identifier: "/drive", type: double
    outgoing message speed with identifier: "/speed", type: double
    behaviour {
      initial marked state still {
        on response from speed if value > 0.0 goto rolling
      }
      state rolling {
        on response from speed if value <= 0.0 goto still
      }
    }
  }
}
"""
ROBOT = """robot Cart {
  component Base from Wheels import Motors
  // Where the cart may go.
  component Door {
    outgoing message opened with identifier: "/door", type: boolean
    behaviour {
      initial marked state closed {
        on response from opened if value goto open
      }
      state open {
        on response from opened if !value goto closed
      }
    }
  }
  requirement R1 "only through an open door": drive needs Door.open
  provide drive with 0.5
}
"""


async def initialize(client: Editor, folder: Path, editor: str = "visual-studio-code") -> None:
    """Initialize the session as an editor does, with one folder, and without the pause before findings."""
    await client.initialize_session(
        types.InitializeParams(
            capabilities=client_capabilities(editor),
            workspace_folders=[types.WorkspaceFolder(folder.as_uri(), "robots")],
            initialization_options={"pause": 0},
        )
    )


def open_text(client: Editor, path: Path, text: str, version: int = 1) -> str:
    """Open a text in place of a file, and return its URI."""
    uri = path.as_uri()
    client.text_document_did_open(types.DidOpenTextDocumentParams(types.TextDocumentItem(uri, "robosc", version, text)))
    return uri


def replace(client: Editor, uri: str, version: int, *changes: tuple[types.Range, str] | str) -> None:
    """Change an open text: ranges of it, or the whole."""
    client.text_document_did_change(
        types.DidChangeTextDocumentParams(
            types.VersionedTextDocumentIdentifier(version, uri),
            [
                types.TextDocumentContentChangeWholeDocument(change)
                if isinstance(change, str)
                else types.TextDocumentContentChangePartial(change[0], change[1])
                for change in changes
            ],
        )
    )


def close(client: Editor, uri: str) -> None:
    client.text_document_did_close(types.DidCloseTextDocumentParams(types.TextDocumentIdentifier(uri)))


async def findings(client: Editor, uri: str, version: int | None) -> list[types.Diagnostic]:
    """Return the findings of a version of a text when they are published.

    The next call returns the next findings of this version.
    """
    async with asyncio.timeout(LONGEST):
        while True:
            for published in client.told:
                if (published.uri, published.version) == (uri, version):
                    client.told.remove(published)
                    return list(published.diagnostics)
            client.news.clear()
            await client.news.wait()


def position(text: str, marker: str, into: int = 0, *, nth: int = 0) -> types.Position:
    """Return the position at an offset into an occurrence of a text, in UTF-16 units."""
    offset = -1
    for _ in range(nth + 1):
        offset = text.index(marker, offset + 1)
    before = text[: offset + into]
    last = before.rsplit("\n", 1)[-1]
    return types.Position(before.count("\n"), len(last.encode("utf-16-le")) // 2)


def of(text: str, place: types.Range) -> str:
    """Return the text in a range."""
    lines = text.split("\n")
    start, end = (
        sum(len(line) + 1 for line in lines[: at.line])
        + len(lines[at.line].encode("utf-16-le")[: 2 * at.character].decode("utf-16-le"))
        for at in (place.start, place.end)
    )
    return text[start:end]


def at(uri: str, where: types.Position) -> dict[str, Any]:
    """Return the parameters of a request about a position."""
    return {"text_document": types.TextDocumentIdentifier(uri), "position": where}
