"""Progress of operations that take longer than a second, on a terminal only, and their interruption."""

from __future__ import annotations

import os
import signal
import sys
from contextlib import contextmanager
from functools import cache
from threading import Event, Thread, Timer, current_thread, main_thread
from typing import TYPE_CHECKING

from robosc.model import expression as ex
from robosc.synthesis.memory import TooFewAddressesError
from robosc.tools.cli import INTERRUPTED, say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rich.status import Status

    from robosc.model import sct
    from robosc.synthesis import Statistics

PATIENCE_SECONDS = 1.0


class _Line:
    """A text that is computed anew at each update."""

    def __init__(self, text: Callable[[], str]) -> None:
        self._text = text

    def __rich__(self) -> str:
        return self._text()


@contextmanager
def progress(what: str | Callable[[], str]) -> Iterator[None]:
    """Show the text on a terminal while the `with` block runs for longer than a second, then erase it."""
    if not sys.stderr.isatty():
        yield
        return
    shown: list[Status] = []

    def show() -> None:
        from rich.console import Console

        status = Console(stderr=True).status(what if isinstance(what, str) else _Line(what))
        status.start()
        shown.append(status)

    timer = Timer(PATIENCE_SECONDS, show)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        for progress in shown:
            progress.stop()


@cache
def note_slow_diagrams() -> None:
    """Print a line, once, if synthesis runs without its library, which takes much longer for large models."""
    from robosc.synthesis.bdd import IS_PURE

    if IS_PURE:
        say("decision diagrams in pure Python: install `oxidd` for speed", err=True)


@contextmanager
def show_progress(model: sct.SupervisoryControlModel) -> Iterator[Statistics]:
    """Show the progress of a model's synthesis in the `with` block, which fills these statistics.

    An interrupt ends it within a moment. Raises MemoryError with a hint if memory is exhausted.
    """
    from robosc.synthesis import Statistics

    note_slow_diagrams()
    statistics = Statistics()
    try:
        with interruptible(), progress(lambda: _how_far(statistics)):
            yield statistics
    except TooFewAddressesError:
        raise
    except MemoryError as error:
        types = [variable.type for plant in model.plants for variable in plant.variables]
        types += [input_element.type for plant in model.plants for input_element in plant.inputs]
        has_integers = any(isinstance(kind, ex.IntegerType) for kind in types)
        smaller = "give integers smaller ranges" if has_integers else "use fewer states in the model"
        helps = f"raise `--memory` of `synthesize` or `transform`, or {smaller}"
        raise MemoryError(f"{str(error) or 'out of memory'}: {helps}") from error


def _how_far(statistics: Statistics) -> str:
    activity = "synthesizing the supervisor"
    if statistics.phase is None:
        return activity
    parts = [statistics.phase.value]
    if statistics.rounds:
        parts.append(f"round {statistics.rounds} on {_number(statistics.states)} states")
    parts += [f"{statistics.operations:,} operations", f"{statistics.peak_nodes:,} nodes"]
    return f"{activity}: {', '.join(parts)}"


def _number(number: int) -> str:
    digits = str(number)
    return f"{number:,}" if len(digits) < 13 else f"{digits[0]}.{digits[1]}e{len(digits) - 1}"


@contextmanager
def interruptible() -> Iterator[None]:
    """End the `with` block, or else the process, within a moment after an interrupt.

    Python handles a signal only between two operations, and an operation on decision diagrams may take minutes. The
    block must not hold resources that need cleanup. The process ends with the status for interrupts.

    A browser has no threads, and needs none: its decision diagrams are in pure Python.
    """
    if current_thread() is not main_thread() or sys.platform == "emscripten":
        yield
        return
    import socket

    ended = Event()
    ears, mouth = socket.socketpair()

    def listen() -> None:
        while heard := ears.recv(1):
            if heard[0] == signal.SIGINT and not ended.wait(PATIENCE_SECONDS):
                if sys.stderr.isatty():
                    # The progress display has hidden the cursor.
                    os.write(2, b"\r\x1b[2K\x1b[?25h")
                os._exit(INTERRUPTED)

    listener = Thread(target=listen, daemon=True)
    mouth.setblocking(False)
    before = signal.set_wakeup_fd(mouth.fileno(), warn_on_full_buffer=False)
    listener.start()
    try:
        yield
    finally:
        ended.set()
        signal.set_wakeup_fd(before)
        mouth.close()
        listener.join()
        ears.close()
