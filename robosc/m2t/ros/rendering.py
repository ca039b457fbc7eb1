"""Renders the templates of a node: those of one ROS version on top of the shared ones."""

from __future__ import annotations

import json
import re
import textwrap
from bisect import bisect_right
from functools import cache
from operator import itemgetter
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

from robosc.base.files.templates import environment
from robosc.m2t.c.comments import comment_text, string_literal
from robosc.model.semantics.communication import QUEUE_DEPTH

if TYPE_CHECKING:
    from jinja2 import Environment

_WIDTH = 116
_TOKEN = re.compile(r"""//.*|\"(?:\\.|[^"\\])*+"?|'(?:\\.|[^'\\])*+'?|[][(){}]| (?!\()|(?<=\))(?=\.)""")
_OPENING, _CLOSING = "([{", ")]}"


@cache
def node_environment(middleware: str) -> Environment:
    """Return the templates of one ROS version (`robosc.m2t.ros.ros1`), on top of those of this package."""
    templates = environment(middleware, "robosc.m2t.ros")
    templates.filters.update(
        literal=string_literal,
        raw_literal=raw_literal,
        comment=line_comment,
        shift=shift,
        xml=xml_text,
        attribute=xml_attribute,
        cell=table_cell,
        yaml=yaml_value,
    )
    templates.globals["queue_depth"] = QUEUE_DEPTH
    return templates


def line_comment(text: str, indent: int = 0) -> str:
    """Return the text as wrapped C++ comment lines. Nothing in it ends a comment or joins it with the next line."""
    lines = textwrap.wrap(comment_text(text), _WIDTH - indent, break_long_words=False, break_on_hyphens=False)
    margin = " " * indent + "// "
    return "\n".join(f"{margin}{line}{'.' if line.endswith(chr(92)) else ''}" for line in lines)


def raw_literal(json: str) -> str:
    """Return a raw string literal with JSON text in ASCII. The text cannot end the literal."""
    return 'R"json(' + json.replace(')json"', '\\u0029json"') + ')json"'


def fold(code: str, width: int = 120) -> str:
    """Break long lines of C++ code, at blanks outside of literals and before the calls of a chain.

    A line breaks where the fewest brackets are open, at the last such place that fits. Directives and comments stay
    unchanged. The function works on tokens, as other formatters do: a long line mixes text of a template with printed
    expressions, and only the complete line has a known width.
    """
    return "".join(_folded(line, width) for line in code.splitlines(keepends=True))


def _folded(line: str, width: int) -> str:
    indent, end = len(line) - len(line.lstrip()), len(line.rstrip())
    if end <= width or line.startswith(("//", "#"), indent):
        return line
    places = _places(line, indent, end)
    parts: list[str] = []
    # Start of the remaining text, and its column after the break.
    start = column = 0
    while end - start + column > width:
        first = bisect_right(places, start, key=_position)
        last = bisect_right(places, start - column + width, key=_position)
        if first == last:
            break
        at = max(places[first:last])[1]
        parts += [line[start:at].rstrip(), "\n", " " * (indent + 4)]
        start, column = at, indent + 4
        while line[start] == " ":
            start += 1
    return "".join([*parts, line[start:]])


def _places(line: str, start: int, end: int) -> list[tuple[int, int]]:
    """Return the places where a line may break, in order: the negated bracket depth, and the position."""
    depth = 0
    places = []
    for token in _TOKEN.finditer(line, start, end):
        if token[0].strip():
            depth += (token[0] in _OPENING) - (token[0] in _CLOSING)
        else:
            places.append((-depth, token.start()))
    return places


_position = itemgetter(1)


def shift(text: str, indent: int) -> str:
    """Indent every nonempty line of the text."""
    return textwrap.indent(text, " " * indent)


def xml_text(text: str) -> str:
    """Return the text between tags, without characters that are invalid in XML."""
    return escape(_printable(text))


def xml_attribute(text: str) -> str:
    """Return the text as a quoted attribute value."""
    return quoteattr(_printable(text))


def table_cell(text: str) -> str:
    """Return the text for a cell of a Markdown table: one line without `|` and without tags."""
    return " ".join(_printable(text).replace("|", "\\|").replace("<", "&lt;").split())


def yaml_value(value: bool | float | str) -> str:
    """Return a value in YAML. A double has a point, without which YAML 1.1 reads an exponent as text."""
    text = json.dumps(value)
    return re.sub(r"^(-?\d+)e", r"\1.0e", text) if isinstance(value, float) else text


def _printable(text: str) -> str:
    return "".join(character for character in text if character.isprintable() or character in "\n\t")
