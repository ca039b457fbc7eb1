"""Messages of the Debug Adapter Protocol: JSON after a header with its length, over pipes or a socket.

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

from robosc.base.files.json_reading import JsonError, json_value

if TYPE_CHECKING:
    from collections.abc import Callable

#: Maximum size in bytes of a message, and of a line of its header.
MOST_BYTES, _MOST_HEADER = 16 << 20, 4096
_CHUNK = 1 << 16
#: The parts of a message that can be read even if the message is not valid JSON.
_SEQUENCE = re.compile(r'"seq"\s{0,9}:\s{0,9}(\d{1,9})\b')
_COMMAND = re.compile(r'"command"\s{0,9}:\s{0,9}"(\w{1,99})"')


class FramingError(Exception):
    """The start of the next message is unknown, so that the stream is unusable."""


class MessageError(Exception):
    """An invalid message; the next one is readable.

    `request` has the `seq` and the `command` of the apparent request, or None if there is no `seq`.
    """

    def __init__(self, fault: str, text: str = "") -> None:
        super().__init__(fault)
        sequence, command = _SEQUENCE.search(text), _COMMAND.search(text)
        self.request = (int(sequence[1]), command[1] if command else "") if sequence else None


class Handler(Protocol):
    """Answers the messages of one client."""

    async def handle(self, message: dict[str, Any]) -> None:
        """Answer a message."""

    def malformed(self, fault: str, request: tuple[int, str] | None = None) -> None:
        """Report an unreadable message: as the answer to its apparent request, or by an event."""

    @property
    def ended(self) -> bool:
        """Whether the client has disconnected."""


class Connection:
    """One client: messages arrive in a stream and leave through `write`, numbered."""

    def __init__(self, reader: asyncio.StreamReader, write: Callable[[bytes], None]) -> None:
        self._reader = reader
        self._write = write
        self._sent = 0

    def send(self, kind: str, **content: Any) -> None:
        """Send a response or an event."""
        self._sent += 1
        body = json.dumps({"seq": self._sent, "type": kind, **content}).encode()
        self._write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))

    async def receive(self) -> dict[str, Any] | None:
        """Return the next message, or None at the end of the stream.

        Raises MessageError, and FramingError if the stream is no longer usable.
        """
        length = await self._length()
        if length is None:
            return None
        try:
            data = await self._reader.readexactly(length)
            message = json_value(data.decode())
        except asyncio.IncompleteReadError:
            raise FramingError("the last message is incomplete") from None
        except UnicodeDecodeError:
            raise MessageError("a message is not UTF-8", data.decode("utf-8", "replace")) from None
        except JsonError as error:
            raise MessageError(f"a message is not JSON: {error}", data.decode()) from None
        if not isinstance(message, dict):
            raise MessageError("a message is not an object")
        return message

    async def _length(self) -> int | None:
        length: int | None = None
        started = False
        while True:
            try:
                line = await self._reader.readline()
            except ValueError:  # The line exceeds the limit of the stream.
                raise FramingError("a line of a header is too long") from None
            if not line and not started:
                return None
            if not line.endswith(b"\n") or len(line) > _MOST_HEADER:
                raise FramingError("a header is incomplete or too long")
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
    """Pass messages to the handler until it or the stream ends; return the fault of the stream, or None."""
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
    """Serve the client at the standard input and output; return the fault of the stream, or None.

    Meanwhile, printed text goes to the standard error, so that only messages reach the standard output.
    """

    async def serve() -> str | None:
        reader = asyncio.StreamReader(limit=MOST_BYTES)
        # A thread reads the standard input, because event loops do not support every kind of it.
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
    read_some = getattr(source, "read1", source.read)
    try:
        while chunk := read_some(_CHUNK):
            loop.call_soon_threadsafe(reader.feed_data, chunk)
        loop.call_soon_threadsafe(reader.feed_eof)
    except (OSError, ValueError, RuntimeError):
        pass  # The stream or the loop is closed, so that no more input is needed.


def serve_port(
    port: int, handler: Callable[[Connection], Handler], listening: Callable[[int], None], *, once: bool = False
) -> None:
    """Serve clients on a port of this machine, each separately, until an interrupt; with `once`, only the first.

    `listening` is called with the port. Port 0 selects a free one.
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
                pass  # The client has disconnected, or the server stops.
            finally:
                writer.close()
                if once:
                    done.set()

        server = await asyncio.start_server(client, "127.0.0.1", port, limit=MOST_BYTES)
        listening(server.sockets[0].getsockname()[1])
        async with server:
            await done.wait()

    asyncio.run(serve())
