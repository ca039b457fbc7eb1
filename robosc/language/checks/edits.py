"""Hints that name an edit, and the edits.

An edit removes tokens, replaces them or inserts text beside them. It never searches comments or strings.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from robosc.base.diagnostics import Edit
from robosc.model.places import place
from robosc.model.semantics.naming import escape_keyword

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.base.diagnostics import Repair
    from robosc.language.scopes import File
    from robosc.language.text import Text
    from robosc.language.tokens import Token
    from robosc.model import expression as ex

_BLANKS = (" ", "\t")


@dataclass(frozen=True)
class Part:
    """Tokens of a text from one index to another, both included.

    A part without a `text` is nowhere. Every part derived from it is nowhere, too, and gives no edit.
    """

    text: Text | None = None
    first: int = 0
    last: int = -1

    def find(self, *words: str) -> Part:
        """Return the first place in the part with these keywords or symbols in sequence."""
        starts = range(self.first, self.last - len(words) + 2)
        return next((self._at(start, len(words)) for start in starts if self._stand(words, start)), NOWHERE)

    def preceded_by(self, *words: str) -> Part:
        """Return the part extended by these words directly before it."""
        start = self.first - len(words)
        return Part(self.text, start, self.last) if self._stand(words, start) else NOWHERE

    def followed_by(self, *words: str) -> Part:
        """Return the part extended by these words directly after it."""
        return Part(self.text, self.first, self.last + len(words)) if self._stand(words, self.last + 1) else NOWHERE

    def to(self, last: Part) -> Part:
        """Return the range from the beginning of the part to the end of another part."""
        return NOWHERE if NOWHERE in (self, last) else Part(self.text, self.first, last.last)

    def until(self, other: Part) -> Part:
        """Return the range from the beginning of the part to the beginning of another part."""
        return NOWHERE if NOWHERE in (self, other) else Part(self.text, self.first, other.first - 1)

    def behind(self) -> Part:
        """Return the token after the part."""
        return self._at(self.last + 1, 1)

    def end(self) -> Part:
        """Return the last token of the part."""
        return self._at(self.last, 1)

    def token(self, index: int) -> Token:
        """Return a token of the text."""
        assert self.text is not None
        return self.text.tokens[index]

    def _at(self, start: int, count: int) -> Part:
        return Part(self.text, start, start + count - 1)

    def _stand(self, words: tuple[str, ...], start: int) -> bool:
        """Return whether the text has these words from an index on."""
        if self.text is None or start < 0:
            return False
        return all(self.token(start + index).is_keyword(word) for index, word in enumerate(words))


NOWHERE = Part()


def file_of(element: ex.Located | None) -> File | None:
    """Return the file that contains an element; None if the element comes from no text."""
    around = element
    while around is not None and around.source is None:
        around = around.eContainer()
    source = around.source if around is not None else None
    file: File | None = source.file.parsed if source is not None and source.file is not None else None
    return file


def part_of(element: ex.Located | None) -> Part:
    """Return the tokens of an element; NOWHERE for None."""
    file = file_of(element)
    if file is None:
        return NOWHERE
    text, span = file.text, place(element)[1]
    start, end = text.offset(span.line, span.column), text.offset(span.end_line, span.end_column)
    return Part(text, text.tokens.index_at(start), text.tokens.index_at(max(end - 1, start)))


def _part(where: ex.Located | Part) -> Part:
    return where if isinstance(where, Part) else part_of(where)


class Insertion(NamedTuple):
    """Hint to insert a text before a part of the text, or `behind` it.

    With `is_choice`, it is one way of several, and the user chooses.
    """

    hint: str
    text: str
    where: ex.Located | Part
    behind: bool = False
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """Return the edits, in the file of the part."""
        part = _part(self.where)
        if part.text is None:
            return ()
        at = part.token(part.last).end if self.behind else part.token(part.first).start
        return (Edit(part.text.span(at, at), self.text),)


class Replacement(NamedTuple):
    """Hint to replace a part of the text."""

    hint: str
    text: str
    where: ex.Located | Part
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """Return the edits, in the file of the part."""
        part = _part(self.where)
        if part.text is None:
            return ()
        return part.text.replace_tokens(part.token(part.first).start, part.token(part.last).end, self.text)


class Removal(NamedTuple):
    """Hint to remove a part of the text, or an element with the comma beside it."""

    hint: str
    where: ex.Located | Part
    is_choice: bool = True

    def edits(self) -> tuple[Edit, ...]:
        """Return the edits, in the file of the part."""
        part = self.where if isinstance(self.where, Part) else _with_comma(part_of(self.where))
        return () if part.text is None else tuple(_removed(part.text, part))


class Renaming(NamedTuple):
    """Hint to rename an element everywhere in its file."""

    hint: str
    element: ex.NamedElement
    name: str
    is_choice: bool = True

    def edits(self) -> tuple[Edit, ...]:
        """Return the edits, in the file of the element; none if the text does not declare it."""
        file = file_of(self.element)
        names = file.occurrences(self.element) if file is not None else []
        if file is None or not any(name.is_declaration for name in names):
            return ()
        return tuple(Edit(file.text.span(name.start, name.end), escape_keyword(self.name)) for name in names)


class Together(NamedTuple):
    """Hint to apply several edits of one file together."""

    hint: str
    parts: tuple[Insertion | Replacement | Removal | Renaming, ...]
    is_choice: bool = False

    def edits(self) -> tuple[Edit, ...]:
        """Return the edits of all parts; none if one part has none."""
        edits = [part.edits() for part in self.parts]
        return tuple(edit for those in edits for edit in those) if all(edits) else ()


Way: TypeAlias = "Insertion | Replacement | Removal | Renaming | Together"


class Choice(NamedTuple):
    """Hint with several ways to follow it, each with its own hint; the user chooses one."""

    hint: str
    ways: tuple[Way, ...]


#: Repair of a finding: words, a text that replaces the element, or an edit elsewhere.
Hint: TypeAlias = "str | Repair | Way | Choice"


def changed_file(way: Way) -> str:
    """Return the file that a way changes, as the user would write it; empty if it changes none."""
    match way:
        case Together(parts=parts):
            return changed_file(parts[0])
        case Renaming(element=element):
            return place(element)[0]
    if isinstance(way.where, Part):
        return way.where.text.file if way.where.text is not None else ""
    return place(way.where)[0]


def wrap(hint: str, before: str, behind: str, element: ex.Located, *, is_choice: bool = False) -> Together:
    """Return a hint to insert texts before and after an element."""
    parts = (Insertion("", before, element), Insertion("", behind, element, behind=True))
    return Together(hint, tuple(part for part in parts if part.text), is_choice)


def _with_comma(part: Part) -> Part:
    with_comma = part.preceded_by(",")
    if with_comma is NOWHERE:
        with_comma = part.followed_by(",")
    return part if with_comma is NOWHERE else with_comma


def _removed(text: Text, part: Part) -> Iterator[Edit]:
    """Yield edits that remove tokens, with blanks or lines that become empty. Comments stay."""
    content = text.content
    for start, end in text.tokens.runs(part.first, part.last):
        line = content.rfind("\n", 0, start) + 1
        next_line = content.find("\n", end) + 1 or len(content)
        if not content[line:start].strip() and not content[end:next_line].strip():
            yield Edit(text.span(line, next_line), "")
            continue
        first, after = start, end
        before, behind = content[start - 1 : start], content[end : end + 1]
        if behind in _BLANKS and before in (*_BLANKS, "\n", "(", "[", "{", ""):
            after = next(index for index in range(end, len(content) + 1) if content[index : index + 1] not in _BLANKS)
        elif before in _BLANKS and behind in ("\n", ")", "]", ",", ""):
            first = next(index for index in range(start, -1, -1) if content[index - 1 : index] not in _BLANKS)
        glue = " " if _is_word(content[first - 1 : first]) and _is_word(content[after : after + 1]) else ""
        yield Edit(text.span(first, after), glue)


def _is_word(character: str) -> bool:
    return character.isalnum() or character == "_"
