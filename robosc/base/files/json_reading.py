"""Reading of JSON and lines of JSON from other programs: each fault is an error with its place."""

from __future__ import annotations

import json
import math
import re
from itertools import accumulate
from typing import Any, NoReturn

_DEEPEST = 100
_BRACKETS = {"{": 1, "[": 1, "]": -1, "}": -1}
#: A string, possibly unterminated, or a bracket.
_STRING_OR_BRACKET = re.compile(r'"(?:[^"\\]|\\.)*"?|[][{}]', re.DOTALL)
#: Words of Python and their equivalents in JSON.
_WORDS = {"True": "true", "False": "false", "None": "null"}
#: Maximum number of digits of a number; Python itself refuses to read a few thousand.
_DIGITS = 1000


class JsonError(ValueError):
    """Invalid or unsupported JSON; `position` is its offset in code points from 0, and `hint` how to fix it."""

    def __init__(self, message: str, position: int = 0, hint: str | None = None) -> None:
        super().__init__(message)
        self.position = position
        self.hint = hint


def json_value(text: str) -> Any:
    """Return the value of a JSON text.

    Raises JsonError, also if it nests too deeply or a number is too large.
    """
    # `json` recurses for any number of brackets, until the process crashes.
    opened = (_BRACKETS.get(match[0], 0) for match in _STRING_OR_BRACKET.finditer(text))
    if max(accumulate(opened, initial=0)) > _DEEPEST:
        raise JsonError("nested too deeply")
    try:
        return json.loads(text, parse_constant=_refuse, parse_int=_integer, parse_float=_number)
    except json.JSONDecodeError as error:
        raise JsonError(f"not JSON: {error.msg}", error.pos, _hint(text, error.pos)) from None
    except ValueError as error:
        raise JsonError(f"not JSON: {error}") from None


def _hint(text: str, position: int) -> str | None:
    """Return the hint for a common mistake at a position, or None."""
    before, after = text[:position].rstrip(), text[position:].lstrip()
    word = re.match(r"\w*", after)
    assert word is not None
    if before.endswith(",") and after[:1] in ("}", "]"):
        return f"leave out the comma before `{after[0]}`"
    if after.startswith(",") and after[1:].lstrip()[:1] in ("}", "]"):  # Python 3.13 reports the comma itself.
        return f"leave out the comma before `{after[1:].lstrip()[0]}`"
    if after.startswith("'"):
        return 'write texts in double quotes, as in "halt"'
    if after.startswith(("//", "/*", "#")):
        return "leave out the comment: JSON has no comments"
    if word[0] in _WORDS:
        return f"write `{_WORDS[word[0]]}`"
    if before.endswith(("{", ",")) and re.match(r"\w+\s*:", after):
        return f'write the key in double quotes: "{word[0]}"'
    if after.startswith(('"', "{", "[")) and before[-1:] not in ("", "{", "[", ":", ","):
        return "write a comma after the value before it"
    return None


def json_lines(text: str) -> list[str]:
    """Return the lines of a log or script, split at line feeds only: strings may contain other line breaks."""
    return text.split("\n")


def _integer(digits: str) -> int:
    if len(digits) > _DIGITS:
        raise ValueError(f"a number of {len(digits)} digits is too long")
    return int(digits)


def _number(digits: str) -> float:
    value = float(digits)
    if math.isinf(value):
        raise ValueError(f"{digits[:20]} is too large a number")
    return value


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is not a JSON number")
