"""Base of all rule books. An event log has the node's own order, so its judgment is exact.

A rule book is written by hand from a scenario's requirements, without the model. It stores the inputs of the controller
in plain variables and returns the fault of each command.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

Entry = Mapping[str, Any]
#: Description of a fault in a command, or None.
Fault = str | None
#: Seconds after which a silent button counts as pressed.
BUTTON_PATIENCE = 0.5
#: Rounding error of times in a log, in seconds.
ROUNDING = 0.001
#: Maximum delay in seconds until a node notices silence, because the node and its clock have other work.
SLACK = 0.3


class RuleBook:
    """Judge of one log: `heard` processes inputs, `sent` judges commands, `overdue` reports missing commands.

    `replaced` lists the velocities that a layer replaces. When the layer blocks such a command after it forwarded one,
    it sends a stop at once, and no other stop until it has forwarded the next command.
    """

    replaced: frozenset[str] = frozenset()
    #: Components with a timeout: the communication, and the seconds of silence.
    silences: Mapping[str, tuple[str, float]] = {}

    def __init__(self) -> None:
        #: A robot starts stopped. It goes on at `continue` if the last message of the button was a release.
        self.stopped = True
        self._released = False
        self._silences = {"EmergencyStop": ("pressed", BUTTON_PATIENCE), **self.silences}
        #: Time of the last message of each communication whose timeout has not passed.
        self._heard_at: dict[str, float] = {}
        self._forwarded: set[str] = set()
        self._stop_due: str | None = None
        #: Time of the current entry.
        self.time = 0.0

    def heard(self, name: str, value: Any) -> None:
        """Process the value of an input."""

    def sent(self, name: str, value: Any) -> Fault:
        """Judge the value of a command."""
        raise NotImplementedError

    def overdue(self) -> Fault:
        """Return the fault of a command that is missing before this input."""
        return None

    def awaits(self, name: str) -> None:
        """Restart the timeout of a communication in `silences`."""
        self._heard_at[name] = self.time

    def awaits_no(self, name: str) -> None:
        """End the timeout of a communication in `silences`."""
        self._heard_at.pop(name, None)

    def fell_silent(self, name: str) -> None:
        """Process the timeout of a communication in `silences`."""

    def violations(self, log: Iterable[Entry]) -> list[str]:
        """Return all faults in a log."""
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
        """Process a timeout; return a fault if it is too early."""
        early = self.time < self._heard_at.pop(name, -math.inf) + patience - ROUNDING
        if name == "pressed":
            self.stopped, self._released = True, False
        self.fell_silent(name)
        return f"{name} is not silent" if early else None

    def _unmissed(self) -> Fault:
        """Return the fault of a timeout that is missing."""
        return first_fault(
            *(
                (self.time > self._heard_at.get(name, math.inf) + patience + SLACK, f"{name} is silent")
                for name, patience in self._silences.values()
            )
        )

    def _replacing(self, direction: str, name: str, value: Any) -> Iterator[str]:
        """Yield the faults of the stops that a layer sends in place of blocked commands."""
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
        """Return the knowledge of the controller, for messages."""
        return ", ".join(f"{name}={value!r}" for name, value in vars(self).items() if not name.startswith("_"))


def velocity(linear: float, angular: float) -> dict[str, Any]:
    """Return a velocity in the form of the log."""
    return {"linear": {"x": linear}, "angular": {"z": angular}}


def first_fault(*checks: tuple[bool, str]) -> Fault:
    """Return the text of the first check that holds."""
    return next((words for wrong, words in checks if wrong), None)
