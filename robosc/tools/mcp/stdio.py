"""Serves one client over the standard input and output."""

from __future__ import annotations

import logging
import sys
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

import anyio
from mcp.server.stdio import stdio_server
from mcp.shared.exceptions import MCPError
from mcp_types import INVALID_PARAMS, CallToolResult, TextContent

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import BinaryIO

    from mcp.server.lowlevel import Server

#: Maximum size of a message in bytes. A larger one is dropped: its number, for an answer, may be anywhere in it.
MOST_BYTES = 64 << 20


def _warn(size: int) -> None:
    logging.warning("a message of more than %d MB was dropped", size >> 20)


class Lines:
    """Lines of a stream as text, each at most `most` bytes long. Bytes that are not UTF-8 become U+FFFD.

    `dropped` is called for each longer line, with `most`.
    """

    def __init__(self, stream: BinaryIO, most: int = MOST_BYTES, dropped: Callable[[int], object] = _warn) -> None:
        self._stream = stream
        self._most = most
        self._dropped = dropped

    def readline(self) -> str:
        """Return the next line; an empty text at the end of the stream."""
        while True:
            line = self._stream.readline(self._most + 1)
            if len(line) <= self._most:
                return line.decode("utf-8", errors="replace")
            while line and not line.endswith(b"\n"):
                line = self._stream.readline(1 << 20)
            self._dropped(self._most)


def serve(server: Server[Any]) -> None:
    """Serve a client until it closes the standard input.

    Only messages of the protocol reach the standard output: prints of handlers go to standard error, as does the log.
    Nothing is sent anywhere else.
    """
    logging.basicConfig(stream=sys.stderr, level=logging.WARNING, format="%(message)s")
    server.middleware.clear()  # it reports each call to OpenTelemetry
    anyio.run(_serve, server)


async def _serve(server: Server[Any]) -> None:
    lines: Any = Lines(sys.stdin.buffer)
    async with stdio_server(stdin=anyio.wrap_file(lines)) as (incoming, outgoing):
        await server.run(incoming, outgoing, server.create_initialization_options())


def error_result(message: str) -> CallToolResult:
    """Return the result of a call that cannot be executed. The message is for the assistant, which may try again."""
    return CallToolResult(content=[TextContent(type="text", text=message)], is_error=True)


def unknown_tool(name: str, known: Iterable[str]) -> MCPError:
    """Return the error of a call of a tool that does not exist."""
    known = list(known)
    close = get_close_matches(name[:100], known, n=1)
    hint = f"did you mean `{close[0]}`?" if close else f"the tools are {', '.join(known)}"
    return MCPError(INVALID_PARAMS, f"there is no tool `{name[:100]}`; {hint}")
