"""Steps in words: parser for events from the robot, in a line of a script or a scenario."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from robosc.base.files.json_reading import JsonError, json_value
from robosc.model.semantics.naming import output_name

_KINDS = ("request", "response", "error", "feedback", "canceled", "cancel")
#: First words of a step that is not a bare name.
FIRST_WORDS = (*_KINDS, "refuse")
_KIND = rf"(?P<kind>{'|'.join(_KINDS)})"
_NAME = r"(?P<name>\^?[A-Za-z_]\w*(?:\[[0-9]+\])?(?:\.\^?\w+)*)"
#: An event in words, such as `response from scan`. A bare name stands for the usual event of its communication.
EVENT = rf"(?:{_KIND}\s+(?:to|from)\s+)?{_NAME}"
#: A time in words, such as `500 ms`, and the seconds of each unit.
_SECONDS = {"ms": 0.001, "s": 1.0, "min": 60.0}
TIME = rf"(?P<time>\d+(?:\.\d+)?)\s*(?P<unit>{'|'.join(_SECONDS)})"
_STEP = re.compile(EVENT + r"(?:\s+because\s+(?P<reason>\w+))?(?:\s+with\s+(?P<message>message\s+)?(?P<data>.+))?")
_REFUSAL = re.compile(rf"refuse\s+cancel\s+of\s+{_NAME}")
_LITERAL = re.compile(r"(?!true$|false$|null$)[A-Za-z_]\w*")


class StepError(ValueError):
    """Error of an unreadable step. The message holds the cause, `position` the code point in the text (from 0)."""

    def __init__(self, message: str, position: int, hint: str | None) -> None:
        super().__init__(message)
        self.position = position
        self.hint = hint


@dataclass(frozen=True)
class StepInWords:
    """A step: an event that comes from the robot. `event` is in the syntax of `explain`: `scan` or `dock.error`.

    `reason` is the reason of an error, or None if the text names none. `data` is the event's data in the form of the
    event log, or None. `is_message`: the data has the fields of the ROS message. `is_refusal`: the step is no event but
    a server's answer that it does not cancel the goal; `event` is then the cancellation that does not happen.
    """

    event: str
    is_bare: bool = False
    reason: str | None = None
    data: Any = None
    is_message: bool = False
    is_refusal: bool = False


def step_in_words(text: str) -> StepInWords | None:
    """Parse a step without surrounding blanks.

    Return None if the text is no step. Raises StepError for invalid data.
    """
    refusal = _REFUSAL.fullmatch(text)
    if refusal is not None:
        return StepInWords(f"{_plain(refusal)}.canceled", is_refusal=True)
    step = _STEP.fullmatch(text)
    if step is None:
        return None
    data = data_in_words(text, step.start("data")) if step["data"] else None
    if step["message"] and not isinstance(data, dict):
        raise StepError("a message must be an object with fields", 0, 'write `with message {"ranges": [1.0]}`')
    return StepInWords(event_in_words(step), not step["kind"], step["reason"], data, bool(step["message"]))


def event_in_words(match: re.Match[str]) -> str:
    """Return the event of a match of EVENT, in the syntax of `explain`."""
    return f"{_plain(match)}.{match['kind']}" if match["kind"] else _plain(match)


def seconds_in_words(match: re.Match[str]) -> float:
    """Return the seconds of a match of TIME."""
    return float(match["time"]) * _SECONDS[match["unit"]]


def data_in_words(text: str, position: int) -> Any:
    """Parse the data at the end of a text: JSON, or the name of a literal. Raises StepError."""
    data = text[position:]
    if _LITERAL.fullmatch(data):
        return data
    try:
        value = json_value(data)
    except JsonError as error:
        hint = error.hint or "data is JSON, or the name of a literal"
        raise StepError(str(error), position + error.position, hint) from None
    if value is None:
        raise StepError("`null` is not data", position, 'leave it out; `{"data": null}` is a number that is not finite')
    return value


def _plain(match: re.Match[str]) -> str:
    return output_name(match["name"].replace("^", ""))
