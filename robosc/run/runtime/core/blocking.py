"""Reasons why a command cannot be sent in the present state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.model.engine import Origin
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.engine import Engine
    from robosc.model import engine as executed
    from robosc.model import sct

#: Name of each kind of reason in `~/blocked`, in order of precedence.
_KINDS = {Origin.requirement: "requirement", Origin.plants: "state", Origin.synthesis: "synthesis"}
#: Start of the sentence for each kind of reason, and the separator before the texts of the reasons.
_HEADINGS = {
    "requirement": ("forbidden", ": "),
    "state": ("not possible", " in "),
    "synthesis": ("forbidden by synthesis", ": "),
}


@dataclass(frozen=True)
class LoggedReason:
    """Reason on `~/blocked`: a kind, and the texts of that kind."""

    kind: str
    because: Sequence[str]

    def __str__(self) -> str:
        heading, joint = _HEADINGS[self.kind]
        return heading + (joint + ("; " if joint == ": " else ", ").join(self.because) if self.because else "")


class Blocking:
    """Find the reasons: violated requirements, else plants without a transition, else the guards of synthesis."""

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        self._events = {event.name: event for event in engine.executed.events}
        self._conditions: dict[executed.Reason, Callable[[], bool]] = {}

    def reason(self, event: sct.Event) -> LoggedReason:
        """Return why the supervisor does not allow an event now."""
        reasons = self._events[event_name(event)].reasons
        for origin, kind in _KINDS.items():
            texts = [self._text(reason) for reason in reasons if reason.kind == origin and self._applies(reason)]
            if texts:
                return LoggedReason(kind, texts)
        return LoggedReason(kind, ())

    def _applies(self, reason: executed.Reason) -> bool:
        if reason.condition is None:
            return True
        if reason not in self._conditions:
            self._conditions[reason] = self.engine.condition(reason.condition)
        return self._conditions[reason]()

    def _text(self, reason: executed.Reason) -> str:
        location = reason.location
        return reason.text + (location.plant.locations[self.engine.cell(location)].name if location else "")
