"""Escapes text of a model for comments and string literals of C."""

from __future__ import annotations

import textwrap
import unicodedata
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

_WIDTH = 100


def comment_text(text: str) -> str:
    """Return the text on one line, without anything that ends or starts a comment or causes a compiler's warning."""
    plain = "".join(" " if unicodedata.category(character)[0] in "CZ" else character for character in text)
    for risky in ("*/", "/*", "??"):
        while risky in plain:
            plain = plain.replace(risky, f"{risky[0]} {risky[1]}")
    return " ".join(plain.split())


def comment(paragraphs: Iterable[str], indent: int = 0) -> str:
    """Return an indented block comment without a line end; each paragraph starts a new line. "" if there is no text."""
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
    """Return a C string literal of the text in UTF-8. Unsafe characters become octal escapes."""
    return '"' + "".join(_character(byte) for byte in text.encode()) + '"'


def _character(byte: int) -> str:
    plain = chr(byte)
    return plain if 32 <= byte < 127 and plain not in '"\\?' else f"\\{byte:03o}"
