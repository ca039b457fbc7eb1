"""The compiled grammar. Only this module uses textX and its parser, Arpeggio."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from itertools import count
from typing import TYPE_CHECKING, Any

import arpeggio
import textx

from robosc.base.files.resources import locate
from robosc.base.interruption import current_check

if TYPE_CHECKING:
    from collections.abc import Mapping

#: A node of a parse tree: `rule_name`, `position`, `position_end`; a list of nodes, or a word with its `value`.
Node = Any
#: The parser calls the check after this many failed alternatives.
_FAILURES = 100


@dataclass(frozen=True)
class Failure:
    """Position of a syntax error, and the words or rules that the grammar expects there."""

    position: int
    expected: tuple[str, ...]


@cache
def language() -> Any:
    """Return the textX metamodel of the grammar, compiled once per process."""
    return textx.metamodel_from_file(str(locate("grammar/robosc.tx")), autokwd=True)


def parse(text: str, rule: str) -> Node | Failure:
    """Return the parse tree of a whole text by a rule of the grammar, or the failure.

    Calls the caller's checkpoint.
    """
    parser = language()._parser_blueprint.clone()  # noqa: SLF001 - what model_from_str does before it links
    parser.parser_model = arpeggio.Sequence(
        nodes=[_peg(rule), arpeggio.EOF()],
        rule_name="Model",
        root=True,
    )
    _check_on_failures(parser)
    try:
        return parser.parse(text)[0]
    except textx.TextXSyntaxError as fault:
        failed = fault.__cause__
        assert isinstance(failed, arpeggio.NoMatch)
        return Failure(
            failed.position, tuple(dict.fromkeys(word for word in map(_expectation, failed.rules) if word != "Comment"))
        )


def _check_on_failures(parser: Any) -> None:
    """Make the parser call the caller's check at every hundredth failed alternative."""
    check = current_check()
    if check is None:
        return
    fail, failures = parser._nm_raise, count(1)  # noqa: SLF001

    def checked(*place: Any) -> None:
        if next(failures) % _FAILURES == 0:
            check()
        fail(*place)

    parser._nm_raise = checked  # noqa: SLF001


def first(rule: str) -> frozenset[str]:
    """Return the words, symbols and word rules that can begin a text of a rule of the grammar."""
    return frozenset(_facts()[id(_peg(rule))].first)


def last(*rules: str) -> frozenset[str]:
    """Return the words, symbols and word rules that can end a text of one of these rules."""
    return frozenset().union(*(_facts()[id(_peg(rule))].last for rule in rules))


def first_words(*rules: str) -> frozenset[str]:
    """Return the keywords that can begin a text of one of these rules, except those that begin an expression."""
    words = frozenset().union(*map(first, rules))
    return frozenset(word for word in words - first("Expression") if word.isalpha() and word.islower())


@cache
def following() -> Mapping[str, frozenset[str]]:
    """Return the words and symbols that can follow a word within its item, by word.

    The next item of a list does not count.
    """
    facts, followers = _facts(), dict[str, set[str]]()
    for node in _nodes().values():
        in_order = isinstance(node, arpeggio.Sequence) and not isinstance(node, arpeggio.OrderedChoice)
        if not in_order and not isinstance(node, arpeggio.UnorderedGroup):
            continue
        for index, part in enumerate(node.nodes):
            for other in node.nodes[index + 1 :] if in_order else node.nodes:
                for word in facts[id(part)].last if other is not part else ():
                    followers.setdefault(word, set()).update(facts[id(other)].first)
                if in_order and not facts[id(other)].nullable:
                    break
    return {word: frozenset(others) for word, others in followers.items()}


@cache
def words_of(rule: str) -> frozenset[str]:
    """Return all words, symbols and word rules that can occur in a text of a rule."""
    return frozenset(_expectation(node) for node in _nodes(rule).values() if isinstance(node, arpeggio.Match))


@dataclass
class _Facts:
    """Properties of a part of the grammar: whether it may be empty, and the words that can begin and end it."""

    nullable: bool = False
    first: set[str] = field(default_factory=set)
    last: set[str] = field(default_factory=set)


def _peg(rule: str) -> Any:
    return language()[rule]._tx_peg_rule  # noqa: SLF001


@cache
def _nodes(rule: str = "Base") -> Mapping[int, Any]:
    """Return the parser nodes of a rule of the grammar by their identity."""
    nodes_by_identity: dict[int, Any] = {}
    pending = [_peg(rule)]
    while pending:
        node = pending.pop()
        if id(node) not in nodes_by_identity:
            nodes_by_identity[id(node)] = node
            pending += node.nodes
    return nodes_by_identity


@cache
def _facts() -> Mapping[int, _Facts]:
    """Return the properties of all parts of the grammar as a least fixed point: rules refer to each other."""
    facts = {identity: _Facts() for identity in _nodes()}
    changed = True
    while changed:
        changed = False
        for identity, node in _nodes().items():
            before = facts[identity]
            after = _fact(node, facts)
            changed = changed or before != after
            facts[identity] = after
    return facts


def _fact(node: Any, facts: Mapping[int, _Facts]) -> _Facts:
    if isinstance(node, arpeggio.Match):
        return _Facts(False, {_expectation(node)}, {_expectation(node)})
    if isinstance(node, arpeggio.SyntaxPredicate):
        return _Facts(True)
    parts = [facts[id(part)] for part in node.nodes]
    nullable = all(part.nullable for part in parts)
    if isinstance(node, arpeggio.OrderedChoice):
        nullable = any(part.nullable for part in parts)
    if isinstance(node, arpeggio.OrderedChoice | arpeggio.UnorderedGroup):
        return _Facts(
            nullable, set().union(*(part.first for part in parts)), set().union(*(part.last for part in parts))
        )
    result = _Facts(nullable or isinstance(node, arpeggio.Optional | arpeggio.ZeroOrMore))
    for part in parts:
        result.first |= part.first
        if not part.nullable:
            break
    for part in reversed(parts):
        result.last |= part.last
        if not part.nullable:
            break
    return result


def pattern(rule: str) -> str:
    """Return the regular expression of a rule that matches a word, such as a string, or a comment."""
    return str(_peg(rule).to_match)


def is_reserved(word: str) -> bool:
    """Return whether a word is a keyword and therefore needs a `^` to be a name."""
    return _peg("UnreservedName").regex.match(word) is None


def attribute(node: Node) -> str | None:
    """Return the feature that a node of a parse tree assigns, or None if it assigns none."""
    return node.rule._attr_name if node.rule_name.startswith("__asgn") else None  # noqa: SLF001


def _expectation(rule: Any) -> str:
    if isinstance(rule, arpeggio.EndOfFile):
        return "end"
    word = str(getattr(rule, "to_match", rule.rule_name))
    named = rule.rule_name and not rule.rule_name.startswith(("__", "sep")) and not word.isalpha()
    return str(rule.rule_name) if named else word
