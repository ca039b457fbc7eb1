"""The server: tools and resources for a client with a language model."""

from __future__ import annotations

import asyncio
import json
import os
import sys
from contextlib import asynccontextmanager
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from mcp.server.lowlevel import Server
from mcp.shared.exceptions import MCPError
from mcp_types import (
    INVALID_PARAMS,
    CallToolResult,
    ListResourcesResult,
    ListResourceTemplatesResult,
    ListToolsResult,
    ReadResourceResult,
    Resource,
    ResourceTemplate,
    TextContent,
    TextResourceContents,
    ToolAnnotations,
)
from mcp_types import Tool as ToolType

from robosc import __version__
from robosc.tools.mcp.arguments import faults
from robosc.tools.mcp.catalog import TOOLS
from robosc.tools.mcp.pages import RULE_TEMPLATE, pages, resource
from robosc.tools.mcp.stdio import error_result, unknown_tool
from robosc.tools.mcp.worker import CallFailedError, Worker

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Sequence

    from mcp.server.context import ServerRequestContext
    from mcp_types import CallToolRequestParams, PaginatedRequestParams, ReadResourceRequestParams

#: The command that runs calls; the number of this process follows it. `-P` imports nothing from the user's folders.
_COMMAND = (sys.executable, "-P", "-m", "robosc.tools.mcp.process")
#: Maximum number of calls that wait at the same time.
MOST_WAITING = 100
#: Exit statuses of calls that were not executed: a wrong call, an internal error.
_NOT_EXECUTED = (2, 70)
_INSTRUCTIONS = """\
RoboSC computes the controller of a ROS robot from a model (.rscd): components with messages, services and actions, and
requirements. The controller provably keeps every requirement.

To write a model: read robosc://docs/language.md and an example, create a folder with `new` or write a file, call
`check` after each change and `fix` for clear repairs, then `synthesize`, `verify` and `test`. `explain` tells why an
event is forbidden. `search_docs` and `rule` find the documentation.

Files are below {folders}. Relative paths start at {first}.
"""


@dataclass(frozen=True)
class Settings:
    """Folders of files, of libraries and of ROS types, and the memory of a call in bytes."""

    folders: Sequence[str]
    libraries: Sequence[str] = ()
    interfaces: Sequence[str] = ()
    memory: int = 4 << 30


class _Calls:
    """Calls of tools: quick ones and long ones have a process each, so that a long one delays no quick one."""

    def __init__(self, settings: Settings, seconds: float) -> None:
        command = (*_COMMAND, str(os.getpid()))
        self._workers = {is_long: Worker(command, asdict(settings), seconds) for is_long in (False, True)}
        self._waiting = 0

    async def answer(self, name: str, arguments: dict[str, Any]) -> CallToolResult:
        """Return the result of a call. Faults of the call are results that tell the assistant how to mend it."""
        tool = TOOLS.get(name)
        if tool is None:
            raise unknown_tool(name, TOOLS)
        wrong = faults(tool.schema, arguments)
        if wrong:
            return error_result("\n".join(wrong))
        if self._waiting >= MOST_WAITING:
            return error_result(f"{MOST_WAITING} calls are waiting already: call again after an answer")
        self._waiting += 1
        try:
            answer = await self._workers[tool.is_long].call({"tool": name, "arguments": arguments})
        except CallFailedError as error:
            return error_result(str(error))
        finally:
            self._waiting -= 1
        return _result(answer)

    async def start(self) -> None:
        """Start the process of quick calls."""
        await self._workers[False].start()

    async def stop(self) -> None:
        """End all processes."""
        for worker in self._workers.values():
            await worker.stop()


def _result(answer: dict[str, Any]) -> CallToolResult:
    """Return the answer as an object and as text, which older clients need."""
    if answer.get("exit_status", 0) in _NOT_EXECUTED:
        return error_result(answer["error"])
    text = json.dumps(answer, ensure_ascii=False)
    return CallToolResult(content=[TextContent(type="text", text=text)], structured_content=answer)


def create(settings: Settings, seconds: float) -> Server[Any]:
    """Return the server, which `robosc.tools.mcp.stdio.serve` runs. A call may take that many seconds."""
    calls = _Calls(settings, seconds)

    @asynccontextmanager
    async def running(_server: Server[Any]) -> AsyncIterator[None]:
        start = asyncio.create_task(calls.start())
        try:
            yield
        finally:
            start.cancel()
            await calls.stop()

    async def list_tools(
        _context: ServerRequestContext[Any], _params: PaginatedRequestParams | None
    ) -> ListToolsResult:
        return ListToolsResult(
            tools=[
                ToolType(
                    name=tool.name,
                    title=tool.title,
                    description=tool.description,
                    input_schema=tool.schema,
                    output_schema=dict(tool.output),
                    annotations=ToolAnnotations(
                        read_only_hint=not tool.writes, destructive_hint=tool.name == "fix", open_world_hint=False
                    ),
                )
                for tool in TOOLS.values()
            ]
        )

    async def call_tool(_context: ServerRequestContext[Any], params: CallToolRequestParams) -> CallToolResult:
        return await calls.answer(params.name, params.arguments or {})

    async def list_resources(
        _context: ServerRequestContext[Any], _params: PaginatedRequestParams | None
    ) -> ListResourcesResult:
        return ListResourcesResult(
            resources=[
                Resource(uri=page.uri, name=page.name, title=page.title, mime_type=page.kind, size=page.size)
                for page in pages()
            ]
        )

    async def list_templates(
        _context: ServerRequestContext[Any], _params: PaginatedRequestParams | None
    ) -> ListResourceTemplatesResult:
        rule = ResourceTemplate(
            uri_template=RULE_TEMPLATE, name="rule", title="Page of a rule", mime_type="text/markdown"
        )
        return ListResourceTemplatesResult(resource_templates=[rule])

    async def read_resource(
        _context: ServerRequestContext[Any], params: ReadResourceRequestParams
    ) -> ReadResourceResult:
        page = resource(str(params.uri))
        if page is None:
            raise MCPError(INVALID_PARAMS, f"there is no resource {str(params.uri)[:200]}; resources/list has all")
        return ReadResourceResult(contents=[TextResourceContents(uri=page.uri, mime_type=page.kind, text=page.text)])

    first = settings.folders[0]
    return Server(
        "robosc",
        version=__version__,
        title="RoboSC",
        instructions=_INSTRUCTIONS.format(folders=" and ".join(settings.folders), first=first),
        lifespan=running,
        on_list_tools=list_tools,
        on_call_tool=call_tool,
        on_list_resources=list_resources,
        on_list_resource_templates=list_templates,
        on_read_resource=read_resource,
    )
