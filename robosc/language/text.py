"""The text of a file, and where in it a position is."""

from __future__ import annotations

import codecs
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property

from robosc.diagnostics import Diagnostic, Severity, Span


@dataclass(frozen=True, eq=False)
class Text:
    """What a file holds, its line breaks all line feeds; `file` is its path as the user wrote it."""

    file: str
    content: str

    @cached_property
    def _line_starts(self) -> list[int]:
        starts = [0]
        position = self.content.find("\n")
        while position >= 0:
            starts.append(position + 1)
            position = self.content.find("\n", position + 1)
        return starts

    def span(self, start: int, end: int) -> Span:
        """The span between two offsets, counted from 0 in code points."""
        return Span(*self._place(start), *self._place(end))

    def _place(self, offset: int) -> tuple[int, int]:
        offset = min(offset, len(self.content))  # Braces that are missing are added behind the end.
        line = bisect_right(self._line_starts, offset)
        return line, offset - self._line_starts[line - 1] + 1

    def source(self, start: int, end: int) -> str:
        """The span between two offsets as a model element keeps it."""
        span = self.span(start, end)
        return f"{span.line}:{span.column}-{span.end_line}:{span.end_column}"

    def error(self, rule: str, start: int, end: int, message: str, hint: str | None = None) -> Diagnostic:
        """A finding between two offsets."""
        return Diagnostic(self.file, self.span(start, end), Severity.ERROR, rule, message, hint)


def decode(file: str, content: bytes) -> tuple[Text, list[Diagnostic]]:
    """The text in the bytes of a file, and what is wrong with them: a finding of the rule `syntax`, or none."""
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
    return Text(file, text.replace("\r\n", "\n").replace("\r", "\n")), findings
