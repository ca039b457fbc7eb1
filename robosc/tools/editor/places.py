"""Conversion of places in texts to and from the protocol."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.base.diagnostics import Edit, Span
    from robosc.language.text import Text
    from robosc.tools.editor.project import Snapshot


def to_range(text: Text, start: int, end: int) -> types.Range:
    """Return the range between two offsets."""
    return types.Range(types.Position(*text.to_utf16(start)), types.Position(*text.to_utf16(max(start, end))))


def span_range(text: Text, span: Span) -> types.Range:
    """Return the range of a span."""
    return to_range(text, text.offset(span.line, span.column), text.offset(span.end_line, span.end_column))


def to_edits(text: Text, edits: Iterable[Edit]) -> list[types.TextEdit]:
    """Return the edits of a text."""
    return [types.TextEdit(span_range(text, edit.span), edit.text) for edit in edits]


def to_offset(text: Text, position: types.Position) -> int:
    """Return the offset of a position."""
    return text.from_utf16(position.line, position.character)


def location(snapshot: Snapshot, text: Text, start: int, end: int) -> types.Location:
    """Return the range between two offsets of a text, with the text's URI."""
    return types.Location(snapshot.uri(text.file), to_range(text, start, end))
