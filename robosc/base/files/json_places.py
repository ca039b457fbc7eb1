"""Places of values in a JSON text, and findings about a text that pydantic rejects."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Span

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Position of a value: keys of objects and indices of arrays, from the outside inwards.
Key = tuple[str | int, ...]

#: End of a position that is the key itself.
_KEY = "[key]"
#: Reasons for errors in which pydantic uses Python's names.
_WRONG_TYPE = {"model_type": "be an object", "dict_type": "be an object", "list_type": "be an array"}


def reason_of(fault: Any) -> str:
    """Return the message of pydantic's error about a value, which names its key."""
    name = ".".join(str(part) for part in fault["loc"] if part != _KEY)
    if fault["type"] == "extra_forbidden":
        return f'unknown key "{name}"'
    if fault["type"] == "missing":
        return f'the key "{name}" is missing'
    reason = _WRONG_TYPE.get(fault["type"]) or re.sub("^(Input|String|Value error,) (should )?", "", fault["msg"])
    reason = f"must {reason}" if fault["msg"].startswith(("Input", "String")) else reason
    return f'"{name}" {reason}' if name else f"the file {reason}"


def span_of(text: str, key: Key) -> Span:
    """Return the span of a key in a JSON text. If it is missing, return that of the innermost key around it."""
    start = end = inside = _skip(text, 0)
    for name in key:
        entry = next((entry for entry in _entries(text, inside) if entry[0] in (name, f"/{name}")), None)
        if entry is None:
            break
        _, start, end, inside = entry
    return _between(text, start, end)


def duplicates(text: str) -> Iterator[tuple[str, Span]]:
    """Yield the keys that occur twice in one object of a JSON text, each with the span of the second."""
    yield from _duplicates(text, _skip(text, 0))


def _duplicates(text: str, start: int) -> Iterator[tuple[str, Span]]:
    names: set[str | int] = set()
    for name, begin, end, inside in _entries(text, start):
        if name in names:
            yield str(name), _between(text, begin, end)
        names.add(name)
        yield from _duplicates(text, inside)


def _entries(text: str, start: int) -> Iterator[tuple[str | int, int, int, int]]:
    """Iterate over the members of the object or array at `start`: key or index, start and end of it, start of value."""
    if text[start] not in "{[":
        return
    place, at = 0, _skip(text, start + 1)
    while text[at] not in "}]":
        name, begin, value = place, at, at
        end = None
        if text[start] == "{":
            name, end = json.JSONDecoder().raw_decode(text, at)
            value = _skip(text, _skip(text, end) + 1)
        _, after = json.JSONDecoder().raw_decode(text, value)
        yield name, begin, end or after, value
        at = _skip(text, after)
        at = _skip(text, at + 1) if text[at] == "," else at
        place += 1


def _skip(text: str, start: int) -> int:
    """Return the position of the next nonblank character."""
    return next((at for at in range(start, len(text)) if text[at] not in " \t\r\n"), len(text))


def _between(text: str, start: int, end: int) -> Span:
    return Span(*position(text, start), *position(text, end))


def position(text: str, offset: int) -> tuple[int, int]:
    """Return the line and column of an offset, both counted from 1."""
    return text.count("\n", 0, offset) + 1, offset - text.rfind("\n", 0, offset)
