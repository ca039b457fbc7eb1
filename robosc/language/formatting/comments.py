"""The comments of a text, by the word that they stand before."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robosc.language.formatting.documents import INDENTATION, Comment
from robosc.language.grammar import pattern

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.language.grammar import Node

_COMMENT = re.compile(pattern("Comment"))


@dataclass(frozen=True)
class Space:
    """What stands before a word: comments, and how many line breaks before each of them and before the word."""

    comments: list[Comment] = field(default_factory=list)
    breaks: list[int] = field(default_factory=lambda: [0])

    def parted(self) -> tuple[Space, Space]:
        """The comments up to the first one beside a line break, and all others with their line breaks."""
        count = len(self.comments)
        at = next((index for index in range(count) if self.breaks[index] or self.breaks[index + 1]), count)
        return Space(self.comments[:at], [0] * (at + 1)), Space(self.comments[at:], self.breaks[at:])

    def joined(self, other: Space) -> Space:
        """The comments of both."""
        if not self.comments:
            return other
        between = max(self.breaks[-1], other.breaks[0])
        return Space(self.comments + other.comments, [*self.breaks[:-1], between, *other.breaks[1:]])

    @property
    def trailing(self) -> int:
        """How many of the comments stand at the end of the line of the word before."""
        return next((index for index, breaks in enumerate(self.breaks) if breaks), 0)


def spaces(text: str, words: Iterable[Node]) -> dict[int, Space]:
    """The space before each word of a parse tree, by the word's offset, and that before the end of the text.

    A comment at the end of a line or in a line of its own that stands before a comma or an opening brace counts as
    standing behind it, where the comma and the brace are moved to the line before.
    """
    found: dict[int, Space] = {}
    end, moved = 0, Space()
    for word in words:
        space = moved.joined(_space(text, end, word.position))
        moved = Space()
        if word.value in {",", "{"}:
            space, moved = space.parted()
        found[word.position] = space
        end = word.position_end
    found[len(text)] = moved.joined(_space(text, end, len(text)))
    return found


def _space(text: str, start: int, end: int) -> Space:
    """The space between two offsets; there are line breaks around a text."""
    comments: list[Comment] = []
    breaks: list[int] = []
    for found in _COMMENT.finditer(text, start, end):
        breaks.append(text.count("\n", start, found.start()) or int(start == 0))
        line = text.rfind("\n", 0, found.start()) + 1
        column = len(text[line : found.start()].expandtabs(INDENTATION))
        comments.append(Comment(found.group(), column))
        start = found.end()
    breaks.append(text.count("\n", start, end) or int(end == len(text)))
    return Space(comments, breaks)
