"""Programs of a test, which end with it."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path
    from types import TracebackType

#: Seconds for a quick operation on a machine with twenty other busy programs.
PATIENCE = 120


class Processes:
    """Programs, each with a log file and a process group of its own; leaving the context stops them all."""

    def __init__(self, environment: dict[str, str], logs: Path) -> None:
        self.environment = environment
        self._logs = logs
        self._started: list[tuple[str, subprocess.Popen[bytes]]] = []

    def start(self, name: str, command: Sequence[str | Path], *, steered: bool = False) -> subprocess.Popen[bytes]:
        """Start a program with the log file `name`; a `steered` one has pipes as standard input and output."""
        with (self._logs / f"{name}.log").open("wb") as log:
            process = subprocess.Popen(
                [str(word) for word in command],
                env=self.environment,
                cwd=self._logs,
                stdin=subprocess.PIPE if steered else subprocess.DEVNULL,
                stdout=subprocess.PIPE if steered else log,
                stderr=log if steered else subprocess.STDOUT,
                start_new_session=True,
                # The tests may run with SIGHUP ignored (nohup); a program in a terminal does not ignore it.
                preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),  # noqa: PLW1509
            )
        self._started.append((name, process))
        return process

    def wait_until(self, condition: Callable[[], bool], what: str, seconds: float = PATIENCE) -> None:
        """Wait for a condition; fail with the logs of the programs after `seconds`."""
        until = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < until, f"{what}: not within {seconds} s\n{self.logs()}"
            time.sleep(0.05)

    def stop(self, process: subprocess.Popen[bytes]) -> int:
        """Interrupt a program like Ctrl-C, and kill it if it does not end; return its exit status."""
        self._signal(process, signal.SIGINT)
        try:
            return process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._signal(process, signal.SIGKILL)
            return process.wait()

    def logs(self) -> str:
        """Return the output of all programs."""
        texts = ((name, (self._logs / f"{name}.log").read_text(errors="replace")) for name, _ in self._started)
        return "\n".join(f"--- {name}\n{text[-3000:]}" for name, text in texts)

    def __enter__(self) -> Processes:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for _, process in reversed(self._started):
            if process.poll() is None:
                self.stop(process)
        for _, process in self._started:
            # Children of a program are in its process group.
            self._signal(process, signal.SIGKILL)

    @staticmethod
    def _signal(process: subprocess.Popen[bytes], number: signal.Signals) -> None:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, number)
