"""The lines of a text: from offsets to lines and columns, and back."""

from __future__ import annotations

from bisect import bisect_right
from functools import lru_cache


class Lines:
    """Where the lines of a text start, whose line breaks are line feeds.

    Offsets count code points from 0, lines and columns from 1.
    """

    def __init__(self, content: str) -> None:
        self._length = len(content)
        self.starts = [0]
        position = content.find("\n")
        while position >= 0:
            self.starts.append(position + 1)
            position = content.find("\n", position + 1)

    def place(self, offset: int) -> tuple[int, int]:
        """The line and the column of an offset; one behind the end is the end."""
        offset = min(offset, self._length)
        line = bisect_right(self.starts, offset)
        return line, offset - self.starts[line - 1] + 1

    def line(self, number: int) -> tuple[int, int]:
        """The offsets of the start and the end of a line, its line break left out; behind the last line the end."""
        if number > len(self.starts):
            return self._length, self._length
        end = self.starts[number] - 1 if number < len(self.starts) else self._length
        return self.starts[number - 1], end

    def offset(self, line: int, column: int) -> int:
        """The offset of a line and a column; what lies behind the end of a line is its end."""
        if line < 1 or column < 1:
            return 0
        start, end = self.line(line)
        return min(start + column - 1, end)


@lru_cache(maxsize=4)
def lines(content: str) -> Lines:
    """The lines of a text; those of the last few texts are kept."""
    return Lines(content)
