"""Texts of files and of editors' buffers, and where in a text a position is."""

from __future__ import annotations

import codecs
import os
import re
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.diagnostics import Alternative, Diagnostic, Edit, Repair, Severity, Span
from robosc.diagnostics.lines import Lines
from robosc.files import reading as files
from robosc.language.tokens import Tokens
from robosc.metamodel.places import Place, SourceFile

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_BREAK = re.compile(r"\r\n|\r|\n")
_MARK = codecs.BOM_UTF8.decode()
#: A line that is a comment and nothing else.
_COMMENT = re.compile(r"[ \t]*(?://(?P<words>[^\n]*))")


@dataclass(frozen=True, eq=False)
class Text:
    """What a file holds, its line breaks all line feeds; `file` is its path as the user wrote it.

    `source_file` is what model elements call it.

    An offset counts code points from 0. A `Span` counts lines and code points from 1. A UTF-16 position, as the
    Language Server Protocol has it, counts lines from 0, and in a line units of UTF-16 from 0: a character beyond
    U+FFFF takes two.
    """

    file: str
    content: str
    source_file: SourceFile | None = None

    @cached_property
    def _lines(self) -> Lines:
        return Lines(self.content)

    @cached_property
    def tokens(self) -> Tokens:
        """The words, numbers, strings and symbols of the text."""
        return Tokens(self.content)

    def span(self, start: int, end: int) -> Span:
        """The span between two offsets."""
        return Span(*self._lines.place(start), *self._lines.place(end))

    def comment_above(self, offset: int) -> str | None:
        """The words of the comments in the lines right above an offset, as one line; None where there are none."""
        line, _ = self._lines.place(offset)
        words: list[str] = []
        while line > 1:
            line -= 1
            found = _COMMENT.fullmatch(self.content, self._lines.starts[line - 1], self._lines.starts[line] - 1)
            if found is None:
                break
            words[:0] = found["words"].split()
        return " ".join(words) or None

    def offset(self, line: int, column: int) -> int:
        """The offset of a line and a column, both counted from 1; what lies behind the end of a line is its end."""
        return self._lines.offset(line, column)

    def to_utf16(self, offset: int) -> tuple[int, int]:
        """The UTF-16 position of an offset."""
        line, column = self._lines.place(offset)
        start = self._lines.starts[line - 1]
        return line - 1, len(self.content[start : start + column - 1].encode("utf-16-le", "surrogatepass")) // 2

    def from_utf16(self, line: int, unit: int) -> int:
        """The offset of a UTF-16 position. Between the units of one character it is that of the character.

        What lies behind the end of a line is its end, what lies behind the last line the end of the text.
        """
        start, end = self._lines.line(line + 1)
        units = self.content[start:end].encode("utf-16-le", "surrogatepass")[: 2 * max(unit, 0)]
        # A first half alone is left out, and so is the character that it belongs to.
        return start + len(units.decode("utf-16-le", "ignore"))

    def replaced(self, start: int, end: int, text: str) -> tuple[Edit, ...]:
        """The edits that put a text in place of the tokens between two offsets. Comments between them stay."""
        if start == end:
            return (Edit(self.span(start, end), text),)
        runs = self.tokens.runs(self.tokens.index_at(start), self.tokens.index_at(end - 1))
        bounds = [(max(first, start), min(last, end)) for first, last in runs]
        return tuple(Edit(self.span(*bound), "" if index else text) for index, bound in enumerate(bounds))

    def after(self, edits: Iterable[Edit], written: str | None = None) -> str:
        """The text after edits that do not overlap.

        `written` is the text as its file has it, with a byte order mark and other line breaks, which are kept.
        """
        content = self.content if written is None else written
        mark = len(content) - len(content.removeprefix(_MARK))
        starts = [mark, *(found.end() for found in _BREAK.finditer(content))]
        pieces: list[str] = []
        behind = 0
        for edit in sorted(edits):
            line, column = self._lines.place(self.offset(edit.span.line, edit.span.column))
            pieces += content[behind : starts[line - 1] + column - 1], edit.text
            line, column = self._lines.place(self.offset(edit.span.end_line, edit.span.end_column))
            behind = starts[line - 1] + column - 1
        return "".join([*pieces, content[behind:]])

    def source(self, start: int, end: int) -> Place:
        """The place between two offsets."""
        return Place(self.source_file, self.span(start, end))

    def error(self, rule: str, start: int, end: int, message: str, repair: Repair | str | None = None) -> Diagnostic:
        """A finding between two offsets; what a `Repair` writes in its place is written between them."""
        span = self.span(start, end)
        made = Diagnostic(self.file, span, Severity.ERROR, rule, message)
        if not isinstance(repair, Repair):
            return replace(made, hint=repair)
        edits = [edit for place in repair.elsewhere for edit in self.replaced(*place)]
        edits += [] if repair.text is None else self.replaced(start, end, repair.text)
        alternatives = [Alternative(f"write `{text}`", self.replaced(start, end, text)) for text in repair.choices]
        return replace(made, hint=repair.hint, edits=tuple(edits), alternatives=tuple(alternatives))


class Documents:
    """The texts that a reading looks at: those in memory, such as the buffers of an editor, over the files on disk."""

    def __init__(self, texts: Mapping[str, str] | None = None) -> None:
        """`texts` are those in memory, by their paths. A path needs no file, and its folder need not be there."""
        self._texts = {Path(path).resolve(): text for path, text in (texts or {}).items()}

    def read(self, path: Path, *, is_input: bool = True) -> bytes:
        """The text at a path in UTF-8. Without `is_input` a file may be written over afterwards.

        Raises OSError where there is none that can be read.
        """
        text = self._texts.get(path.resolve()) if self._texts else None
        return files.read(path, is_input=is_input) if text is None else text.encode("utf-8", "surrogatepass")

    def models(self, folder: Path) -> list[Path]:
        """The paths of all `.rscd` texts right in a folder, in order. A folder that can't be read has none on disk."""
        try:
            with os.scandir(folder) as entries:
                names = {entry.name for entry in entries if entry.name.endswith(".rscd") and entry.is_file()}
        except OSError:
            names = set()
        if self._texts:
            whole = folder.resolve()
            names |= {path.name for path in self._texts if path.parent == whole and path.suffix == ".rscd"}
        return [folder / name for name in sorted(names)]


def decode(file: str, content: bytes, name: str | None = None) -> tuple[Text, list[Diagnostic]]:
    """The text in the bytes of a file, and what is wrong with them: a finding of the rule `syntax`, or none.

    `name` is what models call the file; None: as the user does.
    """
    content = content.removeprefix(codecs.BOM_UTF8)
    findings = []
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as fault:
        before = Text(file, content[: fault.start].decode("utf-8"))
        message = f"the byte 0x{content[fault.start]:02x} is no UTF-8"
        hint = "save the file in the encoding UTF-8"
        findings.append(before.error("syntax", len(before.content), len(before.content), message, hint))
        # The rest is checked with blanks in such places, so that one fault draws one finding.
        text = content.decode("utf-8", errors="replace").replace("\N{REPLACEMENT CHARACTER}", " ")
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    return Text(file, text, SourceFile(name or file, file)), findings
