"""The messages of the Debug Adapter Protocol: JSON behind a header with its length, over pipes or a socket.

https://microsoft.github.io/debug-adapter-protocol/overview
"""

from __future__ import annotations

import asyncio
import json
import re
import sys
from contextlib import redirect_stdout
from threading import Thread
from typing import IO, TYPE_CHECKING, Any, Protocol

from robosc.files.json_reading import JsonError, json_value

if TYPE_CHECKING:
    from collections.abc import Callable

#: The most that a message, and a line of its header, may have.
MOST_BYTES, _MOST_HEADER = 16 << 20, 4096
_CHUNK = 1 << 16
#: The parts of a message that can be read where the message itself is no JSON.
_SEQUENCE = re.compile(r'"seq"\s{0,9}:\s{0,9}(\d{1,9})\b')
_COMMAND = re.compile(r'"command"\s{0,9}:\s{0,9}"(\w{1,99})"')


class FramingError(Exception):
    """Where the next message begins can't be told any more."""


class MessageError(Exception):
    """A message that is none; the next one can be read.

    `request` is the `seq` and the `command` of the request that it seems to be; None where it has no `seq`.
    """

    def __init__(self, fault: str, text: str = "") -> None:
        super().__init__(fault)
        sequence, command = _SEQUENCE.search(text), _COMMAND.search(text)
        self.request = (int(sequence[1]), command[1] if command else "") if sequence else None


class Handler(Protocol):
    """Answers the messages of one client."""

    async def handle(self, message: dict[str, Any]) -> None:
        """Answers a message."""

    def malformed(self, fault: str, request: tuple[int, str] | None = None) -> None:
        """Report a message that could not be read: to the request that it seems to be, or by an event."""

    @property
    def ended(self) -> bool:
        """Whether the client is done."""


class Connection:
    """One client: messages come from a stream and go out through `write`, numbered."""

    def __init__(self, reader: asyncio.StreamReader, write: Callable[[bytes], None]) -> None:
        self._reader = reader
        self._write = write
        self._sent = 0

    def send(self, kind: str, **content: Any) -> None:
        """Sends a response or an event."""
        self._sent += 1
        body = json.dumps({"seq": self._sent, "type": kind, **content}).encode()
        self._write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))

    async def receive(self) -> dict[str, Any] | None:
        """The next message; None at the end. Raises MessageError, and FramingError, after which nothing can be read."""
        length = await self._length()
        if length is None:
            return None
        try:
            data = await self._reader.readexactly(length)
            message = json_value(data.decode())
        except asyncio.IncompleteReadError:
            raise FramingError("the last message is cut off") from None
        except UnicodeDecodeError:
            raise MessageError("a message is no UTF-8", data.decode("utf-8", "replace")) from None
        except JsonError as error:
            raise MessageError(f"a message is no JSON: {error}", data.decode()) from None
        if not isinstance(message, dict):
            raise MessageError("a message is no object")
        return message

    async def _length(self) -> int | None:
        length: int | None = None
        started = False
        while True:
            try:
                line = await self._reader.readline()
            except ValueError:  # longer than the limit of the stream
                raise FramingError("a line of a header is too long") from None
            if not line and not started:
                return None
            if not line.endswith(b"\n") or len(line) > _MOST_HEADER:
                raise FramingError("a header is cut off or too long")
            started = True
            name, _, value = line.strip().partition(b":")
            if not name:
                break
            if name.lower() == b"content-length":
                length = int(value) if value.strip().isdigit() and len(value) < 12 else None
        if length is None:
            raise FramingError("a header has no Content-Length")
        if length > MOST_BYTES:
            raise FramingError(f"a message has more than {MOST_BYTES >> 20} MB")
        return length


async def converse(connection: Connection, handler: Handler) -> str | None:
    """Hands messages to the handler until either is done; what is wrong with the stream, if that has ended it."""
    while not handler.ended:
        try:
            message = await connection.receive()
        except MessageError as error:
            handler.malformed(str(error), error.request)
            continue
        except FramingError as error:
            return str(error)
        if message is None:
            return None
        await handler.handle(message)
    return None


def serve_stdio(handler: Callable[[Connection], Handler]) -> str | None:
    """Serves the client at the other end of the standard input and output; what is wrong with the stream, else None.

    Nothing else gets to the standard output meanwhile: what is printed goes to the standard error output.
    """

    async def serve() -> str | None:
        reader = asyncio.StreamReader(limit=MOST_BYTES)
        # A thread, as no event loop waits for whatever a standard input may be.
        Thread(target=_feed, args=(sys.stdin.buffer, asyncio.get_running_loop(), reader), daemon=True).start()

        def write(message: bytes) -> None:
            output.write(message)
            output.flush()

        connection = Connection(reader, write)
        return await converse(connection, handler(connection))

    output = sys.stdout.buffer
    with redirect_stdout(sys.stderr):
        return asyncio.run(serve())


def _feed(source: IO[bytes], loop: asyncio.AbstractEventLoop, reader: asyncio.StreamReader) -> None:
    read = getattr(source, "read1", source.read)
    try:
        while chunk := read(_CHUNK):
            loop.call_soon_threadsafe(reader.feed_data, chunk)
        loop.call_soon_threadsafe(reader.feed_eof)
    except (OSError, ValueError, RuntimeError):
        pass  # the stream, or the loop, is closed: nobody wants more


def serve_port(
    port: int, handler: Callable[[Connection], Handler], listening: Callable[[int], None], *, once: bool = False
) -> None:
    """Serves clients on a port of this machine, each on its own, until an interrupt; with `once` the first one only.

    `listening` is told the port, which is chosen where 0 is given.
    """

    async def serve() -> None:
        done = asyncio.Event()

        async def client(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            connection = Connection(reader, writer.write)
            try:
                fault = await converse(connection, handler(connection))
                if fault is not None:
                    print(fault, file=sys.stderr)  # noqa: T201
                await writer.drain()
            except (ConnectionError, asyncio.CancelledError):
                pass  # the client is gone, or all is over
            finally:
                writer.close()
                if once:
                    done.set()

        server = await asyncio.start_server(client, "127.0.0.1", port, limit=MOST_BYTES)
        listening(server.sockets[0].getsockname()[1])
        async with server:
            await done.wait()

    asyncio.run(serve())
