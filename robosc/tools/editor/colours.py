"""Semantic tokens."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lsprotocol import types

from robosc.language.semantic_tokens import CLASSES, classify

if TYPE_CHECKING:
    from robosc.tools.editor.project import Analysis, Snapshot

_MODIFIERS = ("declaration", "readonly")
LEGEND = types.SemanticTokensLegend(list(CLASSES), list(_MODIFIERS))


def semantic_tokens(_: Snapshot, analysis: Analysis, params: types.SemanticTokensParams) -> types.SemanticTokens:
    """Return the words of a text and their kinds, each position relative to the previous word."""
    text, data = analysis.text, list[int]()
    before = (0, 0)
    for word in classify(analysis.file):
        modifiers = word.declares + 2 * word.readonly
        start = word.start
        # A token must not extend beyond the end of its line.
        for piece in text.content[word.start : word.end].split("\n"):
            line, unit = text.to_utf16(start)
            length = len(piece.encode("utf-16-le", "surrogatepass")) // 2
            if length:
                data += line - before[0], unit - (before[1] if line == before[0] else 0), length
                data += CLASSES.index(word.what), modifiers
                before = line, unit
            start += len(piece) + 1
    return types.SemanticTokens(data)
