"""Documents: words with gaps between them that may become line breaks, and their layout in lines.

A group that fits stays in its line. If it does not fit, outer groups break before inner ones (Wadler, "A prettier
printer", 2003; Lindig, "Strictly pretty", 2000).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property

#: Columns of a line of words, and of one indentation step.
WIDTH = 100
INDENTATION = 2

#: Words without a space behind them, and words without a space before them, whatever the gap is.
_OPENING, _CLOSING = ("(", "["), (")", "]", ",")


class Gap(Enum):
    """The gap between two words."""

    NONE = "nothing"
    SPACE = "a space"
    SOFT = "nothing, or a line break where the group around it breaks"
    BREAK = "a space, or a line break where the group around it breaks"
    LINE = "a line break"
    BLANK = "a line break and an empty line"


_ALWAYS = {Gap.LINE, Gap.BLANK}
_MAYBE = {Gap.SOFT, Gap.BREAK}


@dataclass(frozen=True)
class Comment:
    """A comment and its start column in the source."""

    text: str
    column: int


@dataclass(frozen=True)
class Indent:
    """A document whose line breaks indent by one more step."""

    content: Document


@dataclass(frozen=True)
class Group:
    """A document in which all gaps break, or none."""

    content: Document

    @cached_property
    def breaks(self) -> bool:
        """Whether the document contains an unconditional line break."""
        return _breaks(self.content)


Document = str | Gap | Comment | Indent | Group | tuple["Document", ...]


def _breaks(document: Document) -> bool:
    match document:
        case Gap():
            return document in _ALWAYS
        case Comment():
            return "\n" in document.text
        case Indent():
            return _breaks(document.content)
        case Group():
            return document.breaks
        case tuple():
            return any(map(_breaks, document))
    return False


def render(document: Document) -> str:
    """Return the lines of a document, each ended by a line feed."""
    lines = _Lines()
    todo: list[tuple[int, bool, Document]] = [(0, False, document)]
    while todo:
        indentation, flat, top = todo.pop()
        match top:
            case Gap.LINE | Gap.BLANK:
                lines.end(indentation, blank=top is Gap.BLANK)
            case Gap.SOFT | Gap.BREAK if not flat:
                lines.end(indentation)
            case Gap.SPACE | Gap.BREAK:
                lines.space()
            case str():
                lines.add(top)
            case Comment():
                lines.add_comment(top)
            case Indent():
                todo.append((indentation + INDENTATION, flat, top.content))
            case Group():
                flat = flat or (not top.breaks and _fits(WIDTH - lines.column, top.content, todo))
                todo.append((indentation, flat, top.content))
            case tuple():
                todo += [(indentation, flat, part) for part in reversed(top)]
    return lines.text()


def _fits(room: int, document: Document, following: list[tuple[int, bool, Document]]) -> bool:
    """Return whether a document, with the text up to the next possible line break, fits into `room` columns."""
    todo: list[tuple[bool, Document]] = [(True, document)]
    rest = ((flat, part) for _, flat, part in reversed(following))
    while room >= 0:
        flat, top = todo.pop() if todo else next(rest, (False, Gap.LINE))
        match top:
            case Indent() | Group():
                todo.append((flat, top.content))
            case tuple():
                todo += [(flat, part) for part in reversed(top)]
            case Gap() if top in _ALWAYS or (top in _MAYBE and not flat):
                return True
            case _:
                room -= _width(top)
                if isinstance(top, Comment) and ("\n" in top.text or top.text.startswith("//")):
                    return room >= 0
    return False


def _width(part: str | Gap | Comment) -> int:
    """Return the columns of a part.

    A comment to the end of its line counts as 0, because no line break could shorten it.
    """
    match part:
        case Gap():
            return int(part in {Gap.SPACE, Gap.BREAK})
        case Comment():
            return 0 if part.text.startswith("//") else len(part.text.partition("\n")[0])
    return len(part)


class _Lines:
    """Lines written so far.

    Gaps are pending until the next word. Line breaks override spaces, and the last line break counts.
    """

    def __init__(self) -> None:
        self._parts: list[str] = []
        self._column = 0
        self._indentation: int | None = None
        self._blank = False
        self._space = False

    @property
    def column(self) -> int:
        """Start column of the next word, counted from 0."""
        return self._column + self._space if self._indentation is None else self._indentation

    def end(self, indentation: int, *, blank: bool = False) -> None:
        self._indentation = indentation
        self._blank = self._blank or blank

    def space(self) -> None:
        self._space = True

    def add(self, word: str) -> None:
        if not self._parts:
            pass
        elif self._indentation is not None:
            self._parts.append("\n\n" if self._blank else "\n")
            self._parts.append(" " * self._indentation)
            self._column = self._indentation
        elif self._space and word not in _CLOSING and self._parts[-1] not in _OPENING:
            self._parts.append(" ")
            self._column += 1
        self._parts.append(word)
        self._column += len(word)
        self._indentation, self._blank, self._space = None, False, False

    def add_comment(self, comment: Comment) -> None:
        """Add a comment and shift its further lines by the same distance as its first line."""
        self.space()
        first, *others = comment.text.split("\n")
        self.add(first.rstrip())
        moved = self._column - len(first.rstrip()) - comment.column
        for line in others:
            content = line.strip()
            before = len(line.expandtabs(INDENTATION)) - len(line.expandtabs(INDENTATION).lstrip())
            shown = " " * (before + moved) + content if content else ""
            self._parts.append("\n" + shown)
            self._column = len(shown)
        self.space()

    def text(self) -> str:
        """Return all lines."""
        return "".join(self._parts) + "\n"
