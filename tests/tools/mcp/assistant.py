"""A client of the public library with a server, both in the background, for tests that are not asynchronous."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from mcp import Client, StdioServerParameters, stdio_client

if TYPE_CHECKING:
    from collections.abc import Coroutine, Iterator

    from mcp_types import CallToolResult

Result = TypeVar("Result")
ROOT = Path(__file__).parents[3]
#: The number of seconds after which an unresponsive server counts as hanging, on any machine.
LONGEST = 120
#: Components whose integers are multiplied: synthesis would take hours.
LONG = (
    "robot Long {\n"
    + "".join(
        f"""  component C{number} {{
    outgoing message up{number} with identifier: "/up{number}", type: none
    incoming message go{number} with identifier: "/go{number}", type: none

    behaviour {{
      variable count: integer(0..100) = 0

      initial marked state one {{
        on response from up{number} if count < 100 do count := count + 1
        on response from up{number} if count >= 100 do count := 0
      }}
    }}
  }}
"""
        for number in range(10)
    )
    + "  requirement go0 needs "
    + " + ".join(f"C{number}.count * C{(number + 5) % 10}.count" for number in range(10))
    + " < 30000\n}\n"
)


def command(*arguments: str | Path) -> list[str]:
    """Return the command that starts a server."""
    return [sys.executable, "-m", "robosc", "mcp", *map(str, arguments)]


class Assistant:
    """A connected client. Each method blocks until the answer."""

    def __init__(self, client: Client, loop: asyncio.AbstractEventLoop) -> None:
        self.client = client
        self._loop = loop

    def wait(self, answer: Coroutine[Any, Any, Result]) -> Result:
        """Return the result of a coroutine of the client."""
        return asyncio.run_coroutine_threadsafe(answer, self._loop).result(LONGEST)

    def call(self, tool: str, /, **arguments: Any) -> CallToolResult:
        """Return the result of a call, which the client has checked against the tool's output schema."""
        return self.wait(self.client.call_tool(tool, arguments))

    def answer(self, tool: str, /, **arguments: Any) -> dict[str, Any]:
        """Return the object of a call that was executed."""
        result = self.call(tool, **arguments)
        assert not result.is_error, result.content
        answer: dict[str, Any] = result.structured_content
        return answer

    def refusal(self, tool: str, /, **arguments: Any) -> str:
        """Return the message of a call that was not executed."""
        result = self.call(tool, **arguments)
        assert result.is_error
        (content,) = result.content
        assert content.type == "text"
        assert "Traceback" not in content.text
        return content.text


@contextmanager
def assistant(*arguments: str | Path) -> Iterator[Assistant]:
    """Start a server with these arguments, and connect a client to it."""
    program, *rest = command(*arguments)
    server = StdioServerParameters(command=program, args=rest, env={**os.environ, "PYTHONPATH": str(ROOT)})
    loop, is_connected, ended = asyncio.new_event_loop(), threading.Event(), asyncio.Event()
    clients: list[Client] = []

    async def connect() -> None:
        try:
            async with Client(stdio_client(server)) as client:
                clients.append(client)
                is_connected.set()
                await ended.wait()
        finally:
            is_connected.set()

    thread = threading.Thread(target=loop.run_until_complete, args=(connect(),), daemon=True)
    thread.start()
    assert is_connected.wait(LONGEST)
    assert clients, "the server did not start"
    try:
        yield Assistant(clients[0], loop)
    finally:
        loop.call_soon_threadsafe(ended.set)
        thread.join(LONGEST)
        assert not thread.is_alive()
