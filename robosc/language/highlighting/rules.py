"""Regular expressions for the parts of a text: comments, strings, numbers, keywords in context, names."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from robosc.model.semantics.naming import ROBOSC_FUNCTIONS, ROBOSC_QUANTIFIERS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


class Kind(StrEnum):
    """Kind of a piece of text, as its scope in TextMate grammars."""

    COMMENT = "comment.line.double-slash"
    STRING = "string.quoted"
    FLOAT = "constant.numeric.float"
    INTEGER = "constant.numeric.integer"
    DECLARATION = "keyword.declaration"
    MODIFIER = "storage.modifier"
    CONTROL = "keyword.control"
    TYPE = "support.type"
    CONSTANT = "constant.language"
    DATA = "variable.language"
    WORD_OPERATOR = "keyword.operator.logical"
    FUNCTION = "support.function"
    UNIT = "keyword.other.unit"
    DECLARED = "entity.name.type"
    NAME = "variable.other"
    OPERATOR = "keyword.operator"
    PUNCTUATION = "punctuation"
    BLANK = "text"


#: Kinds of words of the grammar.
WORDS = (
    *(Kind.DECLARATION, Kind.MODIFIER, Kind.CONTROL, Kind.TYPE, Kind.CONSTANT, Kind.DATA, Kind.WORD_OPERATOR),
    *(Kind.FUNCTION, Kind.UNIT),
)
#: Words that cannot be names in an expression.
RESERVED: Mapping[Kind, tuple[str, ...]] = {
    Kind.DECLARATION: (
        *(
            "action",
            "behaviour",
            "component",
            "datatype",
            "enum",
            "import",
            "interface",
            "library",
            "message",
            "object",
        ),
        *("provide", "requirement", "robot", "service", "state", "transition", "use", "variable"),
    ),
    Kind.MODIFIER: ("incoming", "initial", "marked", "outgoing"),
    Kind.CONTROL: (
        *("cancel", "default", "disables", "do", "error", "feedback", "from", "goto", "identifier", "if", "links"),
        *("needs", "on", "request", "response", "to", "type", "with"),
    ),
    Kind.TYPE: ("array", "boolean", "double", "integer", "none", "string"),
    Kind.CONSTANT: ("false", "true"),
    Kind.DATA: ("value",),
    Kind.WORD_OPERATOR: ("and", "or"),
}
#: Words that are names unless they begin a construct.
IN_CONTEXT: Mapping[Kind, tuple[str, ...]] = {
    Kind.DECLARATION: ("assume", "automaton", "condition", "constant", "function", "is", "parameter", "property"),
    Kind.CONTROL: (*("after", "always", "each", "else", "in", "never", "reachable", "since", "then", "without"),),
}
SEND = ("send", "change")
AT_MOST = ("at", "most")
UNITS = ("ms", "s", "min")

_NAME = r"\^?[A-Za-z_][A-Za-z0-9_]*"
#: Reserved words that are keywords, not names of fields, before a colon.
_KEYS = ("identifier", "type", "request", "response", "feedback")
#: Words that follow a name, and never the start of a construct.
_BEHIND_NAMES = ("and", "disables", "do", "goto", "in", "needs", "or", "to")
#: Start and end of a comment that may span several lines.
BLOCK_COMMENT = (r"/\*", r"\*/")


@dataclass(frozen=True)
class HighlightRule:
    """A regular expression, and the kind of its match, or of each of its groups, which cover the match."""

    pattern: str
    kinds: tuple[Kind, ...]


def rules() -> Iterator[HighlightRule]:
    """Yield all rules; if several match at a place, the first one counts. Block comments take precedence."""
    blank, number = r"(\s+)", r"[0-9]+(?:\.[0-9]+)?"
    unit, name = _any(UNITS), f"({_NAME})"
    yield HighlightRule(r"//[^\n]*", (Kind.COMMENT,))
    yield HighlightRule(r'"(?:[^"\\\n]|\\.)*"?', (Kind.STRING,))
    yield HighlightRule(r"'(?:[^'\\\n]|\\.)*'?", (Kind.STRING,))
    # Times
    yield HighlightRule(rf"(?<![0-9])({number}){blank}{unit}\b", (Kind.FLOAT, Kind.BLANK, Kind.UNIT))
    yield HighlightRule(rf"(\)){blank}{unit}\b", (Kind.PUNCTUATION, Kind.BLANK, Kind.UNIT))
    after = (Kind.CONTROL, Kind.BLANK, Kind.NAME, Kind.BLANK, Kind.UNIT)
    yield HighlightRule(rf"(?<![\w^])(after){blank}({_NAME}(?:\.{_NAME})?){blank}{unit}\b", after)
    # A number before the dots of a range is not a double.
    yield HighlightRule(r"(?<![0-9])[0-9]+\.[0-9]+\b", (Kind.FLOAT,))
    yield HighlightRule(r"[0-9]+\b", (Kind.INTEGER,))
    # In positions for names only, keywords are names, too.
    yield HighlightRule(r"\.\.", (Kind.OPERATOR,))
    yield HighlightRule(rf"(\.)(\s*){name}", (Kind.PUNCTUATION, Kind.BLANK, Kind.NAME))
    yield HighlightRule(rf"\^{_NAME[3:]}", (Kind.NAME,))
    declaring = ("robot", "library", "component", "state", "message", "service", "action", "variable", "interface")
    declared = (Kind.DECLARATION, Kind.BLANK, Kind.DECLARED)
    yield HighlightRule(rf"{_any((*declaring, 'enum', 'object'))}{blank}{name}", declared)
    yield HighlightRule(
        rf"{_any(('constant', 'parameter', 'condition', 'function'))}{blank}{name}(?=\s*[:=(])", declared
    )
    yield HighlightRule(rf"{_any(('requirement', 'property', 'assume'))}{blank}{name}(?=\s*[:\"'])", declared)
    yield HighlightRule(rf"(?<![\w^])(goto){blank}{name}", (Kind.CONTROL, Kind.BLANK, Kind.NAME))
    yield HighlightRule(rf"(->)(\s*){name}", (Kind.OPERATOR, Kind.BLANK, Kind.NAME))
    yield HighlightRule(rf"(?<![\w^])(in){blank}(value)\b", (Kind.CONTROL, Kind.BLANK, Kind.DATA))
    yield HighlightRule(r"(send)(\s*:\s*)(change)\b", (Kind.CONTROL, Kind.PUNCTUATION, Kind.CONTROL))
    yield HighlightRule(rf"(?<![\w^])(at){blank}(most)\b", (Kind.CONTROL, Kind.BLANK, Kind.CONTROL))
    yield HighlightRule(r"(?<![\w^])(canceled)(?=\s+(?:from|to)\b)", (Kind.CONTROL,))
    command = rf"{_NAME}(?:\[[^\]\n]*\])?(?:\s*\.\s*{_NAME})?"
    yield HighlightRule(rf"(?<![\w^])(limit)(?=\s+{command}\s+with\b)", (Kind.DECLARATION,))
    reserved = [word for words in RESERVED.values() for word in words]
    yield HighlightRule(rf"{_any([word for word in reserved if word not in _KEYS])}(?=\s*:(?!=))", (Kind.NAME,))
    # Words that depend on the text behind them
    yield HighlightRule(rf"{_any(ROBOSC_QUANTIFIERS)}\b(?=\s+{_NAME}(?:\s*:|\s+in\b))", (Kind.WORD_OPERATOR,))
    yield HighlightRule(rf"{_any(ROBOSC_FUNCTIONS)}\b(?=\s*\()", (Kind.FUNCTION,))
    no_operand = rf"(?!{_any(_BEHIND_NAMES)}\b)"
    for kind, words in IN_CONTEXT.items():
        yield HighlightRule(rf"{_any(words)}\b(?=\s*$|\s+{no_operand}[\w^({{!\-\"'\[]|\()", (kind,))
    for kind, words in RESERVED.items():
        yield HighlightRule(rf"{_any(words)}\b", (kind,))
    yield from _other_text()


def scenario_rules() -> Iterator[HighlightRule]:
    """Yield the rules for scenarios, in the same order of precedence."""
    begin, blank, name = r"(^\s*|\{\s*)", r"(\s+)", r"[\w^]"
    yield HighlightRule(r"//[^\n]*", (Kind.COMMENT,))
    yield HighlightRule(r'"(?:[^"\\\n]|\\.)*"?', (Kind.STRING,))
    yield HighlightRule(rf'{begin}(scenario)(?=\s+")', (Kind.BLANK, Kind.DECLARATION))
    both = (Kind.BLANK, Kind.CONTROL, Kind.BLANK, Kind.CONTROL)
    yield HighlightRule(rf"{begin}(before){blank}(each)(?=\s*\{{)", both)
    yield HighlightRule(rf"{begin}(refuse){blank}(cancel)(?=\s+of\b)", both)
    yield HighlightRule(rf"{begin}(every|repeat|wait)(?=\s+[0-9])", (Kind.BLANK, Kind.CONTROL))
    yield HighlightRule(rf"{begin}(stop)(?=\s+(?!with\b|because\b){name})", (Kind.BLANK, Kind.CONTROL))
    yield HighlightRule(rf"{begin}(expect)(?=\s)", (Kind.BLANK, Kind.CONTROL))
    time = rf"(?<![\w.])([0-9]+(?:\.[0-9]+)?)(\s*)({'|'.join(UNITS)})\b"
    yield HighlightRule(time, (Kind.FLOAT, Kind.BLANK, Kind.UNIT))
    yield HighlightRule(r"(?<![0-9])[0-9]+\.[0-9]+\b", (Kind.FLOAT,))
    yield HighlightRule(r"[0-9]+\b", (Kind.INTEGER,))
    kinds = ("request", "response", "error", "feedback", "canceled", "cancel")
    yield HighlightRule(rf"{_any(kinds)}{blank}(from|to)\b", (Kind.CONTROL, Kind.BLANK, Kind.CONTROL))
    behind = ("allowed", "because", "by", "forbidden", "of", "sent", "time", "times", "violated", "with", "within")
    yield HighlightRule(rf"(?<=\s)({'|'.join(behind)})(?=\s|$)", (Kind.CONTROL,))
    yield HighlightRule(r"(?<=\s)(not)(?=\s+sent\b)", (Kind.CONTROL,))
    yield HighlightRule(r"(?<=\s)(message)(?=\s*\{)", (Kind.CONTROL,))
    yield HighlightRule(r"(\.)(\s*)([\w^]+)", (Kind.PUNCTUATION, Kind.BLANK, Kind.NAME))
    yield HighlightRule(rf"{_any(RESERVED[Kind.CONSTANT])}\b", (Kind.CONSTANT,))
    yield HighlightRule(rf"{_any(RESERVED[Kind.WORD_OPERATOR])}\b", (Kind.WORD_OPERATOR,))
    yield from _other_text()


def _other_text() -> Iterator[HighlightRule]:
    """Yield the rules for names, operators and blanks, which come last."""
    yield HighlightRule(_NAME, (Kind.NAME,))
    yield HighlightRule(r":=|->|=>|!=|<=|>=|[-+*/=<>!]", (Kind.OPERATOR,))
    yield HighlightRule(r"[{}()\[\],:.]", (Kind.PUNCTUATION,))
    yield HighlightRule(r"\s+", (Kind.BLANK,))


def _any(words: list[str] | tuple[str, ...]) -> str:
    """Return a group that matches one of the words, at the start of a word."""
    return rf"(?<![\w^])({'|'.join(map(re.escape, words))})"
