"""Characters that are invisible, or that make a terminal show something other than the text."""

from __future__ import annotations

import re

#: Control characters, characters that break or reorder lines, characters without width, and noncharacters.
HIDDEN = (
    *((0x00, 0x1F), (0x7F, 0x9F), (0xAD, 0xAD), (0x34F, 0x34F), (0x61C, 0x61C), (0x115F, 0x1160), (0x17B4, 0x17B5)),
    *((0x180B, 0x180F), (0x200B, 0x200F), (0x2028, 0x202E), (0x2060, 0x206F), (0x3164, 0x3164), (0xFE00, 0xFE0F)),
    *((0xFEFF, 0xFEFF), (0xFFA0, 0xFFA0), (0xFFF0, 0xFFFB), (0xFFFE, 0xFFFF), (0xE0000, 0xE0FFF)),
)
#: A regular expression that matches one of them.
HIDDEN_PATTERN = f"[{''.join(f'{chr(first)}-{chr(last)}' for first, last in HIDDEN)}]"
_HIDDEN = re.compile(HIDDEN_PATTERN)


def visible(text: str) -> str:
    """Return a text in one line, with each invisible or active character as its code, as JSON writes it.

    These are the characters in `HIDDEN` and all others that are not printable. All output for people passes through
    here.
    """
    if text.isprintable() and not _HIDDEN.search(text):
        return text
    return "".join(
        character if character.isprintable() and not _HIDDEN.match(character) else code(character) for character in text
    )


def visible_lines(text: str) -> str:
    """Return a text with its line breaks and tabs, and everything else as `visible` shows it."""
    return "\n".join("\t".join(map(visible, line.split("\t"))) for line in text.split("\n"))


def code(character: str) -> str:
    """Return a character as strings of JSON and of RoboSC escape it."""
    units = character.encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{units[at : at + 4]}" for at in range(0, len(units), 4))
