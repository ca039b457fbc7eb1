"""The TextMate grammar, by which Visual Studio Code and many other tools color texts."""

from __future__ import annotations

import json
from typing import Any

from robosc.language.highlighting.rules import BLOCK_COMMENT, HighlightRule, Kind, rules


def grammar() -> str:
    """Return the text of `robosc.tmLanguage.json`."""
    begin, end = BLOCK_COMMENT
    block = {"name": "comment.block.robosc", "begin": begin, "end": end}
    document = {
        "name": "RoboSC",
        "scopeName": "source.robosc",
        "fileTypes": ["rscd"],
        "patterns": [block, *(_pattern(rule) for rule in rules() if rule.kinds != (Kind.BLANK,))],
    }
    return json.dumps(document, indent=2) + "\n"


def _pattern(rule: HighlightRule) -> dict[str, Any]:
    if len(rule.kinds) == 1:
        return {"match": rule.pattern, "name": f"{rule.kinds[0]}.robosc"}
    captures = {
        str(number): {"name": f"{kind}.robosc"} for number, kind in enumerate(rule.kinds, 1) if kind is not Kind.BLANK
    }
    return {"match": rule.pattern, "captures": captures}
