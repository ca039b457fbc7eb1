"""Generated C engine, compiled with a program that runs it."""

from __future__ import annotations

import errno
import os
import re
import shutil
import signal
import subprocess
import sys
from contextlib import contextmanager
from functools import cached_property
from typing import TYPE_CHECKING

from robosc.base.files.resources import locate
from robosc.m2t.c.comments import string_literal
from robosc.m2t.c.names import CNames
from robosc.model.semantics.roles import assumptions, event_name, is_from_cif
from robosc.synthesis.encoding import smallest

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from robosc.model import sct
    from robosc.synthesis.encoding import Element

TEXT = "the generated C"
COMPILERS = ("cc", "gcc", "clang")
#: Messages of a compiler that lacks room, as opposed to a compiler that rejects its text.
_SHORTAGE = re.compile(
    "|".join([*map(os.strerror, (errno.ENOSPC, errno.EDQUOT, errno.ENOMEM)), "Killed signal", "memory exhausted"])
)


def c_compiler() -> str | None:
    """Return the first C compiler on the path, or None."""
    return next(filter(shutil.which, COMPILERS), None)


class CompileError(Exception):
    """The generated text is not valid C; the message has the compiler's error."""


class CProgram:
    """Engine of a model in a folder, and its parts in the order that the programs use.

    Raises CompileError if the text is not valid C, and OSError if it cannot be compiled for another reason.
    """

    def __init__(
        self, model: sct.SupervisoryControlModel, folder: Path, compiler: str, files: Mapping[str, str]
    ) -> None:
        self.model = model
        self.folder = folder
        self._compiler = compiler
        #: Elements of the engine's state, and its inputs.
        self.cells: list[Element] = []
        for plant in model.plants:
            self.cells += [*([plant] if len(plant.locations) > 1 else []), *plant.variables]
        self.inputs: list[Element] = [parameter for plant in model.plants for parameter in plant.inputs]
        self.events = [event for plant in model.plants for event in plant.events]
        self.assumptions = assumptions(model)
        for path, text in files.items():
            (folder / path).write_text(text, encoding="utf-8")
        names = CNames(model)
        (folder / "model.h").write_text(self._header(names), encoding="utf-8")
        self._compile("-c", f"{names.prefix}_supervisor.c", "-o", "engine.o")

    @cached_property
    def explorer(self) -> str:
        """Command that compares the events of the engine with their decision diagrams."""
        return self._linked("explorer")

    @cached_property
    def follower(self) -> str:
        """Command that runs the engine's control loop."""
        return self._linked("follower")

    def _linked(self, name: str) -> str:
        shutil.copy(locate(f"analysis/verify/{name}.c"), self.folder)
        self._compile(f"{name}.c", "engine.o", "-o", name)
        return f"./{name}"

    def _compile(self, *arguments: str) -> None:
        done = self.run_command([self._compiler, "-std=c99", "-O1", "-w", *arguments])
        if done.returncode == 0:
            return
        short = next((line for line in done.stderr.splitlines() if _SHORTAGE.search(line)), None)
        if short is not None or done.returncode < 0:
            raise OSError(short or f"{self._compiler} was ended by signal {-done.returncode}")
        first = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr.strip())
        raise CompileError(f"{self._compiler} does not compile {TEXT}: {first}")

    def run_command(self, command: Sequence[str]) -> subprocess.CompletedProcess[str]:
        """Run a command in the folder as `subprocess.run` does; an interrupt also ends its child processes."""
        with self.start_command(command) as process:
            output, errors = process.communicate()
        return subprocess.CompletedProcess(command, process.returncode, output, errors)

    @contextmanager
    def start_command(self, command: Sequence[str]) -> Iterator[subprocess.Popen[str]]:
        """Start a command in the folder; an exception in the `with` block ends it with its child processes."""
        with subprocess.Popen(  # noqa: S603
            command,
            cwd=self.folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            env={**os.environ, "LC_ALL": "C"},
            process_group=0,
        ) as process:
            try:
                yield process
            except BaseException:
                if sys.platform == "win32":
                    process.kill()
                else:
                    os.killpg(process.pid, signal.SIGKILL)
                raise

    def _header(self, names: CNames) -> str:
        """Return the part of `explorer.c` that depends on the model; `explorer.c` documents each macro."""

        def for_all(elements: Sequence[Element]) -> str:
            expressions = (
                f"DO({number}, {names.member(element)}, {smallest(element) % 2**64})"
                for number, element in enumerate(elements)
            )
            return " ".join(expressions)

        durations = (f"DO({number}, {names.setting(duration)})" for number, duration in enumerate(self.model.durations))
        events = " ".join(f"{string_literal(event_name(event))}," for event in self.events)
        return (
            f'#include "{names.prefix}_supervisor.h"\n'
            f"enum {{ CELLS = {len(self.cells)}, INPUTS = {len(self.inputs)}, EVENTS = {len(self.events)} }};\n"
            f"#define EVENT_NAMES {events}\n"
            f"#define FOR_CELLS(DO) {for_all(self.cells)}\n"
            f"#define FOR_INPUTS(DO) {for_all(self.inputs)}\n"
            f"#define ENGINE(name) {names.prefix}_##name\n"
            f"#define ENGINE_EVENTS {names.macro}_EVENT_COUNT\n"
            f"#define FOR_DURATIONS(DO) {' '.join(durations)}\n"
            + ("#define TIMES\n" if any(event.timer for event in self.events) else "")
            + (f"#define ASSUMPTIONS {len(self.assumptions)}\n" if self.assumptions else "")
            + ("#define STEPWISE\n" if is_from_cif(self.model) else "")
        )
