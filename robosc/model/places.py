"""Places of a model's elements in their source texts."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import START, Span

if TYPE_CHECKING:
    from collections.abc import MutableMapping

_PLACE = re.compile(r"(?:(?P<file>[\s\S]+):)?(\d{1,9}):(\d{1,9})-(\d{1,9}):(\d{1,9})")


@dataclass(unsafe_hash=True)
class SourceFile:
    """A source text of elements.

    `name` is relative to the folder of the model, so that it is the same on every machine. It is unique in the model.
    `path` is the file as the user of this run would write it. `parsed` is the `robosc.language.File` of its text, None
    for a loaded model. Saved models contain neither of them.
    """

    name: str
    path: str = field(default="", compare=False)
    parsed: Any = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Use the name as path if no other is known."""
        self.path = self.path or self.name


@dataclass(frozen=True)
class Place:
    """A span of a file. The file is None if a saved model does not name it."""

    file: SourceFile | None
    span: Span

    def __str__(self) -> str:
        """Return `file:line:column-line:column`, as in saved models."""
        span = f"{self.span.line}:{self.span.column}-{self.span.end_line}:{self.span.end_column}"
        return f"{self.file.name}:{span}" if self.file else span

    @classmethod
    def parse(cls, text: str, files: MutableMapping[str, SourceFile] | None = None, file: str = "") -> Place | None:
        """Return the place that a text describes, by default in `file`. None if it describes none.

        `files` are the known files by name. A new file is added to it.
        """
        match = _PLACE.fullmatch(text)
        if match is None:
            return None
        name = match["file"] or file
        known = {} if files is None else files
        span = Span(*(int(number) for number in match.groups()[1:]))
        return cls(known.setdefault(name, SourceFile(name)) if name else None, span)


def place(element: Any) -> tuple[str, Span]:
    """Return the file, as the user would write it, and the span of an element.

    An element without a `source` has the place of its nearest container with one. If there is none, the file is that of
    the root, or the name of the root, and the span is the first character.
    """
    nearest: Place | None = None
    root = around = element
    while around is not None:
        nearest = nearest or around.source
        if nearest is not None and nearest.file is not None:
            return nearest.file.path, nearest.span
        root, around = around, around.eContainer()
    return getattr(root, "file", None) or root.name or "model", nearest.span if nearest else START
