"""What every second opinion shares: an event log is read in the node's own order, so what it finds is exact.

A rule book is written down by hand from a scenario's requirements, without the model. It keeps in plain variables what
the controller has been told and says of each thing that goes out what is wrong with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

Entry = Mapping[str, Any]
#: What is wrong with something that was sent; None: nothing.
Fault = str | None


class RuleBook:
    """Judges one log. `heard` takes what comes in, `sent` judges what goes out, `overdue` what should have by now."""

    def __init__(self) -> None:
        self.stopped = False
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
            elif entry["direction"] == "outside":
                found.append(f"at {entry['time']:.2f}: {name} outside of the supervisor")
        return found

    def known(self) -> str:
        """What the controller knows, for whoever reads a fault."""
        return ", ".join(f"{name}={value!r}" for name, value in vars(self).items())


def velocity(linear: float, angular: float) -> dict[str, Any]:
    """A velocity as the log has it."""
    return {"linear": {"x": linear}, "angular": {"z": angular}}


def first_fault(*checks: tuple[bool, str]) -> Fault:
    """The words of the first check that holds."""
    return next((words for wrong, words in checks if wrong), None)
