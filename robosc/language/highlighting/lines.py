"""Colored lines of a text for a page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pygments.token import Comment, Keyword, Name, Number, Operator, String

from robosc.language.highlighting.pygments_lexer import RoboscLexer

if TYPE_CHECKING:
    from pygments.token import _TokenType

#: Classes of a page: keywords, types, numbers and strings, comments.
_CLASSES: list[tuple[_TokenType, str]] = [
    (Comment, "c"),
    (Keyword.Type, "t"),
    (Keyword, "k"),
    (Operator.Word, "k"),
    (Number, "n"),
    (String, "n"),
    (Name.Class, "t"),
]


def color_lines(path: str, text: str) -> list[list[tuple[str, str]]]:
    """Return the lines of a text as pieces: the class (`k`, `t`, `n`, `c` or empty), and the text.

    Only `.rscd` files are colored.
    """
    lines: list[list[tuple[str, str]]] = [[]]
    pieces = RoboscLexer(stripnl=False, ensurenl=False).get_tokens(text) if path.endswith(".rscd") else [(None, text)]
    for token, piece in pieces:
        kind = next((name for known, name in _CLASSES if token is not None and token in known), "")
        for number, part in enumerate(piece.split("\n")):
            if number:
                lines.append([])
            if part and lines[-1] and lines[-1][-1][0] == kind:
                lines[-1][-1] = (kind, lines[-1][-1][1] + part)
            elif part:
                lines[-1].append((kind, part))
    return lines
