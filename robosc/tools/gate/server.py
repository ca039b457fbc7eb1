"""Server of the Model Context Protocol for the tools of a gate, over standard input and output or HTTP."""

from __future__ import annotations

import asyncio
import json
import logging
import sys
import threading
from contextlib import contextmanager, suppress
from hmac import compare_digest
from typing import TYPE_CHECKING, Any

import anyio
import mcp_types as types
import uvicorn
from mcp.server.lowlevel import Server
from mcp.server.stdio import stdio_server
from mcp_types.version import MODERN_PROTOCOL_VERSIONS
from starlette.requests import Request
from starlette.responses import PlainTextResponse

from robosc import __version__
from robosc.tools.gate.gate import ERRORS, refusal
from robosc.tools.mcp.stdio import Lines

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable, Coroutine, Iterator, Sequence

    from mcp.server.context import CallNext, HandlerResult, ServerRequestContext
    from starlette.types import ASGIApp, Receive, Scope, Send

    from robosc.tools.gate.gate import Gate

#: Client over standard input and output.
STDIO = "stdio"
#: Path of the server over HTTP, the header of a session, and the most sessions at a time.
PATH = "/mcp"
_SESSION = "mcp-session-id"
_MOST_SESSIONS = 16
#: Seconds that the last calls have to end.
_FAREWELL = 1.0
#: Name of a client in the scope of its request, and the shown part of a session's identifier.
_CLIENT = "robosc.client"
_SHOWN = 8
_INSTRUCTIONS = """These tools command a robot. A supervisor decides on each command: it is sent, limited or refused. \
A refusal has the reason and, where there is one, a way to make the command possible. A refused command has not \
happened: do not report it as done. `state` shows the robot, `why` explains a refusal. Only one client at a time may \
send commands, from its first command until it calls `release`."""


def server(gate: Gate, client_of: Callable[[ServerRequestContext[Any, Any]], str] = lambda _: STDIO) -> Server[Any]:
    """Return the server of a gate. `client_of` returns the name of the client of a request."""

    async def list_tools(_: Any, __: Any) -> types.ListToolsResult:
        return types.ListToolsResult(
            tools=[
                types.Tool(
                    name=tool.name,
                    description=tool.description,
                    input_schema=tool.shape.schema,
                    annotations=types.ToolAnnotations(read_only_hint=tool.reads),
                )
                for tool in gate.tools.values()
            ]
        )

    async def call_tool(context: Any, parameters: types.CallToolRequestParams) -> types.CallToolResult:
        answer = await gate.call(client_of(context), parameters.name, parameters.arguments)
        return types.CallToolResult(
            content=[types.TextContent(type="text", text=json.dumps(answer))],
            structured_content=answer,
            is_error=answer["verdict"] in ERRORS,
        )

    async def log_malformed(ctx: ServerRequestContext[Any, Any], call_next: CallNext) -> HandlerResult:
        """Log a call that the protocol rejects before it reaches a tool."""
        try:
            return await call_next(ctx)
        except Exception as error:
            if ctx.method == "tools/call" and not isinstance(error, asyncio.CancelledError):
                parameters = dict(ctx.params or {})
                name = parameters.get("name")
                gate.note(
                    client_of(ctx),
                    name if isinstance(name, str) else "",
                    parameters.get("arguments"),
                    refusal("schema", f"no call of a tool: {type(error).__name__}"),
                )
            raise

    mcp_server: Server[Any] = Server(
        "robosc gate", version=__version__, instructions=_INSTRUCTIONS, on_list_tools=list_tools, on_call_tool=call_tool
    )
    mcp_server.middleware[:] = [log_malformed]  # without that which reports each call to OpenTelemetry
    # The log of calls has what clients do wrong.
    logging.getLogger("mcp").addHandler(logging.NullHandler())
    logging.getLogger("mcp").propagate = False
    return mcp_server


@contextmanager
def serving(serve: Coroutine[Any, Any, None], gate: Gate) -> Iterator[None]:
    """Serve in a thread of its own; its end ends the node, and the end of the context ends it."""
    loops: list[tuple[asyncio.AbstractEventLoop, asyncio.Task[None]]] = []
    began, ended = threading.Event(), threading.Event()

    async def run() -> None:
        loops.append((asyncio.get_running_loop(), asyncio.ensure_future(_beside(gate, serve))))
        began.set()
        with suppress(asyncio.CancelledError):
            await loops[0][1]
        ended.set()

    def begin() -> None:
        try:
            asyncio.run(run())
        finally:
            began.set()
            ended.set()
            gate.node.end()

    # Reading standard input cannot be interrupted: the thread must not keep the process alive.
    threading.Thread(target=begin, name="gate", daemon=True).start()
    began.wait()
    try:
        yield
    finally:
        for loop, task in loops:
            with suppress(RuntimeError):  # it has ended
                loop.call_soon_threadsafe(task.cancel)
        ended.wait(_FAREWELL)
        gate.log.close()


async def _beside(gate: Gate, serve: Coroutine[Any, Any, None]) -> None:
    """Serve, and end the roles of silent writers meanwhile."""
    watching = asyncio.ensure_future(gate.watch())
    try:
        await serve
    finally:
        watching.cancel()


async def serve_stdio(gate: Gate) -> None:
    """Serve the client on standard input and output until it leaves."""
    mcp_server = server(gate)
    messages: Any = _Messages(gate)
    async with stdio_server(anyio.wrap_file(messages)) as (received, sent):
        await mcp_server.run(received, sent, mcp_server.create_initialization_options())
    await gate.leave(STDIO)


class _Messages:
    """Messages of the protocol on standard input; other lines, and too long ones, are logged as refused calls."""

    def __init__(self, gate: Gate) -> None:
        self._gate = gate
        self._lines = Lines(sys.stdin.buffer, _most_bytes(gate), self._drop)

    def readline(self) -> str:
        """Return the next line; an empty text at the end."""
        while line := self._lines.readline():
            try:
                types.jsonrpc_message_adapter.validate_json(line)  # the library drops other lines
            except ValueError:
                self._gate.note(STDIO, "", line, refusal("schema", "a line that is no message of the protocol"))
            else:
                return line
        return ""

    def _drop(self, most: int) -> None:
        self._gate.note(STDIO, "", None, refusal("size", f"a line of more than {most} bytes"))


def _most_bytes(gate: Gate) -> int:
    """Return the maximum size of a message: data that is too large still gets an answer, unless it is far too large."""
    return 4 * gate.limits.largest + 65_536


async def serve_http(gate: Gate, listening: socket.socket, tokens: Sequence[str], ready: Callable[[], None]) -> None:
    """Serve clients over HTTP, each with its own token; `ready` is called once the server accepts connections."""

    class _Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            ready()

    mcp_server = server(gate, _client)
    served = mcp_server.streamable_http_app(
        streamable_http_path=PATH, max_request_body_size=_most_bytes(gate), max_sessions=_MOST_SESSIONS
    )
    configuration = uvicorn.Config(
        _Guarded(served, tokens, gate),
        log_level="critical",
        access_log=False,
        timeout_graceful_shutdown=1,
        server_header=False,
    )
    await _Server(configuration).serve([listening])


def _client(context: ServerRequestContext[Any, Any]) -> str:
    """Return the client of a request: by its token, and by its session if its version of the protocol has sessions."""
    assert context.request is not None
    scope = context.request.scope
    session = "" if context.protocol_version in MODERN_PROTOCOL_VERSIONS else _session(Request(scope))
    return f"{scope[_CLIENT]}{session}"


def _session(request: Request) -> str:
    return f"/{request.headers.get(_SESSION, '')[:_SHOWN]}"


class _Guarded:
    """Rejects requests without a token, and ends the role of a writer that ends its session."""

    def __init__(self, inner: ASGIApp, tokens: Sequence[str], gate: Gate) -> None:
        self._inner = inner
        self._tokens = tokens
        self._gate = gate

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._inner(scope, receive, send)
            return
        request = Request(scope)
        token = request.headers.get("authorization", "").removeprefix("Bearer ").encode()
        numbers = [number for number, known in enumerate(self._tokens, 1) if compare_digest(token, known.encode())]
        if not numbers:
            self._gate.note("unknown", "", None, refusal("writer", "a request without a token"))
            response = PlainTextResponse("the token is missing: use one that `robosc gate` printed", 401)
            await response(scope, receive, send)
            return
        scope[_CLIENT] = f"client {numbers[0]}"
        await self._inner(scope, receive, send)
        if request.method == "DELETE":
            await self._gate.leave(f"{scope[_CLIENT]}{_session(request)}")
