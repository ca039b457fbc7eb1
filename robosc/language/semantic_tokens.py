"""Kinds of the words of a text, for syntax coloring."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.language.grammar import first_words, words_of
from robosc.language.tokens import Kind
from robosc.model import robosc as rsc
from robosc.model.semantics.naming import ROBOSC_QUANTIFIERS, TEXT_FUNCTION
from robosc.model.semantics.operators import FUNCTIONS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.language.scopes import File, Reference
    from robosc.language.tokens import Tokens

#: Kind of a name, by the class of its element.
_CLASSES: dict[type, str] = {
    rsc.Base: "namespace",
    rsc.Component: "class",
    rsc.CommunicationType: "event",
    rsc.State: "enumMember",
    rsc.RequirementState: "enumMember",
    rsc.EnumValue: "enumMember",
    rsc.Variable: "variable",
    rsc.ArrayElement: "variable",
    rsc.Constant: "variable",
    rsc.Condition: "variable",
    rsc.Parameter: "parameter",
    rsc.FormalParameter: "parameter",
    rsc.Interface: "interface",
    rsc.EnumDataType: "enum",
    rsc.ObjectDataType: "struct",
    rsc.ObjectProperty: "property",
    rsc.Function: "function",
    rsc.StatedDefinition: "property",
}
CLASSES = (*dict.fromkeys(_CLASSES.values()), "type", "keyword", "comment", "string", "number", "operator")
_READONLY = (rsc.Constant, rsc.Condition, rsc.FormalParameter, rsc.EnumValue)
_TYPES = first_words("BasicDataType", "Array")
_KINDS = {Kind.NUMBER: "number", Kind.STRING: "string", Kind.OPEN_STRING: "string", Kind.OPEN_COMMENT: "comment"}
_BRACKETS = set("{}()[],.:;")


class Word(NamedTuple):
    """A word or comment: its offsets and its kind from `CLASSES`.

    `declares` marks the name in a declaration, `readonly` the name of an element that never changes.
    """

    start: int
    end: int
    what: str
    declares: bool = False
    readonly: bool = False


def classify(file: File) -> list[Word]:
    """Return the words of a text whose kind is known, in order."""
    names = {name.start: name for name in file.names}
    comments = (Word(start, end, "comment") for start, end in file.text.tokens.comments)
    return sorted([*comments, *_words(file.text.tokens, names)])


def _words(tokens: Tokens, names: dict[int, Reference]) -> Iterator[Word]:
    end = 0
    for index, token in enumerate(tokens):
        if token.start < end:
            continue
        name = names.get(token.start)
        if token.kind in _KINDS:
            yield Word(token.start, token.end, _KINDS[token.kind])
        elif token.kind is Kind.SYMBOL:
            if token.text not in _BRACKETS:
                yield Word(token.start, token.end, "operator")
        elif name is not None and (what := what_of(name.target)) is not None:
            end = name.end
            yield Word(name.start, name.end, what, name.is_declaration, isinstance(name.target, _READONLY))
        elif not token.is_name and name is None and (what := _own(token.text)) is not None:
            yield Word(token.start, token.end, what)
        elif token.text == TEXT_FUNCTION and name is None and tokens[index + 1].text == "(":
            yield Word(token.start, token.end, "function")


def _own(word: str) -> str | None:
    """Return the kind of a word of the language itself."""
    if word in _TYPES:
        return "type"
    if word in FUNCTIONS:
        return "function"
    return "keyword" if word in words_of("Base").union(ROBOSC_QUANTIFIERS) else None


def what_of(target: Any) -> str | None:
    """Return the kind from `CLASSES` of the element that a name refers to, or None if there is none."""
    if isinstance(target, rsc.InterfaceTypeReference):
        return "struct"
    return next((kind for element_kind, kind in _CLASSES.items() if isinstance(target, element_kind)), None)
