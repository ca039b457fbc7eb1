"""Parses XML to located elements. Rejects constructs that models do not need and attackers use."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any
from xml.parsers import expat

from robosc.base.diagnostics import Diagnostic, ModelError, Severity, Span
from robosc.model.xmi.format import DEEPEST, XSI

_NAME = re.compile(r"<[^\s/>]*")
_ATTRIBUTE_OR_END = re.compile(r"""(?<![^\s=<>"'/])([^\s=<>"'/]++)\s*=\s*(?:"[^"]*"|'[^']*')|>""")
_LINE_END = re.compile("\r\n|\r|\n")


@dataclass(eq=False)
class Element:
    """An XML element: its namespace and name, attributes by (namespace, name), and place.

    `type` is the value of its `xsi:type` as (namespace, name), or None.
    """

    namespace: str
    name: str
    attributes: dict[tuple[str, str], str]
    type: tuple[str | None, str] | None
    lines: Sequence[str] = field(repr=False)
    line: int
    column: int
    children: list["Element"] = field(default_factory=list)
    text: str = ""

    @property
    def span(self) -> Span:
        """Span of the start tag's name."""
        name = _NAME.match(self.lines[self.line - 1], self.column - 1)
        return Span(self.line, self.column, self.line, name.end() + 1 if name else self.column + 1)

    def attribute_span(self, written: str) -> Span:
        """Return the span of an attribute by its literal name. If it spans several lines, return the element's span."""
        return self._attribute_spans.get(written, self.span)

    @cached_property
    def _attribute_spans(self) -> dict[str, Span]:
        spans: dict[str, Span] = {}
        start = self.span.end_column - 1
        for line in range(self.line, len(self.lines) + 1):
            for match in _ATTRIBUTE_OR_END.finditer(self.lines[line - 1], start):
                if match.group(1) is None:
                    return spans
                spans.setdefault(match.group(1), Span(line, match.start() + 1, line, match.end() + 1))
            start = 0
        return spans


def parse(data: bytes, file: str) -> Element:
    """Return the root element of a UTF-8 document.

    Raises ModelError with a located `syntax` finding if the document is not well-formed, not UTF-8, has a document type
    (and thus entities), or is nested too deeply.
    """
    return _Parser(data, file).root()


class _Parser:
    def __init__(self, data: bytes, file: str) -> None:
        self._data = data
        self._file = file
        self._lines: list[str] = []
        self._open: list[Element] = []
        #: Namespaces of each prefix, the outermost first.
        self._prefixes: dict[str, list[str]] = {}
        self._root: Element | None = None
        self._expat: Any = expat.ParserCreate("utf-8", " ")
        self._expat.buffer_text = True
        self._expat.StartNamespaceDeclHandler = self._declare
        self._expat.EndNamespaceDeclHandler = lambda prefix: self._prefixes[prefix or ""].pop()
        self._expat.StartElementHandler = self._start
        self._expat.EndElementHandler = lambda _name: self._open.pop()
        self._expat.CharacterDataHandler = self._characters
        self._expat.StartDoctypeDeclHandler = self._doctype

    def root(self) -> Element:
        try:
            self._lines = _LINE_END.split(self._data.decode("utf-8-sig"))
        except UnicodeDecodeError as error:
            before = _LINE_END.split(self._data[: error.start].decode("utf-8", "replace"))
            raise self._error(len(before), len(before[-1]) + 1, "this is not text in UTF-8") from None
        try:
            self._expat.Parse(self._data, True)
        except expat.ExpatError as error:
            message = f"this is not well-formed XML: {expat.ErrorString(error.code)}"
            raise self._error(error.lineno, error.offset + 1, message) from None
        assert self._root is not None
        return self._root

    def _declare(self, prefix: str | None, uri: str | None) -> None:
        self._prefixes.setdefault(prefix or "", []).append(uri or "")

    def _type(self, written: str | None) -> tuple[str | None, str] | None:
        if written is None:
            return None
        prefix, _, name = written.rpartition(":")
        meanings = self._prefixes.get(prefix)
        return (meanings[-1] if meanings else None), name

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        line, column = self._here()
        if len(self._open) > DEEPEST:
            raise self._error(line, column, f"more than {DEEPEST} elements are inside each other")
        qualified = {_split(key): value for key, value in attributes.items()}
        kind = self._type(qualified.get((XSI, "type")))
        element = Element(*_split(name), qualified, kind, self._lines, line, column)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self._root = element
        self._open.append(element)

    def _characters(self, text: str) -> None:
        self._open[-1].text += text

    def _doctype(self, *_: object) -> None:
        raise self._error(*self._here(), "a document type declaration is not allowed in a model")

    def _here(self) -> tuple[int, int]:
        return self._expat.CurrentLineNumber, self._expat.CurrentColumnNumber + 1

    def _error(self, line: int, column: int, message: str) -> ModelError:
        span = Span(line, column, line, column + 1)
        return ModelError([Diagnostic(self._file, span, Severity.ERROR, "syntax", message)])


def _split(name: str) -> tuple[str, str]:
    namespace, _, local = name.rpartition(" ")
    return namespace, local
