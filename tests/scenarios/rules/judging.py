"""What every second opinion shares: an event log is read in the node's own order, so what it finds is exact.

A rule book is written down by hand from a scenario's requirements, without the model. It keeps in plain variables what
the controller has been told and says of each thing that goes out what is wrong with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

Entry = Mapping[str, Any]
#: What is wrong with something that was sent; None: nothing.
Fault = str | None


class RuleBook:
    """Judges one log. `heard` takes what comes in, `sent` judges what goes out, `overdue` what should have by now.

    `replaced` are the velocities that a layer replaces: when it blocks one after it forwarded one, it sends a stop at
    once, and no other until it has forwarded the next.
    """

    replaced: frozenset[str] = frozenset()

    def __init__(self) -> None:
        self.stopped = False
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
                if name in ("stop", "continue"):
                    self.stopped = name == "stop"
                self.heard(name if event == "u_response" else f"{name}.{event}", value)
            elif entry["direction"] == "out":
                name = name if event == "c_trigger" else f"{name}.{event}"
                fault = self.sent(name, value)
                if fault:
                    found.append(f"at {entry['time']:.2f}: {name} with {value}: {fault} ({self.known()})")
        return found

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
