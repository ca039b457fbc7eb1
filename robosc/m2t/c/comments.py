"""Text of a model, made safe for comments and string literals of C."""

from __future__ import annotations

import textwrap
import unicodedata
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

_WIDTH = 100


def comment_text(text: str) -> str:
    """The text on one line, with nothing in it that could end a comment, start one, or draw a compiler's warning."""
    plain = "".join(" " if unicodedata.category(character)[0] in "CZ" else character for character in text)
    for risky in ("*/", "/*", "??"):
        while risky in plain:
            plain = plain.replace(risky, f"{risky[0]} {risky[1]}")
    return " ".join(plain.split())


def comment(paragraphs: Iterable[str], indent: int = 0) -> str:
    """A block comment, each paragraph on lines of its own, all indented, without a line end; "" of no text."""
    lines = [
        line
        for text in paragraphs
        for line in textwrap.wrap(
            comment_text(text), _WIDTH - indent - 6, break_long_words=False, break_on_hyphens=False
        )
    ]
    margin = " " * indent
    if not lines:
        return ""
    return "\n".join(f"{margin}{' *' if number else '/*'} {line}" for number, line in enumerate(lines)) + " */"


def string_literal(text: str) -> str:
    """A C string literal with the text in UTF-8; everything but letters, digits and plain signs as octal escapes."""
    return '"' + "".join(_character(byte) for byte in text.encode()) + '"'


def _character(byte: int) -> str:
    plain = chr(byte)
    return plain if 32 <= byte < 127 and plain not in '"\\?' else f"\\{byte:03o}"
