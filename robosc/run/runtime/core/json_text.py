"""JSON as the generated nodes write it: the same bytes for the same data."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import TypeAlias

from robosc.base.diagnostics.visible import HIDDEN_PATTERN, code

#: Values that can be written as JSON.
Json: TypeAlias = bool | int | float | str | Mapping[str, "Json"] | Sequence["Json"] | None

#: Characters to escape: line separators, and control characters that a terminal obeys.
_ESCAPED = re.compile(r'["\\]|' + HIDDEN_PATTERN)


def json_text(value: Json) -> str:
    """Return the JSON text of a value, without blanks; a number that is not finite becomes null."""
    match value:
        case None:
            return "null"
        case bool():
            return "true" if value else "false"
        case int():
            return str(value)
        case float():
            return _number(value)
        case str():
            return f'"{_ESCAPED.sub(_escape, value)}"'
        case Mapping():
            return "{" + ",".join(f"{json_text(name)}:{json_text(member)}" for name, member in value.items()) + "}"
    return "[" + ",".join(map(json_text, value)) + "]"


def _number(value: float) -> str:
    """Return the shortest text of 15 to 17 digits that reads back as the same number."""
    if not math.isfinite(value):
        return "null"
    texts = (f"{value:.{digits}g}" for digits in (15, 16, 17))
    return next(text for text in texts if float(text) == value)


def _escape(match: re.Match[str]) -> str:
    return f"\\{match[0]}" if match[0] in '"\\' else code(match[0])
