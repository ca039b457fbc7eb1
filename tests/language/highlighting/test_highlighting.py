"""Pygments and the TextMate grammar in editors/vscode color texts as the parser reads them, from one table."""

import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from pygments.token import Error

from robosc.language.grammar import Failure, Node, parse, pattern, words_of
from robosc.language.highlighting import rules
from robosc.language.highlighting.pygments_lexer import _TOKENS, RoboscLexer
from robosc.language.highlighting.rules import WORDS, Kind
from robosc.language.highlighting.textmate import grammar, scenarios_grammar
from robosc.model.semantics.naming import ROBOSC_FUNCTIONS, ROBOSC_KEYWORDS, ROBOSC_QUANTIFIERS

ROOT = Path(__file__).parents[2].parent
TEXTS = [
    *sorted((ROOT / "examples").rglob("*.rscd")),
    *sorted((ROOT / "robosc" / "stdlib").rglob("*.rscd")),
    *sorted((ROOT / "tests" / "every_view").rglob("*.rscd")),
    *sorted((ROOT / "tests" / "language" / "checks" / "accepted").rglob("*.rscd"))[::2],
]
WORD_TOKENS = {_TOKENS[kind] for kind in WORDS}
Words = dict[int, str]


def parsed(text: str) -> Words:
    """Return the language's words that the parser recognizes, by their offsets."""
    tree = parse(text, "Base")
    assert not isinstance(tree, Failure)
    return {node.position: node.value for node in leaves(tree) if is_word(node)}


def leaves(node: Node) -> Iterator[Node]:
    pending = [node]
    while pending:
        part = pending.pop()
        if isinstance(part, list):
            pending += part
        else:
            yield part


def is_word(leaf: Node) -> bool:
    word = str(getattr(leaf.rule, "to_match", ""))
    return (word.isalpha() and word == leaf.value) or leaf.rule_name in ("BuiltIn", "Each", "Quantifier")


def coloured(text: str) -> Words:
    """Return the same words as Pygments colors them."""
    found = RoboscLexer().get_tokens_unprocessed(text)
    return {offset: word for offset, token, word in found if token in WORD_TOKENS}


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_words_are_words_where_they_are_parsed_as_such(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    tokens = list(RoboscLexer().get_tokens_unprocessed(text))
    assert "".join(word for _, _, word in tokens) == text
    assert [word for _, token, word in tokens if token is Error] == []
    assert coloured(text) == parsed(text)


def test_there_are_texts() -> None:
    assert len(TEXTS) > 60
    assert {path.parent.name for path in TEXTS} >= {"line_follower", "sprayer", "stdlib", "every_view"}


def test_the_table_has_the_words_of_the_grammar() -> None:
    """Each new word of the grammar needs a kind."""
    words = {word for word in words_of("Base") if word.isalpha() and word.islower()}
    reserved = {word for words in rules.RESERVED.values() for word in words}
    in_context = {word for words in rules.IN_CONTEXT.values() for word in words}
    assert reserved == ROBOSC_KEYWORDS
    assert reserved | in_context | {*rules.SEND, *rules.AT_MOST, *rules.UNITS, "canceled", "limit"} == words
    assert re.findall(r"\w+", pattern("Quantifier").partition(")")[0]) == list(ROBOSC_QUANTIFIERS)
    assert re.findall(r"\w+", pattern("BuiltIn").partition(")")[0]) == list(ROBOSC_FUNCTIONS)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("goto state", ["goto"]),
        ("state state {", ["state"]),
        ("x.value.state", []),
        ("^state = ^value", []),
        ("value.state", ["value"]),
        ("after 3.0 s goto s", ["after", "s", "goto"]),
        ("after pause ms without scan", ["after", "ms", "without"]),
        ("after (a + b) min", ["after", "min"]),
        ("min(s, min)", ["min"]),
        ("double(x) + double", ["double", "double"]),
        ("all r in value: r > all", ["all", "in", "value"]),
        ("requirement never: never x", ["requirement", "never"]),
        ("after after min without Sensor.scan, without do x", ["after", "min", "without", "do"]),
        ("at most 3 go since most < at", ["at", "most", "since"]),
        ("after Button.dark ms without pressed", ["after", "ms", "without"]),
        ("{ value: 1, default: value }", ["value"]),
        ("0..value", ["value"]),
        ("'goto' // goto\n/* goto\n goto */", []),
        ("send: change", ["send", "change"]),
        ("requirement each: each Station: x after each y", ["requirement", "each", "after", "each"]),
        ("send", []),
    ],
)
def test_words_in_context(text: str, words: list[str]) -> None:
    assert list(coloured(text).values()) == words


def test_the_textmate_grammar_is_up_to_date(golden: Callable[[Path, str], None]) -> None:
    golden(ROOT / "editors" / "vscode" / "syntaxes" / "robosc.tmLanguage.json", grammar())


def test_the_textmate_grammar_of_scenarios_is_up_to_date(golden: Callable[[Path, str], None]) -> None:
    golden(ROOT / "editors" / "vscode" / "syntaxes" / "robosc-scenarios.tmLanguage.json", scenarios_grammar())


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('scenario "every 3 s"', ["scenario"]),
        ("before each {", ["before", "each"]),
        ("  every 500 ms response from closed with true", ["every", "ms", "response", "from", "with", "true"]),
        ("  repeat 3 { every 1 s error with 4 }", ["repeat", "every", "s", "with"]),
        ("  stop response from closed", ["stop", "response", "from"]),
        ("  stop closed", ["stop"]),
        ("  stop with true", ["with", "true"]),
        ("  stop", []),
        ("  wait 1.5 min // wait 2 s", ["wait", "min"]),
        ("  refuse cancel of go", ["refuse", "cancel", "of"]),
        ("  error from lift because timeout", ["error", "from", "because"]),
        ('  scan with message {"with": [1]}', ["with", "message"]),
        (
            "  expect go sent 3 times with {} within 2 s",
            ["expect", "sent", "times", "with", "within", "s"],
        ),
        ("  expect go not sent", ["expect", "not", "sent"]),
        ("  expect go forbidden by SR1", ["expect", "forbidden", "by"]),
        ("  expect Left.sent and n < 3", ["expect", "and"]),
    ],
)
def test_the_textmate_grammar_colours_the_words_of_scenarios(line: str, words: list[str]) -> None:
    assert [word for word, scope in scopes(scenarios_grammar(), line) if scope in WORDS] == words


def scopes(document: str, line: str) -> Iterator[tuple[str, str]]:
    """Yield the pieces of a line with their scopes: at each position, the first pattern that matches counts."""
    compiled = [(re.compile(pattern["match"]), pattern) for pattern in json.loads(document)["patterns"]]
    at = 0
    while at < len(line):
        matches = [(match, pattern) for expression, pattern in compiled if (match := expression.match(line, at))]
        match, pattern = matches[0] if matches else (None, {})
        for _, word, scope in pieces(match, pattern):
            yield word, scope
        at = match.end() if match else at + 1


@pytest.mark.parametrize("path", TEXTS[::6], ids=lambda path: str(path.relative_to(ROOT)))
def test_the_textmate_grammar_colours_the_same(path: Path) -> None:
    """Match line by line as editors do: the first pattern that matches at the nearest position."""
    document = json.loads(grammar())
    block, *patterns = document["patterns"]
    compiled = [(re.compile(pattern["match"]), pattern) for pattern in patterns]
    found: Words = {}
    offset, inside = 0, False
    for line in path.read_text(encoding="utf-8").split("\n"):
        at = 0
        while at < len(line):
            if inside or re.compile(block["begin"]).match(line, at):
                end = re.compile(block["end"]).search(line, at if inside else at + 2)
                inside = end is None
                at = len(line) if end is None else end.end()
                continue
            matches = [(match, pattern) for expression, pattern in compiled if (match := expression.match(line, at))]
            match, pattern = matches[0] if matches else (None, {})
            for first, word, scope in pieces(match, pattern):
                if scope in WORDS:
                    found[offset + first] = word
            at = match.end() if match else at + 1
        offset += len(line) + 1
    assert found == parsed(path.read_text(encoding="utf-8"))


def pieces(match: re.Match[str] | None, pattern: dict[str, Any]) -> Iterator[tuple[int, str, str]]:
    if match is None:
        return
    if "name" in pattern:
        yield match.start(), match[0], pattern["name"].removesuffix(".robosc")
    for number, capture in pattern.get("captures", {}).items():
        yield match.start(int(number)), match[int(number)], capture["name"].removesuffix(".robosc")


def test_every_kind_has_a_colour() -> None:
    assert set(_TOKENS) == set(Kind)
    used = {kind for rule in rules.rules() for kind in rule.kinds}
    assert used == set(Kind)


def test_pygments_finds_the_lexer_by_its_entry_point() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    module, _, name = project["entry-points"]["pygments.lexers"]["robosc"].partition(":")
    assert getattr(import_module(module), name) is RoboscLexer
    assert "robosc" in RoboscLexer.aliases


def test_the_lexer_loads_no_parser() -> None:
    program = "import sys, robosc.language.highlighting.pygments_lexer; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True, cwd=ROOT)
    assert {"textx", "arpeggio", "pyecore"} & set(done.stdout.split()) == set()
