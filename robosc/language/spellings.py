"""Other spellings of a text: `not` for `!`, and `package/msg/Type` for `package/Type`.

A text with names that look like these spellings keeps its meaning: the parser tries the original text first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.ros_types.wire import FOLDERS
from robosc.language.grammar import Failure, first, is_reserved, parse
from robosc.language.tokens import Kind

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.grammar import Node
    from robosc.language.text import Text
    from robosc.language.tokens import Tokens
    from robosc.model import expression as ex

#: Hint at a folder of another kind.
WRONG_FOLDER = "leave the folder out, or name another type"
#: Word for `!`.
NEGATION = "not"
_DECLARING = (
    *("variable", "state", "constant", "parameter", "condition", "function", "component", "object", "enum"),
    *("message", "service", "action", "->"),
)  # fmt: skip


def parse_text(text: Text) -> tuple[Node | Failure, str]:
    """Return the parse tree of a whole text, else the failure, and the text as it was parsed.

    The parsed text has a blank, or `!`, in place of other spellings. All offsets are those of the original text.
    """
    tree = parse(text.content, "Base")
    # Without imports, `not (x)` calls no function that another text declares.
    if isinstance(tree, Failure) or not any(token.is_keyword("import") for token in text.tokens):
        usual = usual_spelling(text)
        if usual != text.content:
            other = parse(usual, "Base")
            if not isinstance(other, Failure):
                return other, usual
    return tree, text.content


def usual_spelling(text: Text) -> str:
    """Return a text of the same length with the spellings that the grammar knows."""
    content = list(text.content)
    for start, end, word in _other_spellings(text.tokens):
        content[start:end] = word.ljust(end - start)
    return "".join(content)


def wrong_folder(text: Text, element: ex.Located, kind: str) -> str | None:
    """Return a message if the text of a ROS type's name has the folder of another kind, such as `srv` for a message.

    `element` is a reference to a type, or an interface. `kind` is `message`, `service` or `action`.
    """
    assert element.source is not None
    span = element.source.span
    end = text.offset(span.end_line, span.end_column)
    at = text.tokens.index_at(text.offset(span.line, span.column))
    while text.tokens[at].end <= end and at < len(text.tokens):
        written = text.tokens[at].text
        if _is_folder(text.tokens, at) and written != FOLDERS[kind]:
            return f"`{written}` holds no types of the kind {kind}, expected `{FOLDERS[kind]}`"
        at += 1
    return None


def _other_spellings(tokens: Tokens) -> Iterator[tuple[int, int, str]]:
    """Yield the places of other spellings, and their replacements."""
    negations = [
        index for index, token in enumerate(tokens) if token.text == NEGATION and not _is_member(tokens, index)
    ]
    if all(_is_negation(tokens, index) for index in negations):
        yield from ((tokens[index].start, tokens[index].end, "!") for index in negations)
    declared = {token.text for index, token in enumerate(tokens) if tokens[index - 1].text in _DECLARING}
    declared |= {token.text for index, token in enumerate(tokens) if tokens[index + 1].text == ":"}
    for index, token in enumerate(tokens):
        # A quotient such as `length / msg / count` has declared names on both sides.
        is_quotient = token.text in declared and tokens[index - 2].text in declared
        if not is_quotient and _is_folder(tokens, index):
            yield token.start, tokens[index + 1].end, ""


def _is_member(tokens: Tokens, index: int) -> bool:
    """Return whether a word is the name of a property: no expression can mean it without a point before it."""
    before, after = tokens[index - 1], tokens[index + 1]
    return before.text == "." or (after.text == ":" and before.text not in (*_DECLARING, "(", ","))


def _is_negation(tokens: Tokens, index: int) -> bool:
    """Return whether an operand, and nothing that makes it a name, is beside a `not`."""
    before, after = tokens[index - 1], tokens[index + 1]
    if before.text in _DECLARING or tokens[index].is_name:
        return False
    starts_operand = not is_reserved(after.text) or after.text in first("Expression")
    is_word = after.kind is Kind.WORD and starts_operand
    return is_word or after.kind in {Kind.NUMBER, Kind.STRING} or after.is_keyword("!", "(")


def _is_folder(tokens: Tokens, index: int) -> bool:
    """Return whether a word is the folder in `package/msg/Type`, or in `use msg/Type` of an interface."""
    before, after = tokens[index - 1], tokens[index + 1]
    if tokens[index].text not in FOLDERS.values() or after.text != "/" or tokens[index + 2].kind is not Kind.WORD:
        return False
    return before.is_keyword("use") or (before.text == "/" and tokens[index - 2].kind is Kind.WORD)
