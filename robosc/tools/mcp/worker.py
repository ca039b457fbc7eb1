"""Runs calls one after the other in a process of its own, which can be ended at any time.

A call that is canceled or takes too long ends the process with all that it has started. The next call starts another
one. A model can therefore neither block the server nor end it.
"""

from __future__ import annotations

import asyncio
import json
from asyncio.subprocess import PIPE
from contextlib import suppress
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from asyncio.subprocess import Process
    from collections.abc import Mapping, Sequence

#: Maximum size of an answer in bytes. The process itself keeps it.
MOST_BYTES = 8 << 20
#: Maximum time for the start of a process, which loads the tools, in seconds.
_START_SECONDS = 60.0
#: Time for a process to remove its temporary files and to end its own processes, in seconds.
_PATIENCE_SECONDS = 2.0


class CallFailedError(Exception):
    """A call without an answer; the message gives the reason and what may help."""


class Worker:
    """A process that answers calls: it reads and writes one line of JSON for each, after an empty line at its start."""

    def __init__(self, command: Sequence[str], settings: Mapping[str, Any], seconds: float) -> None:
        """Run `command`, whose first line of input is the settings. A call may take that many seconds once it runs."""
        self._command = command
        self._settings = settings
        self._seconds = seconds
        self._process: Process | None = None
        self._turn = asyncio.Lock()
        self._ends: set[asyncio.Task[None]] = set()

    async def start(self) -> None:
        """Start the process, so that the first call does not wait for it."""
        async with self._turn:
            with suppress(CallFailedError):  # the first call tries again
                await self._running()

    async def call(self, request: Mapping[str, Any]) -> Any:
        """Return the answer to a request, when its turn comes. Raises CallFailedError."""
        async with self._turn:
            process = await self._running()
            assert process.stdin is not None
            assert process.stdout is not None
            answer = b""
            try:
                async with asyncio.timeout(self._seconds):
                    process.stdin.write(json.dumps(request).encode() + b"\n")
                    await process.stdin.drain()
                    answer = await process.stdout.readline()
            except TimeoutError:
                raise CallFailedError(
                    f"this took more than {self._seconds:g} seconds and was ended: make the model smaller, with fewer"
                    " states or integers of smaller ranges, or start `robosc mcp` with a larger --seconds"
                ) from None
            except OSError:  # the process has ended
                pass
            finally:
                if not answer.endswith(b"\n"):
                    self._end()
        if not answer.endswith(b"\n"):
            raise CallFailedError("the process of this call ended without an answer, perhaps for lack of memory")
        return json.loads(answer)

    async def _running(self) -> Process:
        """Return the process, which is started if there is none. Raises CallFailedError."""
        if self._process is not None and self._process.returncode is None:
            return self._process
        self._process = process = await asyncio.create_subprocess_exec(
            *self._command, stdin=PIPE, stdout=PIPE, limit=2 * MOST_BYTES
        )
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(json.dumps(self._settings).encode() + b"\n")
        is_ready = False
        try:
            async with asyncio.timeout(_START_SECONDS):
                is_ready = await process.stdout.readline() == b"\n"
        except TimeoutError:
            pass
        finally:
            if not is_ready:
                self._end()
        if not is_ready:
            raise CallFailedError("the process for calls does not start: the log of the server has the reason")
        return process

    def _end(self) -> None:
        """End the process without waiting for it: the caller may be canceled."""
        process, self._process = self._process, None
        if process is not None and process.returncode is None:
            task = asyncio.get_running_loop().create_task(_ended(process))
            self._ends.add(task)
            task.add_done_callback(self._ends.discard)

    async def stop(self) -> None:
        """End the process, and wait until it has ended."""
        self._end()
        await asyncio.gather(*self._ends)


async def _ended(process: Process) -> None:
    """End a process. It handles SIGTERM between two operations, of which one may take minutes."""
    with suppress(ProcessLookupError):
        process.terminate()
        with suppress(TimeoutError):
            async with asyncio.timeout(_PATIENCE_SECONDS):
                await process.wait()
                return
        process.kill()
    await process.wait()
