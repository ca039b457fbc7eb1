"""Lines of a text: conversion of offsets to lines and columns, and back."""

from __future__ import annotations

from bisect import bisect_right
from functools import lru_cache


class Lines:
    """Start offsets of the lines of a text, whose line breaks are line feeds.

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
        """Return the line and the column of an offset; an offset behind the end means the end."""
        offset = min(offset, self._length)
        line = bisect_right(self.starts, offset)
        return line, offset - self.starts[line - 1] + 1

    def line(self, number: int) -> tuple[int, int]:
        """Return the start and end offset of a line without its line break; behind the last line, the end twice."""
        if number > len(self.starts):
            return self._length, self._length
        end = self.starts[number] - 1 if number < len(self.starts) else self._length
        return self.starts[number - 1], end

    def offset(self, line: int, column: int) -> int:
        """Return the offset of a line and a column; a column behind the end of its line means the end."""
        if line < 1 or column < 1:
            return 0
        start, end = self.line(line)
        return min(start + column - 1, end)


@lru_cache(maxsize=4)
def lines(content: str) -> Lines:
    """Return the lines of a text; the last few texts are cached."""
    return Lines(content)
