"""Independent rules for the commands of the line follower, written by hand from its requirements."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Entry = Mapping[str, Any]

MOVE = "message_move.c_trigger"
HALT = "message_halt.c_trigger"


@dataclass
class Inputs:
    """The inputs that the controller has received."""

    correction: float | None = None
    clear: bool = False
    stopped: bool = True
    released: bool = False

    @property
    def may_move(self) -> bool:
        return self.correction is not None and self.clear and not self.stopped

    def hear(self, topic: str, data: Any) -> None:
        """Process a message; for a scan, `data` is true if the way is clear."""
        match topic:
            case "correction":
                self.correction = data
            case "no_line":
                self.correction = None
            case "scan":
                self.clear = data
            case "pressed" | "emergency_stop":
                pressed = data["data"] if isinstance(data, Mapping) else data
                self.stopped, self.released = self.stopped or pressed, not pressed
            case "continue":
                self.stopped = self.stopped and not self.released

    def miss(self, component: str) -> None:
        """Process the timeout of a component."""
        match component:
            case "LineDetector":
                self.correction = None
            case "Lidar":
                self.clear = False
            case "EmergencyStop":
                self.stopped, self.released = True, False


def violations(log: Iterable[Entry]) -> list[str]:
    """Return the commands in an event log that violate the rules; the node's own order makes this exact."""
    inputs = Inputs()
    found = []
    for entry in log:
        plant, _, event = entry["event"].partition(".")
        value = entry.get("data", {}).get("value")
        if event == "u_response":
            topic = plant.removeprefix("message_")
            inputs.hear(topic, value == "clear" if topic == "scan" else value)
        elif event.startswith("u_after"):
            inputs.miss(plant.removeprefix("component_"))
        elif entry["event"] == MOVE:
            wanted = {"linear": {"x": 0.2}, "angular": {"z": -(inputs.correction or 0.0) / 100}}
            if not inputs.may_move:
                found.append(f"at {entry['time']}: move, told {inputs}")
            elif value != wanted:
                found.append(f"at {entry['time']}: move with {value} instead of {wanted}")
        elif entry["event"] == HALT and inputs.may_move:
            found.append(f"at {entry['time']}: halt, told {inputs}")
    return found


def commands_in(log: Iterable[Entry]) -> list[tuple[float, float]]:
    """Return the linear and angular speeds of the commands in a log."""
    sent = (entry["data"]["value"] for entry in log if entry["event"] in (MOVE, HALT))
    return [(message["linear"]["x"], message["angular"]["z"]) for message in sent]


def late_moves(record: Sequence[Entry], allowance: float, front: float) -> list[str]:
    """Return moves that the world received although its inputs forbade them for longer than `allowance` seconds.

    The way is clear from a distance of `front` on. The check uses no report of the node. It is not exact, because
    messages take time.
    """
    inputs = Inputs()
    forbidden_since: float | None = 0.0
    found = []
    for entry in record:
        topic, data, time = entry["topic"].removeprefix("/"), entry["data"], entry["time"]
        if topic == "cmd_vel":
            moves = data["linear"]["x"] or data["angular"]["z"]
            if moves and forbidden_since is not None and time - forbidden_since > allowance:
                found.append(f"at {time}: {data}, forbidden since {forbidden_since}")
            continue
        inputs.hear(topic, (data is None or data > front) if topic == "scan" else data)
        if inputs.may_move:
            forbidden_since = None
        elif forbidden_since is None:
            forbidden_since = time
    return found
