"""Parser of scenarios: a line for each step and each expectation, and blocks of lines."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from robosc.base.diagnostics import Diagnostic, Severity, Span
from robosc.model.semantics.naming import output_name
from robosc.model.semantics.steps import (
    EVENT,
    TIME,
    StepError,
    data_in_words,
    event_in_words,
    seconds_in_words,
    step_in_words,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

RULE = "scenario"
_SCENARIO = re.compile(r'scenario\s+"([^"]+)"')
_WAIT = re.compile(rf"wait\s+{TIME}")
_EVERY = re.compile(rf"every\s+{TIME}\s+(?P<step>.+)")
_STOP = re.compile(rf"stop\s+{EVENT}")
#: The beginning of a block, and its first line if that is on the same line.
_BLOCK = re.compile(r"(?:repeat\s+(?P<rounds>\d{1,9})|(?P<before>before\s+each))\s*\{\s*(?P<rest>.*)")
_WITHIN = re.compile(rf"(?P<expected>.*\S)\s+within\s+{TIME}")
#: The beginning of an attempt at a block or a time.
_ALMOST_BLOCK = re.compile(r"(?:repeat|before)\b.*\{")
_ALMOST_WITHIN = re.compile(r".*\swithin(?:\s+\d\S*(?:\s+\w+)?)?")
_ALMOST_EXPECTED = re.compile(EVENT + r"\s+(?:allowed|forbidden|(?:not\s+)?sent|accepted|rejected)\b.*")
#: A millisecond and a day. Shorter intervals and longer waits are mistakes.
_SHORTEST = 0.001
_LONGEST = 86_400
#: Limits of `repeat`: rounds with those of the blocks around it, and blocks within each other.
_MOST_ROUNDS = 1_000_000
_DEEPEST = 10
_EXPECTED = re.compile(
    EVENT + r"\s+(?:(?P<verdict>allowed)|(?P<forbidden>forbidden)(?:\s+by\s+(?P<by>.+))?"
    r"|(?P<not_sent>not\s+sent)|(?P<taken>accepted|rejected)"
    r"|(?P<sent>sent)(?:\s+(?P<count>\d{1,9})\s+times?)?(?:\s+with\s+(?P<data>.+))?)"
)
#: The name of an assumption, as in a model or as in output: `A1[Cell[2]]`, `A1[Cell2]`.
_VIOLATED = re.compile(r"(?P<assumption>\^?[A-Za-z_][\w.^]*(?:\[[\w.^\[\]]+\])?)\s+violated")
#: Other words that a line may begin with, and how to write such a line.
_FORMS = {
    "scenario": 'write `scenario "stops for an obstacle"`',
    "wait": "write `wait 500 ms` or `wait 3.0 s`",
    "expect": "write `expect move allowed`, or a condition",
    "every": "write `every 500 ms response from closed with true`",
    "stop": "write `stop response from closed` to end its `every`",
    "repeat": "write `repeat 3 {`, steps on lines of their own, and `}`",
    "before": "write `before each {`, steps on lines of their own, and `}`",
}
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

    def part(self, text: str) -> Line:
        """Return the end of the line that has this text."""
        end = self.span.end_column
        return Line(self.file, Span(self.span.line, end - len(text), self.span.line, end))


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
class Every(Line):
    """Step that is repeated after each interval, until `Stop` or the end of the scenario."""

    seconds: float
    step: IncomingEvent


@dataclass(frozen=True)
class Stop(Line):
    """End of the repetition of an event."""

    event: str


@dataclass(frozen=True)
class Repeat(Line):
    """Block of lines that is played several times."""

    rounds: int
    steps: list[Line] = field(default_factory=list)


@dataclass(frozen=True)
class Expectation(Line):
    """Expectation. It has to be met at the present moment, or at some moment `within` so many seconds."""

    within: float | None = field(default=None, kw_only=True)


@dataclass(frozen=True)
class Holds(Expectation):
    """Expectation that a condition holds; `number` is its position among those of the file."""

    text: str
    number: int


@dataclass(frozen=True)
class Permission(Expectation):
    """Expectation that an event is allowed or forbidden, optionally by a certain requirement."""

    event: str
    forbidden: bool = False
    by: str | None = None


@dataclass(frozen=True)
class SentCommand(Expectation):
    """Expectation that a command was sent since the last step, or not; optionally with this data.

    `count` is the expected number of times, None for any number from one on.
    """

    event: str
    expected: bool = True
    data: Any = None
    count: int | None = None


@dataclass(frozen=True)
class Acceptance(Expectation):
    """Expectation that the controller accepted a goal of the last step, or rejected it."""

    event: str
    expected: bool = True


@dataclass(frozen=True)
class Violation(Expectation):
    """Expectation that the robot violated an assumption with the last step."""

    assumption: str


@dataclass
class Scenario:
    """Run of the robot from its start. The first steps may be those of `before each`."""

    name: str
    line: Line
    steps: list[Line] = field(default_factory=list)

    @property
    def lines(self) -> Iterator[Line]:
        """The lines in the order of the text, with those in blocks, and the steps of `every`."""
        return _all_lines(self.steps)


def _all_lines(steps: Iterable[Line]) -> Iterator[Line]:
    for line in steps:
        yield line
        if isinstance(line, Repeat):
            yield from _all_lines(line.steps)
        elif isinstance(line, Every):
            yield line.step


def read_scenarios(file: str, text: str) -> tuple[list[Scenario], list[Holds], list[Diagnostic]]:
    """Parse a text; return its scenarios, all conditions that they expect, and findings about the text."""
    reader = _Reader(file)
    for number, line in enumerate(text.split("\n"), 1):
        words = _without_comment(line).rstrip()
        start = len(words) - len(words.lstrip())
        if words:
            reader.read(words[start:], Line(file, Span(number, start + 1, number, len(words) + 1)))
    reader.end()
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
        #: Steps of `before each`; None if the file has no such block so far.
        self._shared: list[Line] | None = None
        #: Numbers of the scenarios with an expectation, from 1.
        self._expecting: set[int] = set()
        #: Open blocks: their first lines, their steps, and how often these are played.
        self._blocks: list[tuple[Line, list[Line], int]] = []

    def read(self, text: str, line: Line) -> None:
        word, *rest = text.split(maxsplit=1)
        block = _BLOCK.fullmatch(text)
        if word == "scenario":
            self._scenario(text, line)
        elif block is not None:
            self._block(block, line)
        elif text == "}":
            if self._blocks:
                self._blocks.pop()
            else:
                self._fault(line, "this `}` closes no block", "leave it out")
        else:
            self._steps(line).extend(self._step_or_expectation(word, "".join(rest), text, line))

    def end(self) -> None:
        """Check the whole file."""
        self._close_blocks()
        start_of_file = Line(self._file, Span(1, 1, 1, 1))
        if not self.scenarios:
            self._fault(start_of_file, "the file has no scenario", 'begin with `scenario "…"`')
        for number, scenario in enumerate(self.scenarios, 1):
            if scenario.name and number not in self._expecting:
                self._fault(scenario.line, "the scenario has no expectation", "write `expect …`")

    def _fault(self, line: Line, message: str, hint: str | None = None) -> None:
        self.findings.append(line.fault(message, hint))

    def _scenario(self, text: str, line: Line) -> None:
        self._close_blocks()
        match = _SCENARIO.fullmatch(text)
        if match is None:
            self._fault(line, "a scenario needs a name", _FORMS["scenario"])
        self.scenarios.append(Scenario(match[1] if match else "", line, list(self._shared or ())))

    def _steps(self, line: Line) -> list[Line]:
        """Return the steps to which a line belongs."""
        if self._blocks:
            return self._blocks[-1][1]
        if not self.scenarios:
            self._fault(line, "this line is before the first scenario", 'begin with `scenario "…"`')
            self.scenarios.append(Scenario("", line, list(self._shared or ())))
        return self.scenarios[-1].steps

    # Blocks

    def _block(self, match: re.Match[str], line: Line) -> None:
        if match["before"]:
            self._before_each(line)
        else:
            self._repeat(int(match["rounds"]), line)
        rest = match["rest"]
        if not rest:
            return
        if rest.endswith("}") and _is_whole("{" + rest):
            inner = rest[:-1].rstrip()
            if inner:
                column = line.span.end_column - len(rest)
                self.read(inner, Line(line.file, Span(line.span.line, column, line.span.line, column + len(inner))))
            if self._blocks:
                self._blocks.pop()
        else:
            self._fault(line.part(rest), "this line has more than the beginning of a block", "begin a new line here")

    def _before_each(self, line: Line) -> None:
        if self.scenarios or self._shared is not None or self._blocks:
            self._fault(line, "`before each` is not at the beginning", "write it once, before the first scenario")
            self._blocks.append((line, [], 1))
        else:
            self._shared = []
            self._blocks.append((line, self._shared, 1))

    def _repeat(self, rounds: int, line: Line) -> None:
        steps = self._steps(line)
        rounds_in_all = rounds * (self._blocks[-1][2] if self._blocks else 1)
        if not 1 <= rounds_in_all <= _MOST_ROUNDS:
            message = "a block is played 1 to 1,000,000 times, including those around it"
            self._fault(line, message, "write another number")
            rounds = rounds_in_all = 1
        if len(self._blocks) >= _DEEPEST:
            self._fault(line, f"more than {_DEEPEST} blocks are within each other", "write fewer blocks")
            steps = []
        block = Repeat(line.file, line.span, rounds)
        steps.append(block)
        self._blocks.append((line, block.steps, rounds_in_all))

    def _close_blocks(self) -> None:
        """Report blocks that have no end."""
        for line, *_ in self._blocks:
            self._fault(line, "this block has no end", "write `}` on a line of its own after its last step")
        self._blocks.clear()

    # Steps and expectations

    def _step_or_expectation(self, word: str, rest: str, text: str, line: Line) -> Iterator[Line]:
        if word == "expect":
            self._expecting.add(len(self.scenarios))
            yield from self._expected(rest, line)
        elif word == "wait":
            seconds = _seconds(_WAIT.fullmatch(text))
            if seconds is None:
                self._fault(line, "`wait` needs a time of at most a day", _FORMS["wait"])
            else:
                yield Wait(line.file, line.span, seconds)
        elif (every := _EVERY.fullmatch(text)) is not None:
            yield from self._every(every, line)
        elif (stop := _STOP.fullmatch(text)) is not None:
            yield Stop(line.file, line.span, event_in_words(stop))
        else:
            yield from self._step(text, line)

    def _every(self, match: re.Match[str], line: Line) -> Iterator[Line]:
        seconds = _seconds(match)
        if not seconds or seconds < _SHORTEST:
            self._fault(line, "`every` needs a time from 1 ms to a day", _FORMS["every"])
        for step in self._step(match["step"], line, _FORMS["every"]):
            if not isinstance(step, IncomingEvent):
                self._fault(line, "a refusal cannot be repeated", _FORMS["every"])
            elif seconds:
                yield Every(line.file, line.span, seconds, step)

    def _step(self, text: str, line: Line, form: str | None = None) -> Iterator[Line]:
        try:
            step = step_in_words(text)
        except StepError as error:
            self._unread(error, text, line)
            return
        if step is None:
            self._fault(line, "this is neither a step nor an expectation", form or _form_of(text.split(maxsplit=1)[0]))
            if _ALMOST_BLOCK.fullmatch(text):
                self._blocks.append((line, [], 1))
        elif step.is_refusal:
            yield Refusal(line.file, line.span, step.event)
        else:
            yield IncomingEvent(line.file, line.span, step.event, step.data, step.is_message, step.reason)

    def _expected(self, text: str, line: Line) -> Iterator[Line]:
        if not text:
            self._fault(line, "`expect` has no expectation", _FORMS["expect"])
            return
        timed = _WITHIN.fullmatch(text)
        within = _seconds(timed)
        if (timed is not None and within is None) or (timed is None and _ALMOST_WITHIN.fullmatch(_TEXT.sub("", text))):
            message = "`within` needs a time in `ms`, `s` or `min`, of at most a day"
            self._fault(line, message, "write `expect move sent within 2 s`")
            return
        end = line.span.end_column
        if timed is not None:
            end -= len(text) - len(timed["expected"])
            text = timed["expected"]
        span = Span(line.span.line, end - len(text), line.span.line, end)
        expected = Line(line.file, span)
        match = _EXPECTED.fullmatch(text)
        violated = _VIOLATED.fullmatch(text)
        if violated is not None:
            assumption = output_name(violated["assumption"].replace("^", ""))
            yield Violation(line.file, line.span, assumption, within=within)
        elif match is None:
            if _ALMOST_EXPECTED.fullmatch(text):
                hint = "write `move sent 3 times with {…} within 2 s`, `move not sent`, `move forbidden by SR1` or"
                hint += " `inspect rejected`"
                self._fault(expected, "this is no expectation about an event", hint)
            elif _is_whole(text):
                self.conditions.append(Holds(line.file, span, text, len(self.conditions), within=within))
                yield self.conditions[-1]
            else:
                self._fault(
                    expected, "this is not a single condition", "close each bracket, and write a comment after `//`"
                )
        else:
            yield from self._about_event(match, line, within, expected)

    def _about_event(self, match: re.Match[str], line: Line, within: float | None, expected: Line) -> Iterator[Line]:
        if match["taken"]:
            yield from self._taken(match, line, within, expected)
        elif match["sent"] or match["not_sent"]:
            yield from self._sent(match, line, within, expected)
        else:
            by = match["by"].strip().strip('"') if match["by"] else None
            if by is not None and not by.strip():
                self._fault(expected, "`forbidden by` names no requirement", "write its name, or a part of its text")
            yield Permission(line.file, line.span, event_in_words(match), bool(match["forbidden"]), by, within=within)

    def _taken(self, match: re.Match[str], line: Line, within: float | None, expected: Line) -> Iterator[Line]:
        if match["kind"] not in (None, "request"):
            hint = "write `inspect accepted` or `inspect rejected`"
            self._fault(expected, "only a goal is accepted or rejected", hint)
            return
        yield Acceptance(line.file, line.span, event_in_words(match), match["taken"] == "accepted", within=within)

    def _sent(self, match: re.Match[str], line: Line, within: float | None, expected: Line) -> Iterator[Line]:
        data, count = None, None
        if match["data"]:
            try:
                data = data_in_words(match.string, match.start("data"))
            except StepError as error:
                self._unread(error, match.string, expected)
        if match["count"]:
            count = int(match["count"])
            if not count:
                self._fault(line, "a command cannot be sent 0 times", "write `not sent`")
        if match["not_sent"] and within is not None:
            self._fault(line, "`not sent` cannot have a time", "write `wait …` before it, and leave out `within …`")
        yield SentCommand(line.file, line.span, event_in_words(match), bool(match["sent"]), data, count, within=within)

    def _unread(self, error: StepError, text: str, line: Line) -> None:
        """Add a finding about the data at the end of a line."""
        self._fault(line.part(text[error.position :]), str(error), error.hint)


def _seconds(match: re.Match[str] | None) -> float | None:
    """Return the time in a text; None if there is none, or if it is longer than a day."""
    seconds = seconds_in_words(match) if match else math.inf
    return seconds if seconds <= _LONGEST else None


def _form_of(word: str) -> str:
    """Return how to write a line that begins with a word, or with one that is close to it."""
    if word in _FORMS:
        return _FORMS[word]
    close = get_close_matches(word, _FORMS, n=1)
    return f"did you mean `{close[0]}`?" if close else "write `response from scan with clear`, `wait 1 s` or `expect …`"
