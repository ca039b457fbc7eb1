"""The canonical layout of models and libraries."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from robosc.language.builder import Builder
from robosc.language.formatting.documents import render
from robosc.language.formatting.layout import layout
from robosc.language.grammar import Failure
from robosc.language.recovery import recover
from robosc.language.spellings import WRONG_FOLDER, parse_text, wrong_folder
from robosc.language.tokens import Tokens, too_complex
from robosc.model import robosc as rsc
from robosc.model.semantics.communication import ros_kind, section_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.base.diagnostics import Diagnostic
    from robosc.language.text import Text


def format_text(text: Text) -> tuple[str | None, list[Diagnostic]]:
    """Return a robot or library in the canonical layout, and the findings of the rule `syntax`.

    If there are findings, the text is None. Names are not looked up. The words stay the same, except for other
    spellings, and so do the comments, except for blanks at the start and end of their lines. A text in the canonical
    layout does not change.
    """
    formatted, _, findings = _formatted(text)
    return formatted, findings


def _formatted(text: Text) -> tuple[str | None, str, list[Diagnostic]]:
    """Return the formatted text, the text in the usual spelling, and the findings."""
    tree, content = (None, "") if too_complex(text.tokens) else parse_text(text)
    if tree is None or isinstance(tree, Failure):
        return None, content, recover(text).findings
    builder = Builder(text)
    builder.build(tree)
    findings = [*builder.findings, *_wrong_folders(text, builder)]
    if findings:
        return None, content, findings
    formatted = render(layout(content, tree))
    if [word.text for word in Tokens(content)] != [word.text for word in Tokens(formatted)]:
        raise AssertionError(f"{text.file}: the layout changed the words")
    return formatted, content, []


def _wrong_folders(text: Text, builder: Builder) -> Iterator[Diagnostic]:
    """Yield a finding for each folder in the name of a ROS type without which the text would be correct."""
    interfaces = {element.name: element for element in builder.declared if isinstance(element, rsc.Interface)}
    for element, names in builder.references.items():
        named: rsc.InterfaceTypeReference | rsc.Interface
        if isinstance(element, rsc.InterfaceTypeReference):
            kind, named = section_of(element).kind, element
        elif isinstance(element, rsc.CommunicationType) and names["interface"].text in interfaces:
            kind, named = ros_kind(element), interfaces[names["interface"].text]
        else:
            continue
        message = wrong_folder(text, named, kind)
        if message is not None:
            name = next(iter(names.values()))
            yield text.error("syntax", name.start, name.end, message, WRONG_FOLDER)


def format_edits(text: Text, start: int = 0, end: int | None = None) -> list[tuple[int, int, str]]:
    """Return the edits (start, exclusive end, new text) that format a range of a text.

    Empty if the text has syntax errors or the range has the canonical layout already.
    """
    formatted, usual, _ = _formatted(text)
    if formatted is None:
        return []
    end = len(text.content) if end is None else end
    before, after = _pieces(usual), _pieces(formatted)
    return [
        (first, last, formatted[new_first:new_last])
        for (first, last), (new_first, new_last) in zip(before, after, strict=True)
        if start <= last and first <= end and text.content[first:last] != formatted[new_first:new_last]
    ]


def _pieces(content: str) -> list[tuple[int, int]]:
    """Return the ranges of the words of a text, and those before, between and behind them."""
    ends = [place for word in Tokens(content) for place in (word.start, word.end)]
    return list(pairwise([0, *ends, len(content)]))
