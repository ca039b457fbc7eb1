"""Renders the templates of a node: those of one ROS on top of those of both."""

from __future__ import annotations

import re
import textwrap
from bisect import bisect_right
from functools import cache
from operator import itemgetter
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

from robosc.files.templates import environment
from robosc.m2t.c.comments import comment_text, string_literal
from robosc.semantics.communication import QUEUE_DEPTH

if TYPE_CHECKING:
    from jinja2 import Environment

_WIDTH = 116
_TOKEN = re.compile(r"""//.*|\"(?:\\.|[^"\\])*+"?|'(?:\\.|[^'\\])*+'?|[][(){}]| (?!\()|(?<=\))(?=\.)""")
_OPENING, _CLOSING = "([{", ")]}"


@cache
def node_environment(middleware: str) -> Environment:
    """The templates of one ROS (`robosc.m2t.ros.ros1`), on top of those of this package."""
    templates = environment(middleware, "robosc.m2t.ros")
    templates.filters.update(
        literal=string_literal,
        raw_literal=raw_literal,
        comment=line_comment,
        shift=shift,
        xml=xml_text,
        attribute=xml_attribute,
    )
    templates.globals["queue_depth"] = QUEUE_DEPTH
    return templates


def line_comment(text: str, indent: int = 0) -> str:
    """The text as comment lines of C++, wrapped; nothing in it ends them or joins them with the line after."""
    lines = textwrap.wrap(comment_text(text), _WIDTH - indent, break_long_words=False, break_on_hyphens=False)
    margin = " " * indent + "// "
    return "\n".join(f"{margin}{line}{'.' if line.endswith(chr(92)) else ''}" for line in lines)


def raw_literal(json: str) -> str:
    """A raw string literal with JSON text in ASCII, whose strings can't end it."""
    return 'R"json(' + json.replace(')json"', '\\u0029json"') + ')json"'


def fold(code: str, width: int = 120) -> str:
    """C++ code with long lines broken, at blanks outside of literals and before the calls of a chain.

    A line breaks where the least brackets are open, at the last of these places that fits; directives, and comments
    wherever they begin, stay as they are. What it goes by is tokens, as other formatters do: a long line is made of a
    template's own words as much as of printed expressions, and only in the whole of it is its width known.
    """
    return "".join(_folded(line, width) for line in code.splitlines(keepends=True))


def _folded(line: str, width: int) -> str:
    indent, end = len(line) - len(line.lstrip()), len(line.rstrip())
    if end <= width or line.startswith(("//", "#"), indent):
        return line
    places = _places(line, indent, end)
    made: list[str] = []
    # Where the rest begins, and the column in which it will stand.
    start = column = 0
    while end - start + column > width:
        first = bisect_right(places, start, key=_position)
        last = bisect_right(places, start - column + width, key=_position)
        if first == last:
            break
        at = max(places[first:last])[1]
        made += [line[start:at].rstrip(), "\n", " " * (indent + 4)]
        start, column = at, indent + 4
        while line[start] == " ":
            start += 1
    return "".join([*made, line[start:]])


def _places(line: str, start: int, end: int) -> list[tuple[int, int]]:
    """Where a line may break, in order: how little is open there, and the position."""
    depth = 0
    found = []
    for token in _TOKEN.finditer(line, start, end):
        if token[0].strip():
            depth += (token[0] in _OPENING) - (token[0] in _CLOSING)
        else:
            found.append((-depth, token.start()))
    return found


_position = itemgetter(1)


def shift(text: str, indent: int) -> str:
    """The text with every line that is not empty so much further to the right."""
    return textwrap.indent(text, " " * indent)


def xml_text(text: str) -> str:
    """The text between tags, without the characters that XML can't hold."""
    return escape(_printable(text))


def xml_attribute(text: str) -> str:
    """The text as the value of an attribute, in its quotes."""
    return quoteattr(_printable(text))


def _printable(text: str) -> str:
    return "".join(character for character in text if character.isprintable() or character in "\n\t")
