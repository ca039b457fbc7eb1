"""The canonical layout of models and libraries."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.language.building import Builder
from robosc.language.formatting.documents import render
from robosc.language.formatting.layout import layout
from robosc.language.grammar import Failure, parse
from robosc.language.recovery import recovered
from robosc.language.tokens import Tokens, too_complex

if TYPE_CHECKING:
    from robosc.diagnostics import Diagnostic
    from robosc.language.text import Text


def format_text(text: Text) -> tuple[str | None, list[Diagnostic]]:
    """The text of a robot or a library in the canonical layout, and the findings of the rule `syntax`.

    Where there are findings there is no new text. Names are not looked up. The words stay as they are, comments too but
    for blanks at the ends and beginnings of their lines; what has the canonical layout keeps it.
    """
    words = Tokens(text.content)
    tree = None if too_complex(words) else parse(text.content, "Base")
    if tree is None or isinstance(tree, Failure):
        return None, recovered(text, words).findings
    builder = Builder(text)
    builder.build(tree)
    if builder.findings:
        return None, builder.findings
    formatted = render(layout(text.content, tree))
    if [word.text for word in words] != [word.text for word in Tokens(formatted)]:
        raise AssertionError(f"{text.file}: the layout changed the words")
    return formatted, []
