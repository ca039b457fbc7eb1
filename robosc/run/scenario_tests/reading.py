"""Parser of scenarios: a line for each step and each expectation."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Diagnostic, Severity, Span
from robosc.model.semantics.steps import EVENT, StepError, data_in_words, event_in_words, step_in_words

if TYPE_CHECKING:
    from collections.abc import Iterator

RULE = "scenario"
_SCENARIO = re.compile(r'scenario\s+"([^"]+)"')
_WAIT = re.compile(r"wait\s+(\d+(?:\.\d+)?)\s*(ms|s|min)")
_SECONDS = {"ms": 0.001, "s": 1.0, "min": 60.0}
#: A day. Longer waits are mistakes.
_LONGEST = 86_400
_EXPECTED = re.compile(
    EVENT + r"\s+(?:(?P<verdict>allowed)|(?P<forbidden>forbidden)(?:\s+by\s+(?P<by>.+))?"
    r"|(?P<sent>(?:not\s+)?sent)(?:\s+with\s+(?P<data>.+))?|(?P<violated>violated))"
)
#: Other words that a line may begin with.
_WORDS = ("scenario", "wait", "expect")
_TEXT = re.compile(r'"[^"]*"')
_CLOSING = {"(": ")", "[": "]", "{": "}"}


@dataclass(frozen=True)
class Line:
    """Line of a scenario, with its place: from its first word to its end."""

    file: str
    span: Span

    def fault(self, message: str, hint: str | None = None) -> Diagnostic:
        """Return a finding about the line."""
        return Diagnostic(self.file, self.span, Severity.ERROR, RULE, message, hint)


@dataclass(frozen=True)
class IncomingEvent(Line):
    """Incoming event from the robot; `event` is named as for `explain`, such as `scan` or `dock.error`.

    `data` is the data of the event as in the event log. `is_message`: it has all fields of the ROS message. `reason`:
    the reason of an error, None if the text names none.
    """

    event: str
    data: Any = None
    is_message: bool = False
    reason: str | None = None


@dataclass(frozen=True)
class Refusal(Line):
    """Refusal of a server to cancel a goal; `event` is the end that the goal would have, such as `dock.canceled`."""

    event: str


@dataclass(frozen=True)
class Wait(Line):
    """Passage of time."""

    seconds: float


@dataclass(frozen=True)
class Holds(Line):
    """Expectation that a condition holds; `number` is its position among those of the file."""

    text: str
    number: int


@dataclass(frozen=True)
class Permission(Line):
    """Expectation that an event is allowed or forbidden, optionally by a certain requirement."""

    event: str
    forbidden: bool = False
    by: str | None = None


@dataclass(frozen=True)
class SentCommand(Line):
    """Expectation that a command was sent since the last step, or not; optionally with this data."""

    event: str
    expected: bool = True
    data: Any = None


@dataclass(frozen=True)
class Violation(Line):
    """Expectation that the robot violated an assumption with the last step."""

    assumption: str


@dataclass
class Scenario:
    """Run of the robot from its start."""

    name: str
    line: Line
    steps: list[Line] = field(default_factory=list)


def read_scenarios(file: str, text: str) -> tuple[list[Scenario], list[Holds], list[Diagnostic]]:
    """Parse a text; return its scenarios, all conditions that they expect, and findings about the text."""
    reader = _Reader(file)
    for number, line in enumerate(text.split("\n"), 1):
        words = _without_comment(line).rstrip()
        start = len(words) - len(words.lstrip())
        if words:
            reader.read(words[start:], Line(file, Span(number, start + 1, number, len(words) + 1)))
    if not reader.scenarios:
        start_of_file = Line(file, Span(1, 1, 1, 1))
        reader.findings.append(start_of_file.fault("the file has no scenario", 'begin with `scenario "…"`'))
    for scenario in reader.scenarios:
        if not any(isinstance(step, (Holds, Permission, SentCommand, Violation)) for step in scenario.steps):
            reader.findings.append(scenario.line.fault("the scenario has no expectation", "write `expect …`"))
    return reader.scenarios, reader.conditions, sorted(reader.findings, key=lambda finding: finding.span.line)


def _is_whole(text: str) -> bool:
    """Return whether the brackets of a condition are closed, and no comment begins or ends in it."""
    plain = _TEXT.sub("", text)
    opened = []
    for character in plain:
        if character in _CLOSING:
            opened.append(_CLOSING[character])
        elif character in _CLOSING.values() and (not opened or opened.pop() != character):
            return False
    return not opened and "/*" not in plain and "*/" not in plain


def _without_comment(line: str) -> str:
    """Return a line up to `//`, unless that is within quotes."""
    quoted = False
    for position, character in enumerate(line):
        quoted ^= character == '"'
        if not quoted and line.startswith("//", position):
            return line[:position]
    return line


class _Reader:
    def __init__(self, file: str) -> None:
        self._file = file
        self.scenarios: list[Scenario] = []
        self.conditions: list[Holds] = []
        self.findings: list[Diagnostic] = []

    def read(self, text: str, line: Line) -> None:
        word, *rest = text.split(maxsplit=1)
        if word == "scenario":
            named = _SCENARIO.fullmatch(text)
            if named is None:
                self.findings.append(line.fault("a scenario needs a name", 'write `scenario "stops for an obstacle"`'))
            self.scenarios.append(Scenario(named[1] if named else "", line))
            return
        if not self.scenarios:
            self.findings.append(line.fault("this line is before the first scenario", 'begin with `scenario "…"`'))
            self.scenarios.append(Scenario("", line))
        steps = self.scenarios[-1].steps
        if word == "wait":
            steps += self._wait(text, line)
        elif word == "expect":
            steps += self._expected("".join(rest), line)
        else:
            steps += self._step(text, line)

    def _wait(self, text: str, line: Line) -> Iterator[Line]:
        match = _WAIT.fullmatch(text)
        seconds = float(match[1]) * _SECONDS[match[2]] if match else -1.0
        if 0 <= seconds <= _LONGEST:
            yield Wait(line.file, line.span, seconds)
        else:
            self.findings.append(
                line.fault("`wait` needs a time of at most a day", "write `wait 500 ms` or `wait 3.0 s`")
            )

    def _step(self, text: str, line: Line) -> Iterator[Line]:
        try:
            step = step_in_words(text)
        except StepError as error:
            self._unread(error, text, line)
            return
        if step is None:
            close = get_close_matches(text.split(maxsplit=1)[0], _WORDS, n=1)
            hint = (
                f"did you mean `{close[0]}`?"
                if close
                else "write `response from scan with clear`, `wait 1 s` or `expect …`"
            )
            self.findings.append(line.fault("this is neither a step nor an expectation", hint))
        elif step.is_refusal:
            yield Refusal(line.file, line.span, step.event)
        else:
            yield IncomingEvent(line.file, line.span, step.event, step.data, step.is_message, step.reason)

    def _expected(self, text: str, line: Line) -> Iterator[Line]:
        match = _EXPECTED.fullmatch(text)
        if match is None:
            if not text:
                self.findings.append(
                    line.fault("`expect` has no expectation", "write `expect move allowed`, or a condition")
                )
                return
            column = line.span.end_column - len(text)
            span = Span(line.span.line, column, line.span.line, line.span.end_column)
            if not _is_whole(text):
                hint = "close each bracket, and write a comment after `//`"
                self.findings.append(Line(line.file, span).fault("this is not a single condition", hint))
                return
            self.conditions.append(Holds(line.file, span, text, len(self.conditions)))
            yield self.conditions[-1]
        elif match["violated"]:
            yield Violation(line.file, line.span, text.rsplit(maxsplit=1)[0].replace("^", ""))
        elif match["sent"]:
            expected = match["sent"] == "sent"
            data = self._data(text, match, line)
            if not expected and data is not None:
                self.findings.append(line.fault("`not sent` cannot have data", "leave out `with …`"))
            yield SentCommand(line.file, line.span, event_in_words(match), expected, data)
        else:
            by = match["by"].strip().strip('"') if match["by"] else None
            yield Permission(line.file, line.span, event_in_words(match), bool(match["forbidden"]), by)

    def _data(self, text: str, match: re.Match[str], line: Line) -> Any:
        """Return the data at the end of an expectation; None if there is none, or if it can't be parsed."""
        try:
            return data_in_words(text, match.start("data")) if match["data"] else None
        except StepError as error:
            self._unread(error, text, line)
            return None

    def _unread(self, error: StepError, text: str, line: Line) -> None:
        """Add a finding about the data at the end of a line."""
        column = line.span.end_column - len(text) + error.position
        span = Span(line.span.line, column, line.span.line, line.span.end_column)
        self.findings.append(Line(line.file, span).fault(str(error), error.hint))
