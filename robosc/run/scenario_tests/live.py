"""Scenarios against a node over ROS: the trace player of generated packages plays the event log of each."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import IO, TYPE_CHECKING

from robosc.base.files.writing import temporary_folder

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from robosc.base.diagnostics import Diagnostic
    from robosc.run.scenario_tests.reading import Line, Scenario

#: Seconds that a node has to end after an interrupt.
_PATIENCE = 20.0
#: Report of the player about a line of the log.
_DIFFERENCE = re.compile(r"line (\d+)( cannot be played)?: (.*)")
_MISSING = re.compile(r"(?:ModuleNotFound|Import)Error: (.*)")
#: Number of characters shown of a program's output.
_SHOWN = 1500


class LiveError(Exception):
    """Error for a node that is missing, or does not start. The message gives the reason."""


@dataclass(frozen=True)
class LiveNode:
    """Node that is restarted for each scenario, in simulated time.

    `command` starts it; parameters and the path of its event log are added. `files` are those of the folder `test` of
    the package that would be generated for its model.
    """

    command: Sequence[str]
    parameters: Mapping[str, bool | int]
    files: Mapping[str, str]

    def follow(self, scenario: Scenario, trace: Sequence[str], lines: Sequence[Line]) -> Diagnostic | None:
        """Return a finding if the node deviates from the event log of a scenario, else None.

        `lines` are the lines of the scenario that caused the lines of the log. Raises LiveError if there is no ROS, or
        if the node does not start.
        """
        with temporary_folder() as folder:
            for name, text in self.files.items():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / name).write_text(text, encoding="utf-8")
            log, played = folder / "events.jsonl", folder / "scenario.jsonl"
            played.write_text("".join(f"{line}\n" for line in trace), encoding="utf-8")
            with (folder / "node.txt").open("w+b") as node_output, self._started(log, node_output) as node:
                status, player_output = self._play(folder, played, log, node)
                missing = _MISSING.search(player_output)
                if status is None:
                    raise LiveError(f"the node ended before the scenario:\n{_end(node_output)}")
                if missing is not None:
                    raise LiveError(f"this Python has no ROS 2: {missing[1]}")
                if not status:
                    return None
                difference = _DIFFERENCE.search(player_output)
                if difference is None:
                    message = f"playing over ROS failed: {player_output.strip()[-_SHOWN:]}"
                    return scenario.line.fault(message, _end(node_output))
        line = lines[int(difference[1]) - 1] if int(difference[1]) <= len(lines) else scenario.line
        verdict = "this cannot be played over ROS" if difference[2] else "the node deviates from the scenario"
        return line.fault(f"{verdict}: {difference[3].strip()}")

    @contextmanager
    def _started(self, log: Path, output: IO[bytes]) -> Iterator[subprocess.Popen[bytes]]:
        parameters = {"event_log": str(log), **self.parameters}
        values = {
            name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in parameters.items()
        }
        values["use_sim_time"] = "true"
        arguments = ["--ros-args", *(word for name in values for word in ("-p", f"{name}:={values[name]}"))]
        try:
            node = subprocess.Popen(  # noqa: S603  # the user gives the command that starts the node
                [*self.command, *arguments],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        except OSError as error:
            raise LiveError(f"`{shlex.join(self.command)}` does not start: {error.strerror}") from None
        try:
            yield node
        finally:
            _ended(node)

    def _play(self, folder: Path, played: Path, log: Path, node: subprocess.Popen[bytes]) -> tuple[int | None, str]:
        """Return the exit status and the output of the player; no status if the node ends first."""
        command: list[str | Path] = [sys.executable, folder / "play_trace.py", played, log]
        with (folder / "player.txt").open("w+b") as output:
            player = subprocess.Popen(  # noqa: S603  # this Python, and a program that was just written
                command,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            try:
                while player.poll() is None:
                    if node.poll() is not None:
                        return None, ""
                    with suppress(subprocess.TimeoutExpired):
                        player.wait(0.1)
            finally:
                _ended(player)
            output.seek(0)
            return player.returncode, output.read().decode(errors="replace")


def _end(output: IO[bytes]) -> str:
    output.seek(0)
    return output.read().decode(errors="replace").strip()[-_SHOWN:]


def _ended(process: subprocess.Popen[bytes]) -> None:
    """End a program and all its children."""
    for number in (signal.SIGINT, signal.SIGKILL):
        with suppress(ProcessLookupError):
            os.killpg(process.pid, number)
        with suppress(subprocess.TimeoutExpired):
            process.wait(_PATIENCE)
