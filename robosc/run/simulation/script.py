"""Scripts: a line for each event, by its name with its data in JSON, in words, or as a line of an event log."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, NamedTuple

from robosc.analysis.explain import NamingError, find_event
from robosc.base.diagnostics import Diagnostic, Severity, Span
from robosc.base.files.json_reading import JsonError, json_lines, json_value
from robosc.model.semantics.failures import brings_data
from robosc.model.semantics.naming import output_name
from robosc.model.semantics.roles import event_name, plant_of
from robosc.model.semantics.steps import FIRST_WORDS, TIME, StepError, seconds_in_words, step_in_words
from robosc.run.simulation.data import DataError

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from robosc.model import sct
    from robosc.run.simulation.data import EventData

RULE = "script"
WAIT = "wait"
#: Step in which a server refuses to cancel a goal.
REFUSE = "refuse cancel"
#: Keys of the data of an event.
_OF_DATA = ("reason", "value", "where")
#: 100 days. Longer waits are mistakes.
_LONGEST_WAIT = 8_640_000
_TIME = re.compile(TIME)
#: Seconds from which on a time is invalid.
_LATEST = 1e12


@dataclass(frozen=True)
class ScriptStep:
    """Line of a script: an event, or `tick`, `begin` or `end` for a control loop.

    `wait` has its `seconds` as data. `refuse cancel` has the name of the action's plant as `of`. `time` is the time in
    seconds of a line of an event log.
    """

    line: int
    event: str
    data: Mapping[str, Any]
    time: float | None = None


def read_script(
    file: str,
    text: str,
    events: Collection[str],
    others: Collection[str] = (),
    model: sct.SupervisoryControlModel | None = None,
) -> tuple[list[ScriptStep], list[Diagnostic]]:
    """Parse a script; return its steps and findings about its text. `events` are the names that it may use.

    `others` are names that it may use only with `--loop`, or only without. `model` has the events that words name.

    A line is `EVENT [JSON]`, with `--loop` also `wait SECONDS` or `wait 500 ms`, or a JSON object with `event` and
    maybe `data` (other keys of an event log are ignored). With a model it may also be a step of a scenario, such as
    `error from lift because timeout`. Empty lines and lines that begin with `#` are no steps.
    """
    steps: list[ScriptStep] = []
    findings: list[Diagnostic] = []
    names = _Names(events, others, model)
    for number, line in enumerate(json_lines(text), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        parsed_line = _Line(file, number, line, names)
        step = parsed_line.step()
        if step is not None:
            steps.append(step)
        findings += parsed_line.findings
    return steps, findings


def unfit_data(file: str, steps: Iterable[ScriptStep], data: EventData) -> Iterator[Diagnostic]:
    """Yield findings about data that does not fit its event, before any step is played."""
    for step in steps:
        try:
            data.check(step.event, step.data)
        except DataError as error:
            span = Span(step.line, 1, step.line, 1)
            yield Diagnostic(file, span, Severity.ERROR, RULE, f"{step.event}: {error}", error.hint)


def spoken(model: sct.SupervisoryControlModel, text: str) -> tuple[str, dict[str, Any]] | None:
    """Return the event of a step in words, and its data; None if the text is no such step.

    A server that refuses to cancel a goal is the step `refuse cancel` with the action as `of`. Raises NamingError and
    StepError.
    """
    step = step_in_words(text)
    if step is None or step.is_bare:
        return None
    event = find_event(model, step.event)
    if step.is_refusal:
        return REFUSE, {"of": plant_of(event).name}
    if step.data is not None and not brings_data(event, step.reason):
        raise StepError(f"an error with the reason `{step.reason}` has no data", 0, "leave out `with …`")
    data = {} if step.data is None else {"value": step.data}
    return event_name(event), data if step.reason is None else {**data, "reason": step.reason}


def _seconds(time: Any) -> float | None:
    return float(time) if isinstance(time, int | float) and 0 <= time < _LATEST else None


class _Names(NamedTuple):
    """Names of events that a script may use, those that it may use in the other mode, and the model for words."""

    events: Collection[str]
    others: Collection[str]
    model: sct.SupervisoryControlModel | None


class _Line:
    """Line that is not empty."""

    def __init__(self, file: str, number: int, line: str, names: _Names) -> None:
        self._file, self._number, self._line, self._names = file, number, line, names
        self._start = len(line) - len(line.lstrip())
        self.findings: list[Diagnostic] = []

    def step(self) -> ScriptStep | None:
        if self._line[self._start] == "{":
            logged = self._json(self._start)
            if logged is None:
                return None
            name, data = logged.get("event"), logged.get("data", {})
            name = output_name(name) if isinstance(name, str) else name
            if not isinstance(name, str) or not isinstance(data, dict):
                self._fault(self._start, 'expected an object like {"event": "...", "data": {"value": ...}}')
                return None
            for key in (key for key in _OF_DATA if key in logged):
                self._fault(self._place(f'"{key}"'), f"`{key}` is part of the data", 'write it inside `"data"`')
            known = self._known(name, self._place(json.dumps(name)[1:-1], name, '"event"'))
            return (
                self._wait(str(data.get("seconds", "")))
                if known and name == WAIT
                else ScriptStep(self._number, name, data, _seconds(logged.get("time")))
                if known
                else None
            )
        name, _, rest = self._line[self._start :].partition(" ")
        name = output_name(name.rstrip())
        if self._names.model is not None and name in FIRST_WORDS and name not in self._names.events:
            return self._in_words(self._names.model, name)
        known = self._known(name, self._start)
        if known and name == WAIT:
            return self._wait(rest)
        data = self._json(len(self._line) - len(rest.lstrip())) if rest.strip() else {}
        return ScriptStep(self._number, name, data) if known and data is not None else None

    def _place(self, *texts: str) -> int:
        """Return the column, from 0, of the first of some texts that the line has; its start if it has none."""
        return next((self._line.index(text) for text in texts if text in self._line), self._start)

    def _in_words(self, model: sct.SupervisoryControlModel, word: str) -> ScriptStep | None:
        try:
            step = spoken(model, self._line.strip())
        except NamingError as error:
            self._fault(self._start, error.message, error.hint or None, len(word))
            return None
        except StepError as error:
            self._fault(self._start + error.position, str(error), error.hint)
            return None
        if step is None:
            hint = "write `response from scan with clear` or `error from lift because timeout`"
            self._fault(self._start, "this is not a step of a scenario", hint, len(word))
            return None
        event, data = step
        return ScriptStep(self._number, event, data) if event == REFUSE or self._known(event, self._start) else None

    def _wait(self, seconds: str) -> ScriptStep | None:
        with_unit = _TIME.fullmatch(seconds.strip())
        try:
            duration = seconds_in_words(with_unit) if with_unit else float(seconds)
        except ValueError:
            duration = -1.0
        if 0.0 <= duration <= _LONGEST_WAIT:
            return ScriptStep(self._number, WAIT, {"seconds": duration})
        message = f"`wait` needs a number of seconds from 0 to {_LONGEST_WAIT}"
        self._fault(self._start, message, "write `wait 3.0` or `wait 500 ms`", 4)
        return None

    def _known(self, name: str, column: int) -> bool:
        if name in self._names.events:
            return True
        if name in self._names.others:
            looped = "tick" in self._names.events
            message = f"`{name}` is not a line of a script {'with' if looped else 'without'} the control loop"
            hint = "the control loop itself decides at `tick` when it happens" if looped else "it needs `--loop`"
            self._fault(column, message, hint, len(name))
            return False
        close = get_close_matches(name, sorted(self._names.events), n=1)
        hint = f"did you mean `{close[0]}`?" if close else "`robosc synthesize --json` lists the events"
        self._fault(column, f"there is no event `{name}`", hint, len(name))
        return False

    def _json(self, column: int) -> dict[str, Any] | None:
        try:
            parsed = json_value(self._line[column:])
        except JsonError as error:
            self._fault(column + error.position, str(error), error.hint)
            return None
        if not isinstance(parsed, dict):
            self._fault(column, "data is an object", f'write {{"value": {self._line[column:].strip()}}}')
            return None
        return parsed

    def _fault(self, column: int, message: str, hint: str | None = None, length: int = 1) -> None:
        span = Span(self._number, column + 1, self._number, column + 1 + length)
        self.findings.append(Diagnostic(self._file, span, Severity.ERROR, RULE, message, hint))
