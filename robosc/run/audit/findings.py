"""Findings of an audit: forbidden commands, violated assumptions, and events that the model does not expect."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.run.runtime.core.json_text import Json

#: Nanoseconds in a second, and in a millisecond.
SECOND, MILLISECOND = 10**9, 10**6
#: Reasons whose causes have values of the message, which differ from one repetition to the next.
_WITH_VALUES = ("data", "range", "limit")


class Kind(StrEnum):
    """Kind of a finding."""

    FORBIDDEN = "forbidden"
    ASSUMPTION = "assumption"
    UNEXPECTED = "unexpected"


@dataclass(eq=False)
class Finding:
    """A finding, and its repetitions until the robot does something else with the same event.

    `name` is the communication, such as `Base.move`; `topic` that of the message, empty in an event log. `reason` is as
    on `~/blocked`, or `limit`; of an unexpected event, `state`, `data`, `range` or `unknown`. `because` gives the
    causes in words. `components` is the state at the first time. `since` has the nanoseconds since the supervisor last
    permitted the command, None if that is unknown or longer than a second ago. `unheard` has the components that decide
    on it and of which the recording had no event yet. `times` are in nanoseconds.
    """

    kind: Kind
    event: str
    name: str
    topic: str
    reason: str
    because: Sequence[str]
    components: Mapping[str, Json]
    since: int | None = None
    unheard: Sequence[str] = ()
    times: list[int] = field(default_factory=list)

    @property
    def key(self) -> tuple[object, ...]:
        """Everything that a repetition has in common with the finding."""
        because = () if self.reason in _WITH_VALUES else tuple(self.because)
        return self.kind, self.event, self.topic, self.reason, because


@dataclass
class Audit:
    """Result of an audit. `start` and `end` are the times of its first and last message, in nanoseconds.

    `commands` counts the judged commands, `tolerated` those that were permitted only shortly before or after, `safe`
    the forbidden ones that the configuration names as safe, `events` those of the robot. `ignored` counts the messages
    for which a component has no transition, by event and state. `unseen` has the parts of the model that the recording
    cannot show, with the reason. `notes` are further limits of the result.
    """

    robot: str
    start: int | None = None
    end: int | None = None
    commands: int = 0
    tolerated: int = 0
    safe: int = 0
    events: int = 0
    findings: list[Finding] = field(default_factory=list)
    ignored: dict[tuple[str, str], int] = field(default_factory=dict)
    unseen: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    _last: dict[str, dict[Kind, Finding]] = field(default_factory=dict)

    def repeats(self, finding: Finding) -> bool:
        """Return whether a finding is a repetition of the last one of its event."""
        last = self._last.get(finding.event, {}).get(finding.kind)
        return last is not None and last.key == finding.key

    def add(self, finding: Finding, time: int) -> Finding:
        """Add a finding of a time. A repetition of the last finding of its event is added to that."""
        known = self._last.setdefault(finding.event, {})
        last = known.get(finding.kind)
        if last is None or last.key != finding.key:
            self.findings.append(finding)
            known[finding.kind] = last = finding
        last.times.append(time)
        return last

    def clear(self, event: str) -> None:
        """Note that an event happened without a finding."""
        self._last.pop(event, None)

    def ignore(self, event: str, state: str) -> None:
        """Count a message that a component ignores in its state."""
        self.ignored[event, state] = self.ignored.get((event, state), 0) + 1

    def note(self, text: str) -> None:
        """Add a note, once."""
        if text not in self.notes:
            self.notes.append(text)

    def seconds(self, time: int) -> float:
        """Return a time in seconds since the start."""
        return (time - (self.start or 0)) / SECOND

    def as_json(self) -> dict[str, Any]:
        """Return the result as an object of `audit.schema.json`."""
        return {
            "robot": self.robot,
            "start": None if self.start is None else self.start / SECOND,
            "end": None if self.end is None else self.end / SECOND,
            "commands": self.commands,
            "tolerated": self.tolerated,
            "safe": self.safe,
            "events": self.events,
            "findings": [self._finding(finding) for finding in self.findings],
            "ignored": [
                {"event": event, "state": state, "count": count} for (event, state), count in self.ignored.items()
            ],
            "unseen": [{"name": name, "why": why} for name, why in self.unseen.items()],
            "notes": self.notes,
        }

    def _finding(self, finding: Finding) -> dict[str, Any]:
        details = {} if finding.since is None else {"permitted_before_ms": round(finding.since / MILLISECOND, 3)}
        return {
            "kind": str(finding.kind),
            "time": finding.times[0] / SECOND,
            "event": finding.event,
            "name": finding.name,
            "topic": finding.topic,
            "reason": finding.reason,
            "because": list(finding.because),
            **details,
            **({"unheard": list(finding.unheard)} if finding.unheard else {}),
            "components": _finite(finding.components),
            "times": [round(self.seconds(time), 6) for time in finding.times],
        }


def _finite(value: Any) -> Any:
    """Return JSON data with null in place of numbers that are not finite."""
    if isinstance(value, Mapping):
        return {name: _finite(inner) for name, inner in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value
