"""Contents of the files of a system, and places in them."""

from __future__ import annotations

import re
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.language.des.automata import FaultError
from robosc.language.text import Text, decode
from robosc.model.places import Place
from robosc.model.xmi import markup

if TYPE_CHECKING:
    from pathlib import Path

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.text import Documents

_ENCODING = re.compile(rb"""\A\s*<\?xml\b[^>]*?\bencoding\s*=\s*["']([A-Za-z0-9._-]+)["']""")
#: Encodings of one table: others of Python are no encodings of text, or slow.
_CODECS = re.compile(rb"utf-8|us-ascii|iso-8859-[0-9]+|windows-125[0-9]", re.IGNORECASE)


@dataclass(frozen=True)
class Source:
    """A file that was read: its path and its text."""

    path: Path
    text: Text

    @property
    def whole(self) -> Place:
        """The place of the first character."""
        return self.text.source(0, 0)

    def root(self, name: str) -> markup.Element:
        """Return the root element of an XML file; it must have this name. Raises FaultError or ModelError."""
        root = markup.parse(self.text.content.encode("utf-8"), self.text.file)
        if root.name != name:
            message = f"found the element `{root.name}`, expected `{name}`"
            raise FaultError(self.place(root), "syntax", message, f"is {self.path.name} a `{self.path.suffix}` file?")
        return root

    def place(self, element: markup.Element, attribute: str | None = None) -> Place:
        """Return the place of an element or of one of its attributes."""
        span = element.span if attribute is None else element.attribute_span(attribute)
        return Place(self.text.source_file, span)


def open_source(path: Path, name: str, documents: Documents) -> tuple[Source, list[Diagnostic]]:
    """Return the content of a file, and its findings; `name` is the name of the file in models.

    An XML file may name another encoding than UTF-8. Raises OSError if the file cannot be read.
    """
    content = documents.read(path)
    encoding = _ENCODING.match(content)
    if content[:2] in (BOM_UTF16_LE, BOM_UTF16_BE):
        with suppress(UnicodeError):
            content = content.decode("utf-16").encode("utf-8")
    elif encoding is not None and _CODECS.fullmatch(encoding[1]):
        with suppress(LookupError, UnicodeError):  # `decode` reports the first byte that is not UTF-8.
            content = content.decode(encoding[1].decode()).encode("utf-8")
    text, findings = decode(str(path), content, name)
    return Source(path, text), findings


def attribute(element: markup.Element, name: str, source: Source) -> str:
    """Return an attribute of an element. Raises FaultError if it is missing."""
    value = element.attributes.get(("", name))
    if value is None:
        message = f"the element `{element.name}` has no attribute `{name}`"
        raise FaultError(source.place(element), "syntax", message)
    return value
