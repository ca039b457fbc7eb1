"""Targets and synthesizers of other packages, found by the entry points of these packages."""

from __future__ import annotations

import re
import sys
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from functools import cache
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any, Literal

from robosc.base.diagnostics import START, Diagnostic, ModelError, Severity, Span
from robosc.base.diagnostics.visible import visible

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from importlib.metadata import EntryPoint

#: Groups of entry points.
Group = Literal["robosc.targets", "robosc.synthesizers"]


@dataclass(frozen=True)
class Extension:
    """An entry point of an installed package; nothing of the package is loaded before `load`."""

    entry: EntryPoint

    @property
    def name(self) -> str:
        """The name of the extension on the command line."""
        return self.entry.name

    @property
    def package(self) -> str:
        """The package of the extension, with its version."""
        made_by = self.entry.dist
        return f"{made_by.name} {made_by.version}" if made_by else "an unknown package"

    @property
    def description(self) -> str:
        """The package's own summary in one line."""
        summary = self.entry.dist.metadata["Summary"] if self.entry.dist else None
        return visible(summary or self.package)

    def load(self, *functions: str) -> Any:
        """Return the object of the entry point, which has these functions.

        Raises ModelError if it is unusable.
        """
        with self.report_exceptions():
            loaded = self.entry.load()
        for function in functions:
            if not callable(getattr(loaded, function, None)):
                raise self.fault(f"`{self.entry.value}` has no function `{function}`")
        return loaded

    @contextmanager
    def report_exceptions(self) -> Iterator[None]:
        """Run code of the package in the `with` block; its exceptions become faults of the extension (ModelError).

        Its prints go to the standard error, because the standard output is the tool's own.
        """
        try:
            with redirect_stdout(sys.stderr):
                yield
        except (ModelError, MemoryError):
            raise
        except Exception as error:
            raise self.fault(f"{type(error).__name__}: {error}") from error

    def fault(self, reason: str) -> ModelError:
        """Return a fault of the extension, located at its declaration in the package."""
        hint = f"correct or remove it: `pip uninstall {self.entry.dist.name}`" if self.entry.dist else None
        message = f"`{self.name}` of {self.package} does not work: {visible(reason)}"
        return ModelError([Diagnostic(*self._declared(), Severity.ERROR, "extension", message, hint)])

    def _declared(self) -> tuple[str, Span]:
        """Return the file and the place of the declaration."""
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
    """Return the installed extensions of a group by name; of equal names, the first by package counts."""
    by_name: dict[str, Extension] = {}
    entries = [(entry.name, entry.dist.name if entry.dist else "", entry) for entry in entry_points(group=group)]
    for name, _, entry in sorted(entries, key=lambda triple: triple[:2]):
        by_name.setdefault(name, Extension(entry))
    return by_name
