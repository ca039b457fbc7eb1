"""Texts of files and editor buffers, and positions in a text."""

from __future__ import annotations

import codecs
import os
import re
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Alternative, Diagnostic, Edit, Repair, Severity, Span
from robosc.base.diagnostics.lines import Lines
from robosc.base.files import reading as files
from robosc.language.tokens import Tokens
from robosc.model.places import Place, SourceFile

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_BREAK = re.compile(r"\r\n|\r|\n")
_MARK = codecs.BOM_UTF8.decode()
#: A line that consists of a comment.
_COMMENT = re.compile(r"[ \t]*(?://(?P<words>[^\n]*))")


@dataclass(frozen=True, eq=False)
class Text:
    """Content of a file with all line breaks as line feeds; `file` is its path as the user wrote it.

    Model elements refer to the file as `source_file`.

    An offset counts code points from 0. A `Span` counts lines and code points from 1. A UTF-16 position, as in the
    Language Server Protocol, counts lines from 0, and UTF-16 units within a line from 0: a character beyond U+FFFF
    takes two units.
    """

    file: str
    content: str
    source_file: SourceFile | None = None

    @cached_property
    def _lines(self) -> Lines:
        return Lines(self.content)

    @cached_property
    def tokens(self) -> Tokens:
        """Words, numbers, strings and symbols of the text."""
        return Tokens(self.content)

    def span(self, start: int, end: int) -> Span:
        """Return the span between two offsets."""
        return Span(*self._lines.place(start), *self._lines.place(end))

    def comment_above(self, offset: int) -> str | None:
        """Return the words of the comment lines right above an offset as one line, or None if there are none."""
        line, _ = self._lines.place(offset)
        words: list[str] = []
        while line > 1:
            line -= 1
            match = _COMMENT.fullmatch(self.content, self._lines.starts[line - 1], self._lines.starts[line] - 1)
            if match is None:
                break
            words[:0] = match["words"].split()
        return " ".join(words) or None

    def offset(self, line: int, column: int) -> int:
        """Return the offset of a line and a column, both counted from 1.

        A column behind the end of its line means the end.
        """
        return self._lines.offset(line, column)

    def to_utf16(self, offset: int) -> tuple[int, int]:
        """Return the UTF-16 position of an offset."""
        line, column = self._lines.place(offset)
        start = self._lines.starts[line - 1]
        return line - 1, len(self.content[start : start + column - 1].encode("utf-16-le", "surrogatepass")) // 2

    def from_utf16(self, line: int, unit: int) -> int:
        """Return the offset of a UTF-16 position.

        Between the units of one character, it is the offset of the character. A position behind the end of a line means
        its end, and one behind the last line the end of the text.
        """
        start, end = self._lines.line(line + 1)
        units = self.content[start:end].encode("utf-16-le", "surrogatepass")[: 2 * max(unit, 0)]
        # Decoding drops an unpaired first half, and thereby the character that it belongs to.
        return start + len(units.decode("utf-16-le", "ignore"))

    def replace_tokens(self, start: int, end: int, text: str) -> tuple[Edit, ...]:
        """Return the edits that replace the tokens between two offsets by a text. Comments between them stay."""
        if start == end:
            return (Edit(self.span(start, end), text),)
        runs = self.tokens.runs(self.tokens.index_at(start), self.tokens.index_at(end - 1))
        bounds = [(max(first, start), min(last, end)) for first, last in runs]
        return tuple(Edit(self.span(*bound), "" if index else text) for index, bound in enumerate(bounds))

    def after(self, edits: Iterable[Edit], written: str | None = None) -> str:
        """Return the text after edits that do not overlap.

        `written` is the text as in its file, with a byte order mark and other line breaks, both of which the result
        keeps.
        """
        content = self.content if written is None else written
        mark = len(content) - len(content.removeprefix(_MARK))
        starts = [mark, *(match.end() for match in _BREAK.finditer(content))]
        pieces: list[str] = []
        behind = 0
        for edit in sorted(edits):
            line, column = self._lines.place(self.offset(edit.span.line, edit.span.column))
            pieces += content[behind : starts[line - 1] + column - 1], edit.text
            line, column = self._lines.place(self.offset(edit.span.end_line, edit.span.end_column))
            behind = starts[line - 1] + column - 1
        return "".join([*pieces, content[behind:]])

    def source(self, start: int, end: int) -> Place:
        """Return the place between two offsets."""
        return Place(self.source_file, self.span(start, end))

    def error(self, rule: str, start: int, end: int, message: str, repair: Repair | str | None = None) -> Diagnostic:
        """Return a finding between two offsets; the text of a `Repair` replaces the text between them."""
        span = self.span(start, end)
        finding = Diagnostic(self.file, span, Severity.ERROR, rule, message)
        if not isinstance(repair, Repair):
            return replace(finding, hint=repair)
        edits = [edit for place in repair.elsewhere for edit in self.replace_tokens(*place)]
        edits += [] if repair.text is None else self.replace_tokens(start, end, repair.text)
        alternatives = [
            Alternative(f"write `{text}`", self.replace_tokens(start, end, text)) for text in repair.choices
        ]
        if repair.is_offered:
            alternatives.insert(0, Alternative(repair.hint, tuple(edits)))
            edits = []
        return replace(finding, hint=repair.hint, edits=tuple(edits), alternatives=tuple(alternatives))


class Documents:
    """Texts that a reading uses: texts in memory, such as editor buffers, take precedence over files on disk."""

    def __init__(self, texts: Mapping[str, str] | None = None) -> None:
        """Take the texts in memory by their paths. The files and their folders need not exist."""
        self._texts = {Path(path).resolve(): text for path, text in (texts or {}).items()}

    def read(self, path: Path, *, is_input: bool = True) -> bytes:
        """Return the text at a path in UTF-8. Without `is_input`, the tool may overwrite the file later.

        Raises OSError if there is no readable text.
        """
        text = self._texts.get(path.resolve()) if self._texts else None
        return files.read(path, is_input=is_input) if text is None else text.encode("utf-8", "surrogatepass")

    def models(self, folder: Path) -> list[Path]:
        """Return the paths of all `.rscd` texts directly in a folder, in order.

        An unreadable folder has no files on disk.
        """
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
    """Decode the bytes of a file; return the text and at most one finding of the rule `syntax`.

    `name` is the name of the file in models; None for the path that the user wrote.
    """
    content = content.removeprefix(codecs.BOM_UTF8)
    findings = []
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as fault:
        before = Text(file, content[: fault.start].decode("utf-8"))
        message = f"the byte 0x{content[fault.start]:02x} is not UTF-8"
        hint = "save the file with the encoding UTF-8"
        findings.append(before.error("syntax", len(before.content), len(before.content), message, hint))
        # Invalid bytes become blanks, so that one fault causes only one finding.
        text = content.decode("utf-8", errors="replace").replace("\N{REPLACEMENT CHARACTER}", " ")
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    return Text(file, text, SourceFile(name or file, file)), findings
