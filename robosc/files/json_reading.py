"""JSON and lines of JSON that somebody else has written: what can't be used is an error with its place."""

from __future__ import annotations

import json
import math
import re
from itertools import accumulate
from typing import Any, NoReturn

_DEEPEST = 100
_BRACKETS = {"{": 1, "[": 1, "]": -1, "}": -1}
#: A string, which may have no end, or a bracket.
_STRING_OR_BRACKET = re.compile(r'"(?:[^"\\]|\\.)*"?|[][{}]', re.DOTALL)
#: What Python writes, and JSON.
_WORDS = {"True": "true", "False": "false", "None": "null"}
#: No number has more; Python itself refuses to read some thousand.
_DIGITS = 1000


class JsonError(ValueError):
    """Text that is no JSON for us; `position` is where in it, in code points from 0. `hint`: how to mend it."""

    def __init__(self, message: str, position: int = 0, hint: str | None = None) -> None:
        super().__init__(message)
        self.position = position
        self.hint = hint


def json_value(text: str) -> Any:
    """The value of a JSON text. Raises JsonError, also where it nests too deeply or a number is too large."""
    # `json` follows any number of brackets, until the process ends.
    opened = (_BRACKETS.get(found[0], 0) for found in _STRING_OR_BRACKET.finditer(text))
    if max(accumulate(opened, initial=0)) > _DEEPEST:
        raise JsonError("nested too deeply")
    try:
        return json.loads(text, parse_constant=_refuse, parse_int=_integer, parse_float=_number)
    except json.JSONDecodeError as error:
        raise JsonError(f"not JSON: {error.msg}", error.pos, _hint(text, error.pos)) from None
    except ValueError as error:
        raise JsonError(f"not JSON: {error}") from None


def _hint(text: str, position: int) -> str | None:
    """How to mend a common mistake at a position; None for others."""
    before, after = text[:position].rstrip(), text[position:].lstrip()
    word = re.match(r"\w*", after)
    assert word is not None
    if before.endswith(",") and after[:1] in ("}", "]"):
        return f"leave out the comma before `{after[0]}`"
    if after.startswith(",") and after[1:].lstrip()[:1] in ("}", "]"):  # Python 3.13 points at the comma
        return f"leave out the comma before `{after[1:].lstrip()[0]}`"
    if after.startswith("'"):
        return 'write texts in double quotes, as in "halt"'
    if after.startswith(("//", "/*", "#")):
        return "leave out the comment: JSON has none"
    if word[0] in _WORDS:
        return f"write `{_WORDS[word[0]]}`"
    if before.endswith(("{", ",")) and re.match(r"\w+\s*:", after):
        return f'write the key in double quotes: "{word[0]}"'
    if after.startswith(('"', "{", "[")) and before[-1:] not in ("", "{", "[", ":", ","):
        return "write a comma after the value before it"
    return None


def json_lines(text: str) -> list[str]:
    """The lines of a log or script: they end at line feeds only, for strings may hold what else breaks lines."""
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
    raise ValueError(f"{constant} is no number of JSON")
