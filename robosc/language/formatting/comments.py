"""Comments of a text, by the word that follows them."""

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
    """Comments before a word, and the number of line breaks before each of them and before the word."""

    comments: list[Comment] = field(default_factory=list)
    breaks: list[int] = field(default_factory=lambda: [0])

    def split(self) -> tuple[Space, Space]:
        """Split at the first comment beside a line break, which belongs to the second part."""
        count = len(self.comments)
        at = next((index for index in range(count) if self.breaks[index] or self.breaks[index + 1]), count)
        return Space(self.comments[:at], [0] * (at + 1)), Space(self.comments[at:], self.breaks[at:])

    def join(self, other: Space) -> Space:
        """Return the comments of both, in order."""
        if not self.comments:
            return other
        between = max(self.breaks[-1], other.breaks[0])
        return Space(self.comments + other.comments, [*self.breaks[:-1], between, *other.breaks[1:]])

    @property
    def trailing(self) -> int:
        """Number of comments at the end of the previous word's line."""
        return next((index for index, breaks in enumerate(self.breaks) if breaks), 0)


def spaces(text: str, words: Iterable[Node]) -> dict[int, Space]:
    """Return the space before each word of a parse tree and before the end of the text, by offset.

    The layout moves a comma or an opening brace to the end of the previous line. Comments before it that end a line or
    fill their own line therefore count as standing behind it.
    """
    by_position: dict[int, Space] = {}
    end, moved = 0, Space()
    for word in words:
        space = moved.join(_space(text, end, word.position))
        moved = Space()
        if word.value in {",", "{"}:
            space, moved = space.split()
        by_position[word.position] = space
        end = word.position_end
    by_position[len(text)] = moved.join(_space(text, end, len(text)))
    return by_position


def _space(text: str, start: int, end: int) -> Space:
    """Return the space between two offsets. The start and the end of the text count as line breaks."""
    comments: list[Comment] = []
    breaks: list[int] = []
    for match in _COMMENT.finditer(text, start, end):
        breaks.append(text.count("\n", start, match.start()) or int(start == 0))
        line = text.rfind("\n", 0, match.start()) + 1
        column = len(text[line : match.start()].expandtabs(INDENTATION))
        comments.append(Comment(match.group(), column))
        start = match.end()
    breaks.append(text.count("\n", start, end) or int(end == len(text)))
    return Space(comments, breaks)
