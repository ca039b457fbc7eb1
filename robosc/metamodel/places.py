"""Where the elements of a model stand in the text that they come from."""

import re
from typing import Any

from robosc.diagnostics import Span

_SOURCE = re.compile(r"(?:(?P<file>.*):)?(\d+):(\d+)-(\d+):(\d+)", re.DOTALL)
START = Span(1, 1, 1, 1)


def parse_source(source: str | None) -> tuple[str | None, Span] | None:
    """The file (None where it names none) and the span that a `source` attribute stands for; None without a source."""
    match = _SOURCE.fullmatch(source or "")
    if match is None:
        return None
    file, *numbers = match.groups()
    return file, Span(*map(int, numbers))


def place(element: Any) -> tuple[str, Span]:
    """The file and the span of an element, or of the nearest one around it that has a `source`.

    Without any the file is what the root says of itself, or its name, and the span its first character.
    """
    around = element
    found = None
    root = element
    while around is not None:
        found = found or parse_source(around.source)
        root, around = around, around.eContainer()
    file, span = found or (None, START)
    return file or getattr(root, "file", None) or root.name or "model", span
