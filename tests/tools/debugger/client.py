"""A client of the Debug Adapter Protocol, over standard input and output of `robosc dap` or over a port."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import IO, Any

ROOT = Path(__file__).parents[3]
Body = dict[str, Any]


class Client:
    """Send requests, and read responses and events in order; the test's timeout bounds all waiting."""

    def __init__(self, source: IO[bytes], sink: IO[bytes], folder: Path) -> None:
        """Relative paths of programs start at the folder."""
        self._source, self._sink, self._folder = source, sink, folder
        self._sequence = 0
        self.events: list[Body] = []

    # Messages

    def write(self, raw: bytes) -> None:
        self._sink.write(raw)
        self._sink.flush()

    def send(self, message: Any) -> None:
        body = message if isinstance(message, bytes) else json.dumps(message).encode()
        self.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))

    def read(self) -> Body | None:
        """Return the next message; None at the end of the stream."""
        length = None
        while line := self._source.readline():
            if line == b"\r\n":
                break
            name, _, value = line.partition(b":")
            assert name == b"Content-Length"
            length = int(value)
        if length is None:
            return None
        message: Body = json.loads(self._source.read(length))
        if message["type"] == "event":
            self.events.append(message)
        return message

    def ask(self, command: str, arguments: Any = None, **given: Any) -> Body:
        """Return the response to a request, whether it succeeds or fails."""
        self._sequence += 1
        sent = {"seq": self._sequence, "type": "request", "command": command}
        self.send({**sent, "arguments": arguments if arguments is not None else given})
        while True:
            message = self.read()
            assert message is not None, f"the adapter has ended before it answered {command}"
            if message["type"] == "response" and message["request_seq"] == self._sequence:
                assert message["command"] == command
                return message

    def do(self, command: str, **given: Any) -> Body:
        """Return the body of the response to a request that succeeds."""
        answer = self.ask(command, given)
        assert answer["success"], answer["message"]
        body: Body = answer.get("body", {})
        return body

    def refused(self, command: str, **given: Any) -> str:
        """Return the message of the response to a request that fails."""
        answer = self.ask(command, given)
        assert not answer["success"]
        assert answer["body"]["error"]["showUser"]
        message: str = answer["message"]
        return message

    def event(self, name: str) -> Body:
        """Return the body of the next event of a name."""
        while True:
            message = self.read()
            assert message is not None, f"the adapter has ended without {name}"
            if message["type"] == "event" and message["event"] == name:
                body: Body = message.get("body", {})
                return body

    # Requests of debuggers

    def launch(self, program: str | Path, **given: Any) -> Body:
        """Start a session without breakpoints; return the event with which it stops."""
        self.prepare(program, **given)
        return self.begin()

    def prepare(self, program: str | Path, **given: Any) -> None:
        """Launch a program before setting breakpoints."""
        self.do("initialize", adapterID="robosc")
        if "script" in given:
            given["script"] = str(self._folder / given["script"])
        self.do("launch", program=str(self._folder / program), **given)
        self.event("initialized")

    def begin(self) -> Body:
        self.do("configurationDone")
        return self.event("stopped")

    def go(self, command: str = "continue", **given: Any) -> Body:
        """Let the robot continue; return the event with which it stops."""
        self.do(command, threadId=1, **given)
        return self.event("stopped")

    def frames(self) -> list[Body]:
        frames: list[Body] = self.do("stackTrace", threadId=1)["stackFrames"]
        return frames

    def scope(self, name: str, frame: int = 1) -> dict[str, Body]:
        """Return the variables of a scope by their names."""
        scopes = {scope["name"]: scope for scope in self.do("scopes", frameId=frame)["scopes"]}
        return self.children(scopes[name])

    def children(self, of: Body) -> dict[str, Body]:
        return {
            variable["name"]: variable
            for variable in self.do("variables", variablesReference=of["variablesReference"])["variables"]
        }

    def console(self, text: str) -> str:
        result: str = self.do("evaluate", expression=text, context="repl")["result"]
        return result

    def said(self) -> str:
        """Return all output so far."""
        return "".join(event["body"]["output"] for event in self.events if event["event"] == "output")


class Program(Client):
    """`robosc dap` in its own process."""

    def __init__(self, folder: Path, *options: str, packages: Path = ROOT) -> None:
        """`packages` is a folder with further packages."""
        environment = {**os.environ, "PYTHONPATH": f"{ROOT}:{packages}"}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "robosc", "dap", *options],
            cwd=folder,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        super().__init__(self.process.stdout, self.process.stdin, folder)

    def end(self) -> tuple[int, str]:
        """Close the input; return the exit status and the standard error output."""
        _, told = self.process.communicate()
        return self.process.returncode, told.decode()


class OverPort(Client):
    """A session over a port."""

    def __init__(self, port: int, folder: Path) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port))
        stream = self._socket.makefile("rwb")
        super().__init__(stream, stream, folder)  # type: ignore[arg-type]

    def close(self) -> None:
        self._socket.close()
