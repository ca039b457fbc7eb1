"""The compiled grammar. This is the one place that knows textX and its parser, Arpeggio."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import arpeggio
import textx

from robosc.files.resources import locate

#: A node of a parse tree: `rule_name`, `position`, `position_end`; a list of nodes, or a word with its `value`.
Node = Any


@dataclass(frozen=True)
class Failure:
    """Where a text stops being what the grammar wants, and what it wants there: words of the language or rules."""

    position: int
    expected: tuple[str, ...]


@cache
def language() -> Any:
    """The textX metamodel of the grammar, compiled once in a process."""
    return textx.metamodel_from_file(str(locate("grammar/robosc.tx")), autokwd=True)


def parse(text: str, rule: str) -> Node | Failure:
    """The parse tree of a whole text by a rule of the grammar, or where the text fails."""
    parser = language()._parser_blueprint.clone()  # noqa: SLF001 - what model_from_str does before it links
    parser.parser_model = arpeggio.Sequence(
        nodes=[language()[rule]._tx_peg_rule, arpeggio.EOF()],  # noqa: SLF001
        rule_name="Model",
        root=True,
    )
    try:
        return parser.parse(text)[0]
    except textx.TextXSyntaxError as fault:
        failed = fault.__cause__
        assert isinstance(failed, arpeggio.NoMatch)
        return Failure(
            failed.position, tuple(dict.fromkeys(each for each in map(_wanted, failed.rules) if each != "Comment"))
        )


def is_reserved(word: str) -> bool:
    """Whether a word is a keyword, so that it needs a `^` where it could be one."""
    return language()["UnreservedName"]._tx_peg_rule.regex.match(word) is None  # noqa: SLF001


def attribute(node: Node) -> str | None:
    """The feature that a node of a parse tree assigns; None where it is no assignment."""
    return node.rule._attr_name if node.rule_name.startswith("__asgn") else None  # noqa: SLF001


def _wanted(rule: Any) -> str:
    if isinstance(rule, arpeggio.EndOfFile):
        return "end"
    word = str(getattr(rule, "to_match", rule.rule_name))
    named = rule.rule_name and not rule.rule_name.startswith(("__", "sep")) and not word.isalpha()
    return str(rule.rule_name) if named else word
