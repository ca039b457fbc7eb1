"""Findings in the definition that the user edits, before the whole large text is read again.

A change within one definition is checked in a slice of the text: this definition, everything that it may name, and
everything that names it. The rest is blank, so that lines and columns stay the same. Findings in the definition come
from the slice. All others are the previous ones, moved. The whole text is read when the user stops typing.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Span
from robosc.language.outline import Outline
from robosc.model import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.scopes import File
    from robosc.language.text import Text

#: Texts with fewer lines are always read as a whole.
LARGE = 200
_WORD = re.compile(r"[A-Za-z_]\w*")
#: Elements that other definitions can name without naming the definition around them.
_VISIBLE = (
    rsc.Component,
    rsc.ComplexDataType,
    rsc.Interface,
    rsc.NamedExpression,
    rsc.Function,
    rsc.CommunicationType,
    rsc.EnumValue,
    rsc.AutomatonRequirement,
)
#: Types of components whose communication is declared elsewhere.
_INSTANTIATED = (rsc.ImportedComponent, rsc.InstantiatedComponent)


class Slices:
    """The definitions of a text that was read as a whole, and the references between them."""

    def __init__(self, file: File, findings: Sequence[Diagnostic]) -> None:
        """Take a file with all findings in its text and in the texts that it imports."""
        self._file = file
        self._findings = findings

    def prepare(self) -> None:
        """Compute the data for the first slice in advance."""
        self._needed(set(), set())
        _ = self._naming, self._visible, self._templates

    def slice(self, text: Text) -> Slice | None:
        """Return the slice for a text that differs from this one within one definition, or None."""
        before, after = self._file.text.content, text.content
        same = _common(before, after)
        most = min(len(before), len(after)) - same
        ends = _common(before[len(before) - most :][::-1], after[len(after) - most :][::-1]) if most else 0
        last = len(before) - ends
        index = next((at for at, (start, end) in enumerate(self._ranges) if start < same and last <= end), None)
        if index is None:
            return None
        start, end = self._ranges[index]
        grown = len(after) - len(before)
        # The columns of a definition change if another definition is in the same line.
        if "\n" not in before[self._ranges[index - 1][1] if index else 0 : start] or "\n" not in before[end:]:
            return None
        if index + 1 < len(self._ranges) and "\n" not in before[end : self._ranges[index + 1][0]]:
            return None
        words = set(_WORD.findall(after[start : end + grown]))
        included = self._needed({index, *self._naming[index], *self._templates, *self._neighbours(index)}, words)
        parts, at = [], 0
        for other, (first, behind) in enumerate(self._ranges):
            moved = grown if other > index else 0
            own_end = behind + (grown if other >= index else 0)
            parts.append(after[at : first + moved])
            own = after[first + moved : own_end]
            parts.append(own if other in included else _blank(own))
            at = own_end
        parts.append(after[at:])
        users = [self._ranges[other] for other in sorted(self._naming[index])]
        return Slice(self, text, "".join(parts), (start, end), grown, users)

    def _neighbours(self, index: int) -> Iterable[int]:
        return (other for other in (index - 1, index + 1) if 0 <= other < len(self._ranges))

    def _needed(self, indices: set[int], words: set[str]) -> set[int]:
        """Return these definitions, those that the words may name, and all that they name in turn."""
        pending = [*indices, *(index for word in words for index in self._visible.get(word, ()))]
        needed: set[int] = set()
        while pending:
            index = pending.pop()
            if index not in needed:
                needed.add(index)
                pending += self._named[index]
        return needed

    @cached_property
    def _ranges(self) -> list[tuple[int, int]]:
        """Ranges of the definitions, including unreadable ones."""
        return [(item.start, item.end) for item in Outline(self._file.text.tokens).file().items]

    @cached_property
    def _starts(self) -> list[int]:
        return [start for start, _ in self._ranges]

    def _index(self, offset: int) -> int | None:
        index = bisect_right(self._starts, offset) - 1
        return index if index >= 0 and offset < self._ranges[index][1] else None

    @cached_property
    def _visible(self) -> dict[str, set[int]]:
        by_name: dict[str, set[int]] = {}
        for element, name in self._file.declared_names.items():
            index = self._index(name.start) if isinstance(element, _VISIBLE) else None
            if index is not None:
                by_name.setdefault(name.text, set()).add(index)
        return by_name

    @cached_property
    def _declared(self) -> dict[Any, int]:
        indexed = ((element, self._index(name.start)) for element, name in self._file.declared_names.items())
        return {element: index for element, index in indexed if index is not None}

    @cached_property
    def _named(self) -> list[set[int]]:
        """Definitions that a definition names, by its index."""
        named: list[set[int]] = [set() for _ in self._ranges]
        for name in self._file.names:
            target = self._declared.get(name.target) if not name.is_declaration else None
            index = self._index(name.start) if target is not None else None
            if index is not None and target is not None and target != index:
                named[index].add(target)
        return named

    @cached_property
    def _naming(self) -> list[set[int]]:
        """Definitions that name a definition, by its index."""
        naming: list[set[int]] = [set() for _ in self._ranges]
        for index, named in enumerate(self._named):
            for other in named:
                naming[other].add(index)
        return naming

    @cached_property
    def _templates(self) -> set[int]:
        return {
            index
            for element, index in self._declared.items()
            if isinstance(element, rsc.Component) and isinstance(element.type, _INSTANTIATED)
        }

    def has(self, finding: Diagnostic) -> bool:
        """Return whether the text had a finding with the same message."""
        return any(finding.message == other.message for other in self._findings)

    def others(self, place: tuple[int, int], last: int, users: Sequence[tuple[int, int]]) -> list[Diagnostic]:
        """Return the findings outside of a definition that now ends in the line `last`, moved accordingly.

        `users` are the ranges that name the definition. Findings about unresolved names in them come from the slice.
        """
        text = self._file.text
        start, end = (text.span(offset, offset) for offset in place)

        def moved(span: Span) -> Span:
            by = last - end.line if (span.line, span.column) > (end.line, end.column) else 0
            return Span(span.line + by, span.column, span.end_line + by, span.end_column)

        others = []
        for finding in self._findings:
            if finding.file != text.file:
                others.append(finding)
            elif _is_name(finding) and _within(text.offset(finding.span.line, finding.span.column), users):
                continue
            elif not (start.line, start.column) <= (finding.span.line, finding.span.column) <= (end.line, end.column):
                edits = tuple(replace(edit, span=moved(edit.span)) for edit in finding.edits)
                ways = tuple(
                    replace(way, edits=tuple(replace(edit, span=moved(edit.span)) for edit in way.edits))
                    for way in finding.alternatives
                )
                related = tuple(
                    replace(other, span=moved(other.span)) if other.file == text.file else other
                    for other in finding.related
                )
                others.append(
                    replace(finding, span=moved(finding.span), edits=edits, related=related, alternatives=ways)
                )
        return others


@dataclass(frozen=True)
class Slice:
    """A text in which only some definitions are not blank (`content`).

    `before` is the old range of the changed definition, and `grown` is its growth in code points. `users` are the old
    ranges of the definitions that name it.
    """

    slices: Slices
    text: Text
    content: str
    before: tuple[int, int]
    grown: int
    users: Sequence[tuple[int, int]]

    def findings(self, own_findings: Iterable[Diagnostic]) -> list[Diagnostic] | None:
        """Return the findings of the whole text from those of the slice, or None if other definitions are affected."""
        start, end = self.before[0], self.before[1] + self.grown
        moved = ((*user, self.grown if user[0] > start else 0) for user in self.users)
        users = [(first + by, last + by) for first, last, by in moved]
        own = []
        for finding in own_findings:
            if finding.file == self.text.file:
                at = self.text.offset(finding.span.line, finding.span.column)
                within = start <= at <= end
                if finding.rule == "syntax" and not within and not self.slices.has(finding):
                    return None
                own += [finding] if within or (_is_name(finding) and _within(at, users)) else []
        return [*own, *self.slices.others(self.before, self.text.span(end, end).line, self.users)]


def _is_name(finding: Diagnostic) -> bool:
    return finding.rule == "unresolved-reference"


def _within(offset: int, ranges: Iterable[tuple[int, int]]) -> bool:
    return any(start <= offset <= end for start, end in ranges)


def _blank(text: str) -> str:
    """Return as many lines without text, the last one as long as before."""
    *lines, last = text.split("\n")
    return "\n" * len(lines) + " " * len(last)


def _common(first: str, second: str) -> int:
    """Return the length of the common prefix of two texts."""
    low, high = 0, min(len(first), len(second))
    while low < high:
        middle = (low + high + 1) // 2
        if first[low:middle] == second[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low
