"""Interactive simulation: one command at a time, each answered with text."""

from __future__ import annotations

import json
from difflib import get_close_matches
from random import Random
from typing import TYPE_CHECKING

from robosc.base.files import reading as files
from robosc.base.files.writing import write_file
from robosc.model.semantics.steps import FIRST_WORDS
from robosc.run.simulation.data import DataError
from robosc.run.simulation.script import REFUSE, read_script
from robosc.run.simulation.simulation import whole_state
from robosc.run.simulation.unreadable import Unreadable

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.base.diagnostics import Diagnostic
    from robosc.engine import Blocked
    from robosc.run.simulation.simulation import RequestResult, Simulation

HELP = """\
NUMBER or EVENT, with its data in JSON: perform it, as in  1 {"value": 3}
or in the words of a scenario:  error from dock because timeout
  e          enabled events           d          disabled events, and why
  s          the state                u          undo
  r [N]      N random events          t          the trace
  save FILE  save the trace           load FILE  play a trace or script
  h          this help                q          quit"""

#: Maximum number of random events of a command.
MOST_AT_ONCE = 10_000


class Session:
    """Interpreter of commands about a simulation; random events are the same for the same seed.

    `named`: the displayed names of events, if they differ from their names.
    """

    def __init__(self, simulation: Simulation, seed: int, named: Mapping[str, str] | None = None) -> None:
        self.ended = False
        self._simulation = simulation
        self._random = Random(seed)  # noqa: S311
        self._shown = whole_state(simulation.engine)
        #: Displayed name of each event.
        self._named = {event: (named or {}).get(event, event) for event in simulation.engine.events}
        self._commands: dict[str, Callable[[str], str]] = {
            "e": lambda _: self.enabled(),
            "d": lambda _: self._disabled(),
            "s": lambda _: self.state(),
            "u": lambda _: self._undo(),
            "r": self._run,
            "t": lambda _: "\n".join(map(trace_line, self._simulation.trace)) or "nothing yet",
            "save": self._save,
            "load": self._load,
            **dict.fromkeys(("h", "help", "?"), lambda _: HELP),
            **dict.fromkeys(("q", "quit", "exit"), self._quit),
        }

    def do(self, line: str) -> str:
        """Run a command and return its answer. Raises OSError or ValueError if a file can't be read or written."""
        word, _, rest = line.strip().partition(" ")
        if not word:
            return self.enabled()
        if word in self._commands:
            return self._commands[word](rest.strip())
        enabled = self._simulation.enabled
        number = _number(word)
        if number is not None and 1 <= number <= len(enabled):
            word = enabled[number - 1]
        engine = self._simulation.engine
        if word not in (*engine.events, *FIRST_WORDS) and not word.startswith(("{", "#")):
            close = get_close_matches(word, engine.events, n=1)
            hint = f", did you mean `{close[0]}`?" if close else ""
            return f"unknown command or event `{word}`{hint} (h for help)"
        steps, findings = read_script("", f"{word} {rest}", engine.events, model=engine.model)
        return _complaints(findings) or "\n".join(self._perform(step.event, dict(step.data)) for step in steps)

    def enabled(self) -> str:
        """Return the enabled events, numbered."""
        enabled = self._simulation.enabled
        return (
            "\n".join(f"{number:4} {self._named[event]}" for number, event in enumerate(enabled, 1))
            or "no event can happen any more"
        )

    def state(self) -> str:
        """Return the whole state."""
        return "\n".join(f"  {name} = {_shown(value)}" for name, value in whole_state(self._simulation.engine).items())

    def _perform(self, event: str, data: dict[str, object]) -> str:
        try:
            self._simulation.data.check(event, data)
            happened = self._simulation.perform(event, data)
        except DataError as error:
            return f"{event}: {error}{f' ({error.hint})' if error.hint else ''}"
        if happened.by is not None:
            return self._reason(event, happened.by)
        if event == REFUSE:
            return event
        return "\n".join([self._named[event], *self._changes()])

    def _changes(self) -> list[str]:
        """Return the values that differ from the state shown last."""
        old, self._shown = self._shown, whole_state(self._simulation.engine)
        return [f"  {name} = {_shown(value)}" for name, value in self._shown.items() if old[name] != value]

    def _disabled(self) -> str:
        engine = self._simulation.engine
        blocked = ((event, engine.blocked_by(event)) for event in engine.events)
        return "\n".join(self._reason(event, by) for event, by in blocked if by is not None) or "every event can happen"

    def _reason(self, event: str, by: Blocked | Unreadable) -> str:
        named = event if isinstance(by, Unreadable) else self._named.get(event, event)
        return f"{named}: {self._simulation.reason(event, by)}"

    def _undo(self) -> str:
        undone = self._simulation.undo()
        if undone is None:
            return "nothing to undo"
        return "\n".join([f"undone: {self._named[undone.event]}", *self._changes()])

    def _run(self, rest: str) -> str:
        number = _number(rest or "1")
        if number is None:
            return f"{rest[:20]} is not a number of events up to {MOST_AT_ONCE}"
        lines = []
        for _ in range(number):
            happened = self._simulation.random_step(self._random)
            if happened is None:
                lines.append("no event can happen any more")
                break
            lines.append(self._named[happened.event])
        return "\n".join([*lines, *self._changes()])

    def _save(self, file: str) -> str:
        if not file:
            return "missing file: save FILE"
        write_file(file, "".join(f"{trace_line(happened)}\n" for happened in self._simulation.trace))
        return f"{len(self._simulation.trace)} events in {file}"

    def _load(self, file: str) -> str:
        if not file:
            return "missing file: load FILE"
        engine = self._simulation.engine
        text = files.read(file, is_input=False).decode()
        steps, findings = read_script(file, text, engine.events, model=engine.model)
        if findings:
            return _complaints(findings)
        return "\n".join(self._perform(step.event, dict(step.data)) for step in steps)

    def _quit(self, _: str) -> str:
        self.ended = True
        return ""


def _number(text: str) -> int | None:
    """Return the number that a text stands for; None if it is none, or more than `MOST_AT_ONCE`."""
    if not text.isdecimal() or len(text) > len(str(MOST_AT_ONCE)):
        return None
    number = int(text)
    return number if number <= MOST_AT_ONCE else None


def trace_line(happened: RequestResult) -> str:
    """Return an event as a line for scripts and `load`: the event log's shape, without time and direction."""
    line: dict[str, object] = {"event": happened.event}
    if happened.data:
        line["data"] = dict(happened.data)
    return json.dumps(line)


def _complaints(findings: Sequence[Diagnostic]) -> str:
    return "\n".join(f"{finding.message}{f' ({finding.hint})' if finding.hint else ''}" for finding in findings)


def _shown(value: object) -> str:
    return json.dumps(value) if isinstance(value, bool) else str(value)
