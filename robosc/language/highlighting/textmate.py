"""The TextMate grammar, by which Visual Studio Code and many other tools color texts."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from robosc.language.highlighting.rules import BLOCK_COMMENT, HighlightRule, Kind, rules, scenario_rules

if TYPE_CHECKING:
    from collections.abc import Iterable


def grammar() -> str:
    """Return the text of `robosc.tmLanguage.json`."""
    begin, end = BLOCK_COMMENT
    block = {"name": "comment.block.robosc", "begin": begin, "end": end}
    return _document("RoboSC", "source.robosc", "rscd", [block, *_patterns(rules())])


def scenarios_grammar() -> str:
    """Return the text of `robosc-scenarios.tmLanguage.json`."""
    return _document("RoboSC Scenarios", "source.robosc-scenarios", "scenarios", _patterns(scenario_rules()))


def _document(name: str, scope: str, suffix: str, patterns: list[dict[str, Any]]) -> str:
    document = {"name": name, "scopeName": scope, "fileTypes": [suffix], "patterns": patterns}
    return json.dumps(document, indent=2) + "\n"


def _patterns(several: Iterable[HighlightRule]) -> list[dict[str, Any]]:
    return [_pattern(rule) for rule in several if rule.kinds != (Kind.BLANK,)]


def _pattern(rule: HighlightRule) -> dict[str, Any]:
    if len(rule.kinds) == 1:
        return {"match": rule.pattern, "name": f"{rule.kinds[0]}.robosc"}
    captures = {
        str(number): {"name": f"{kind}.robosc"} for number, kind in enumerate(rule.kinds, 1) if kind is not Kind.BLANK
    }
    return {"match": rule.pattern, "captures": captures}
