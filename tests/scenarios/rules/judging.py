"""What every second opinion shares: an event log is read in the node's own order, so what it finds is exact.

A rule book is written down by hand from a scenario's requirements, without the model. It keeps in plain variables what
the controller has been told and says of each thing that goes out what is wrong with it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

Entry = Mapping[str, Any]
#: What is wrong with something that was sent; None: nothing.
Fault = str | None
#: Seconds after which a button that says nothing counts as pressed.
BUTTON_PATIENCE = 0.5
#: Seconds by which times in a log may be rounded.
ROUNDING = 0.001
#: Seconds by which a node may notice silence later than it begins to count: it, and its clock, have other things to do.
SLACK = 0.3


class RuleBook:
    """Judges one log. `heard` takes what comes in, `sent` judges what goes out, `overdue` what should have by now.

    `replaced` are the velocities that a layer replaces: when it blocks one after it forwarded one, it sends a stop at
    once, and no other until it has forwarded the next.
    """

    replaced: frozenset[str] = frozenset()
    #: Components that miss a communication: which, and after how many seconds of silence.
    silences: Mapping[str, tuple[str, float]] = {}

    def __init__(self) -> None:
        #: A robot begins stopped, and goes on when somebody says so while the button is known to be released.
        self.stopped = True
        self._released = False
        self._silences = {"EmergencyStop": ("pressed", BUTTON_PATIENCE), **self.silences}
        #: When each of them was heard last that is not yet missed.
        self._heard_at: dict[str, float] = {}
        self._forwarded: set[str] = set()
        self._stop_due: str | None = None
        #: When what is judged was heard or sent.
        self.time = 0.0

    def heard(self, name: str, value: Any) -> None:
        """A communication has brought a value."""

    def sent(self, name: str, value: Any) -> Fault:
        """A communication goes out with a value."""
        raise NotImplementedError

    def overdue(self) -> Fault:
        """What should have gone out before anything else came in."""
        return None

    def awaits(self, name: str) -> None:
        """One of `silences` is heard."""
        self._heard_at[name] = self.time

    def awaits_no(self, name: str) -> None:
        """One of `silences` is no longer expected."""
        self._heard_at.pop(name, None)

    def fell_silent(self, name: str) -> None:
        """One of `silences` is missed."""

    def violations(self, log: Iterable[Entry]) -> list[str]:
        """All that the log shows that must not be."""
        found = []
        for entry in log:
            plant, _, event = entry["event"].partition(".")
            name = plant.partition("_")[2]
            value = entry.get("data", {}).get("value")
            self.time = entry["time"]
            found += (f"at {entry['time']:.2f}: {fault}" for fault in self._replacing(entry["direction"], name, value))
            if entry["direction"] == "in":
                fault = self.overdue()
                if fault:
                    found.append(f"before {entry['time']:.2f}: {fault} ({self.known()})")
                self.awaits(name)
                self._hear_button(name, value)
                self.heard(name if event == "u_response" else f"{name}.{event}", value)
            elif event.startswith("u_after") and name in self._silences:
                fault = self._miss(*self._silences[name])
                if fault:
                    found.append(f"at {entry['time']:.2f}: {fault} ({self.known()})")
            elif entry["direction"] == "out":
                name = name if event == "c_trigger" else f"{name}.{event}"
                fault = self._unmissed() or self.sent(name, value)
                if fault:
                    found.append(f"at {entry['time']:.2f}: {name} with {value}: {fault} ({self.known()})")
        return found

    def _hear_button(self, name: str, value: Any) -> None:
        if name == "pressed":
            self.stopped, self._released = self.stopped or value, not value
        elif name == "continue" and self._released:
            self.stopped = False

    def _miss(self, name: str, patience: float) -> Fault:
        """Something counts as silent from now on; what is wrong with that."""
        early = self.time < self._heard_at.pop(name, -math.inf) + patience - ROUNDING
        if name == "pressed":
            self.stopped, self._released = True, False
        self.fell_silent(name)
        return f"{name} is not silent" if early else None

    def _unmissed(self) -> Fault:
        """What nobody has missed that has long been silent."""
        return first_fault(
            *(
                (self.time > self._heard_at.get(name, math.inf) + patience + SLACK, f"{name} is silent")
                for name, patience in self._silences.values()
            )
        )

    def _replacing(self, direction: str, name: str, value: Any) -> Iterator[str]:
        """What is wrong with the stops that a layer sends in the place of what it blocks."""
        due, self._stop_due = self._stop_due, None
        if direction == "outside":
            if name != due:
                yield f"{name} outside of the supervisor"
            elif value not in (None, velocity(0.0, 0.0)):
                yield f"{name} with {value}: that is no stop"
        elif due:
            yield f"no stop takes the place of {due}"
        if direction == "out" and name in self.replaced:
            self._forwarded.add(name)
        elif direction == "blocked" and name in self._forwarded:
            self._forwarded.remove(name)
            self._stop_due = name

    def known(self) -> str:
        """What the controller knows, for whoever reads a fault."""
        return ", ".join(f"{name}={value!r}" for name, value in vars(self).items() if not name.startswith("_"))


def velocity(linear: float, angular: float) -> dict[str, Any]:
    """A velocity as the log has it."""
    return {"linear": {"x": linear}, "angular": {"z": angular}}


def first_fault(*checks: tuple[bool, str]) -> Fault:
    """The words of the first check that holds."""
    return next((words for wrong, words in checks if wrong), None)
