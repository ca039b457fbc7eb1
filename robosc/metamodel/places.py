"""Where the elements of a model stand in the texts that they come from."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.diagnostics import START, Span

if TYPE_CHECKING:
    from collections.abc import MutableMapping

_PLACE = re.compile(r"(?:(?P<file>[\s\S]+):)?(\d{1,9}):(\d{1,9})-(\d{1,9}):(\d{1,9})")


@dataclass(unsafe_hash=True)
class SourceFile:
    """A text that elements come from.

    `name` is relative to the folder of the model, so the same on every machine, and no other file of the model has it.
    `path` is the file as the user of this run would write it, `parsed` the `robosc.language.File` of its text, None
    for a model that was loaded; models save neither.
    """

    name: str
    path: str = field(default="", compare=False)
    parsed: Any = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        """The name is the path where no other is known."""
        self.path = self.path or self.name


@dataclass(frozen=True)
class Place:
    """A span of a file; None where a saved model does not say which file it comes from."""

    file: SourceFile | None
    span: Span

    def __str__(self) -> str:
        """`file:line:column-line:column`, as models save it."""
        span = f"{self.span.line}:{self.span.column}-{self.span.end_line}:{self.span.end_column}"
        return f"{self.file.name}:{span}" if self.file else span

    @classmethod
    def parse(cls, text: str, files: MutableMapping[str, SourceFile] | None = None, file: str = "") -> Place | None:
        """The place that a text stands for, in `file` where it names none; None where it stands for none.

        `files` are those known by their names; a new one is added.
        """
        found = _PLACE.fullmatch(text)
        if found is None:
            return None
        name = found["file"] or file
        known = {} if files is None else files
        span = Span(*(int(number) for number in found.groups()[1:]))
        return cls(known.setdefault(name, SourceFile(name)) if name else None, span)


def place(element: Any) -> tuple[str, Span]:
    """The file, as the user would write it, and the span of an element, or of the nearest around it with a `source`.

    Without any the file is what the root says of itself, or its name, and the span its first character.
    """
    found: Place | None = None
    root = around = element
    while around is not None:
        found = found or around.source
        if found is not None and found.file is not None:
            return found.file.path, found.span
        root, around = around, around.eContainer()
    return getattr(root, "file", None) or root.name or "model", found.span if found else START
