"""Where the elements of a model stand in the text that they come from."""

from typing import Any

from robosc.diagnostics import START, Span
from robosc.metamodel.files import located


def parse_source(source: str | None) -> tuple[str | None, Span] | None:
    """The file (None where it names none) and the span that a `source` attribute stands for; None without a source."""
    span = Span.parse(source)
    if source is None or span is None:
        return None
    file = source.rsplit(":", 3)[:-3]
    return (file[0] if file else None), span


def place(element: Any) -> tuple[str, Span]:
    """The file, as the user would write it, and the span of an element, or of the nearest around it with a `source`.

    Without any the file is what the root says of itself, or its name, and the span its first character.
    """
    around = element
    found = None
    root = element
    while around is not None:
        found = found or parse_source(around.source)
        root, around = around, around.eContainer()
    file, span = found or (None, START)
    file = file or getattr(root, "file", None)
    return located(root, file) if file else root.name or "model", span
