"""What other packages add to the tool: targets and synthesizers, found by the entry points of their packages."""

from __future__ import annotations

import re
import sys
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from functools import cache
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any, Literal

from robosc.diagnostics import START, Diagnostic, ModelError, Severity, Span
from robosc.diagnostics.visible import visible

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from importlib.metadata import EntryPoint

#: The groups of entry points.
Group = Literal["robosc.targets", "robosc.synthesizers"]


@dataclass(frozen=True)
class Extension:
    """An entry point of an installed package; nothing of the package is loaded before `load`."""

    entry: EntryPoint

    @property
    def name(self) -> str:
        """What it is called on the command line."""
        return self.entry.name

    @property
    def package(self) -> str:
        """The package that it comes from, with its version."""
        made_by = self.entry.dist
        return f"{made_by.name} {made_by.version}" if made_by else "an unknown package"

    @property
    def description(self) -> str:
        """The package in one line, as it says itself."""
        summary = self.entry.dist.metadata["Summary"] if self.entry.dist else None
        return visible(summary or self.package)

    def load(self, *functions: str) -> Any:
        """The object of the entry point, which has these functions. Raises ModelError where it can't be had."""
        with self.working():
            loaded = self.entry.load()
        for function in functions:
            if not callable(getattr(loaded, function, None)):
                raise self.fault(f"`{self.entry.value}` has no function `{function}`")
        return loaded

    @contextmanager
    def working(self) -> Iterator[None]:
        """While it lasts the code of the package runs: whatever it raises is told as a fault of it, by a ModelError.

        What it prints goes to the standard error output: the other is the tool's own.
        """
        try:
            with redirect_stdout(sys.stderr):
                yield
        except (ModelError, MemoryError):
            raise
        except Exception as error:
            raise self.fault(f"{type(error).__name__}: {error}") from error

    def fault(self, reason: str) -> ModelError:
        """What is wrong with it, located where its package declares it."""
        hint = f"mend or remove it: `pip uninstall {self.entry.dist.name}`" if self.entry.dist else None
        message = f"`{self.name}` of {self.package} does not work: {visible(reason)}"
        return ModelError([Diagnostic(*self._declared(), Severity.ERROR, "extension", message, hint)])

    def _declared(self) -> tuple[str, Span]:
        """The file that declares it, and where."""
        made_by = self.entry.dist
        files = (made_by.files if made_by else None) or []
        file = next((str(file.locate()) for file in files if file.name == "entry_points.txt"), self.entry.value)
        lines = ((made_by.read_text("entry_points.txt") if made_by else None) or "").splitlines()
        for number, line in enumerate(lines, 1):
            if re.match(rf"\s*{re.escape(self.name)}\s*=\s*{re.escape(self.entry.value)}\s*$", line):
                return file, Span(number, 1, number, len(line) + 1)
        return file, START


@cache
def extensions(group: Group) -> Mapping[str, Extension]:
    """What is installed of a group, by name; of two of one name the first by package."""
    found: dict[str, Extension] = {}
    entries = [(entry.name, entry.dist.name if entry.dist else "", entry) for entry in entry_points(group=group)]
    for name, _, entry in sorted(entries, key=lambda triple: triple[:2]):
        found.setdefault(name, Extension(entry))
    return found
