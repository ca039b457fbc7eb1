"""Parses a text into objects of the grammar and reports its faults.

Only this module of the package uses textX.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

import arpeggio
import textx

from robosc.base.diagnostics import Repair
from robosc.base.files.resources import locate
from robosc.language.syntax_messages import closest, keyword_hint
from robosc.model.semantics.naming import enumeration

if TYPE_CHECKING:
    from robosc.base.diagnostics import Diagnostic
    from robosc.language.text import Text

#: Parsing stops after this many faults of one text.
_MOST = 20
_BLANK = re.compile(r"//[^\n]*|/\*.*?\*/|\s+", re.DOTALL)
_TOKEN = re.compile(r'"(?:[^\\"\n]|\\.)*+"?|[$]?\w+(?:\.\w+)*|<=>|:=|=>|<=|>=|!=|\.\.|.', re.DOTALL)
#: End of a statement, or of the header of a statement with a body.
_END = re.compile(r'"(?:[^\\"\n]|\\.)*+"?|//[^\n]*|/\*.*?(?:\*/|\Z)|;|:(?!=)|\bend\b', re.DOTALL)
_RULES = {
    "Identifier": "a name",
    "NameToken": "a name",
    "NumberToken": "a whole number",
    "RealToken": "a number",
    "StringToken": "a string",
    "AnnotationName": "an annotation",
}
#: Maximum nesting depth of brackets, groups and statements of functions: the parser recurses for each level, and Python
#: bounds the recursion depth.
DEEPEST = 50
#: Matches names as a whole, so that no part of a name counts as a keyword.
_NESTING = re.compile(
    r'"(?:[^\\"\n]|\\.)*+"?|//[^\n]*|/\*.*?(?:\*/|\Z)|@@?[\w:]+|\.\.|[.^]?\$?\w+(?:\.\$?\w+)*|[][(){};]|:(?!=)',
    re.DOTALL,
)
_CLOSINGS = {")": "(", "]": "[", "}": "{"}
_BRACKETS = frozenset(_CLOSINGS.values())
_BLOCKS = frozenset(["group", "location"])
#: Hints for text that is nested too deep, by the nested construct.
_MENDS = {
    **dict.fromkeys(_BRACKETS, "move parts of it to algebraic variables"),
    "group": "move it out of groups",
    "func": "split the statements of its functions",
}
#: Constructs with an `end` that count only in functions: in expressions the parser reads them without recursion.
_FLAT = frozenset(["if", "switch", "while"])
#: Words that begin a statement and occur neither in expressions nor in parameter lists.
_STARTERS = frozenset(["group", "plant", "requirement", "supervisor", "automaton", "invariant", "edge"]) | frozenset(
    ["disc", "const", "input", "enum", "equation", "initial", "marked"]
)
#: Phrases for words that the grammar expects only together.
_GROUPS = (
    ("an expression", {"true", "NumberToken", "not"}),
    ("an operator", {"and", "or", "div"}),
)
#: Operators of other languages and their equivalents in CIF.
_MEANT = {"==": "=", "&&": "and", "||": "or", "!": "not", "<>": "!="}


@cache
def _grammar() -> Any:
    return textx.metamodel_from_file(str(locate("grammar/cif.tx")), autokwd=True)


@cache
def _identifier() -> re.Pattern[str]:
    """Return the grammar's own regular expression for a name that is not a keyword."""
    pending, seen = [_grammar()._parser_blueprint.parser_model], set[int]()  # noqa: SLF001 - textX has no other access
    while pending:
        rule = pending.pop()
        if rule.rule_name == "Identifier" and isinstance(rule, arpeggio.RegExMatch):
            return re.compile(rule.to_match_regex)
        pending += [part for part in getattr(rule, "nodes", ()) if id(part) not in seen]
        seen.update(map(id, getattr(rule, "nodes", ())))
    raise AssertionError("the grammar has no rule Identifier")


def identifier(name: str) -> str:
    """Return a name as a text writes it: a keyword without a qualifier needs a dollar sign before it."""
    is_alone = "." not in name and not name.startswith("^")
    return f"${name}" if is_alone and _identifier().fullmatch(name) is None else name


def parse(text: Text) -> tuple[Any, list[Diagnostic]]:
    """Return the specification in a text (None if it has faults), and its findings of the rule `syntax`."""
    content, findings = text.content, list[Any]()
    if (deep := _too_deep(text)) is not None:
        return None, [deep]
    reported = -1
    while True:
        try:
            if not findings:
                return _parse(text), findings
            _grammar()._parser_blueprint.clone().parse(content)  # noqa: SLF001 - what model_from_str does first
        except textx.TextXSyntaxError as fault:
            failed = fault.__cause__
        except RecursionError:
            return None, [text.error("syntax", 0, 0, "this is nested too deeply", _MENDS["func"])]
        else:
            return None, findings
        assert isinstance(failed, arpeggio.NoMatch)
        start, end, token = _token(content, failed.position)
        if findings and (failed.position <= reported or token in {"end", ""}):
            return None, findings  # This fault is probably a consequence of the previous one.
        expectations = list(dict.fromkeys(map(_expectation, failed.rules)))
        findings.append(text.error("syntax", start, end, _message(token, expectations), _hint(token, expectations)))
        if len(findings) == _MOST:
            return None, findings
        first, reported = _statement(content, start)
        blanked = re.sub(r"[^\n]", " ", content[first:reported])
        content = content[:first] + blanked + content[reported:]


def annotations_of(specification: Any) -> list[Any]:
    """Return the annotations of a specification, in the order of the text."""
    annotations: list[Any] = textx.get_children_of_type("Annotation", specification)
    return annotations


def _too_deep(text: Text) -> Diagnostic | None:
    """Return the finding at the first bracket, group or statement that is nested too deep, or None.

    An unclosed bracket does not add to the depth of later statements.
    """
    around: list[tuple[str, int]] = []  # the open constructs, each with its depth
    head = False  # whether this may be the header of a function, whose statements follow a colon
    for token in _NESTING.finditer(text.content):
        word = token[0]
        _close(around, word)
        top, depth = around[-1] if around else ("", 0)
        if word in _STARTERS or (word in {"func", ";"} and top not in _BRACKETS):
            head = word == "func"  # If a semicolon comes first, `func` was a type.
        opened = _opening_text(word, top, head=head)
        counts = opened in _MENDS and word != ":"
        if counts and depth == DEEPEST:
            message = f"this is nested more than {DEEPEST} levels deep"
            return text.error("syntax", token.start(), token.end(), message, _MENDS[opened])
        if opened:
            around.append((opened, depth + counts))
    return None


def _close(around: list[tuple[str, int]], word: str) -> None:
    """Remove the constructs that a word closes."""
    if word in _STARTERS:
        while around and around[-1][0] not in _BLOCKS:
            around.pop()
    elif word == "end":
        while around and around.pop()[0] in _BRACKETS:
            pass
    elif around and _CLOSINGS.get(word) == around[-1][0]:
        around.pop()


def _opening_text(word: str, top: str, *, head: bool) -> str:
    """Return the construct that a word opens (`func` for the statements of a function), or an empty string."""
    if word == ":":
        return "func" if head and top in {"", "group"} else ""
    if word in _FLAT:
        return "func" if top == "func" else word
    # An automaton counts from its first location on; `location` in brackets is a parameter.
    is_automaton = word == "location" and top != word and top not in _BRACKETS
    return word if is_automaton or word in _BRACKETS or word == "group" else ""


def _parse(text: Text) -> Any:
    """Return the objects of a text; a text of comments alone gets an empty specification."""
    specification = _grammar().model_from_str(text.content)
    if isinstance(specification, str):
        specification = _Nothing()
    specification.whole_text = text
    return specification


class _Nothing:
    """A specification without declarations."""

    declarations = ()
    _tx_position = 0
    _tx_position_end = 0
    whole_text: Text


def _token(content: str, position: int) -> tuple[int, int, str]:
    while (blank := _BLANK.match(content, position)) is not None:
        position = blank.end()
    token = _TOKEN.match(content, position)
    return (position, position, "") if token is None else (token.start(), token.end(), token[0])


def _statement(content: str, position: int) -> tuple[int, int]:
    """Return the range of the statement around a position, its semicolon included."""
    first = 0
    for mark in _END.finditer(content):
        word = mark[0]
        if mark.start() >= position and word == ";":
            return first, mark.end()
        if mark.end() <= position and word in {";", ":", "end"}:
            first = mark.end()
    return first, len(content)


def _expectation(rule: Any) -> str:
    if isinstance(rule, arpeggio.EndOfFile):
        return "the end of the file"
    named = rule.rule_name and rule.rule_name in _RULES
    return str(rule.rule_name if named else getattr(rule, "to_match", rule.rule_name))


def _message(symbol: str, expectations: list[str]) -> str:
    words = [word for word in expectations if word]
    for name, core in _GROUPS:
        if core <= set(words):
            first = words.index(next(word for word in words if word in core))
            words = [
                name if place == first else word for place, word in enumerate(words) if place == first or _tells(word)
            ]
    phrases = [
        word if word in {name for name, _ in _GROUPS} or " " in word else _RULES.get(word, f"`{word}`")
        for word in words
        if len(word) < 20 and (word in _RULES or "\\" not in word)
    ]
    shown = f"`{symbol if len(symbol) <= 30 else symbol[:29] + chr(0x2026)}`" if symbol else "the end of the file"
    if not phrases:
        return f"{shown} is not allowed here"
    return f"found {shown}, expected {enumeration(dict.fromkeys(phrases))}"


def _tells(word: str) -> bool:
    """Return whether an expected word is worth listing beside an expression or an operator."""
    return word in {";", ",", ":", ":=", ")", "do", "goto", "needs", "disables", "when"}


def _hint(symbol: str, expectations: list[str]) -> Repair | str | None:
    """Return a repair or hint for an unexpected symbol, or None if there is none."""
    if symbol in _MEANT and _MEANT[symbol] in expectations:
        return Repair(f"write `{_MEANT[symbol]}`", _MEANT[symbol])
    if symbol == "=" and ":=" in expectations:
        return Repair("write `:=` for an assignment", ":=")
    close = (
        closest(symbol, [word for word in expectations if word.isalpha()], cutoff=0.6)
        if symbol.isidentifier()
        else None
    )
    if close is not None and symbol not in expectations:
        return keyword_hint(symbol, close)
    if ";" in expectations and symbol.isidentifier():
        return "is a `;` missing before it?"
    if symbol.isidentifier() and "Identifier" in expectations:
        return f"write a dollar sign before a keyword that is a name: `${symbol}`"
    return None
