"""Runs of scenarios without a middleware, each played once, and what they must show."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from examples.simulator.devices import GO_ON, STOP
from examples.simulator.engine import connected, play
from examples.simulator.playing import over
from examples.simulator.scenarios import SCENARIOS
from examples.simulator.simulation import Simulation
from tests.scenarios.rules.books import BOOKS

if TYPE_CHECKING:
    from robosc.m2t.models import Models

Entry = Mapping[str, Any]


@dataclass(frozen=True)
class Run:
    """A simulation that is over, and what its controller logged."""

    simulation: Simulation
    log: Sequence[Entry]

    @property
    def record(self) -> Sequence[Entry]:
        return self.simulation.record


def played(name: str, seed: int = 0, until: float | str = "end", **changes: Any) -> Run:
    """A run of a scenario from its start on; `until` is that of `over`, `changes` are those of `play`."""
    simulation = Simulation(SCENARIOS[name], seed)
    log = play(simulation, over(simulation, until), quiet=True, **changes)
    return Run(simulation, log)


def violations_of(name: str, models: Models) -> list[str]:
    """What the rule book of a scenario finds in a run of its world with these models, until it finds anything."""
    simulation, book, found = Simulation(SCENARIOS[name]), BOOKS[name](), list[str]()
    is_over, judged = over(simulation), 0.0
    with TemporaryDirectory() as folder:
        log = Path(folder) / "events.jsonl"
        node = connected(simulation, models, log)
        with log.open(encoding="utf-8") as lines:
            while not found and not is_over():
                for message in simulation.advance():
                    node.take(message)
                node.work()
                if simulation.time >= judged + 5.0 or is_over():
                    judged = simulation.time
                    node.flush()
                    found = book.violations(map(json.loads, lines))
    return found


@cache
def run_of(name: str) -> Run:
    """The run of a scenario, as it is in the pictures."""
    return played(name)


def poses(record: Iterable[Entry], start: float = 0.0, end: float = math.inf) -> list[Mapping[str, Any]]:
    """Where the robot was in a span of time."""
    return [entry["data"] for entry in record if entry["topic"] == "pose" and start <= entry["time"] < end]


def times_of(record: Iterable[Entry], topic: str) -> list[float]:
    """When something was sent to a topic."""
    return [entry["time"] for entry in record if entry["topic"] == topic]


def stops(record: Iterable[Entry]) -> list[tuple[float, float]]:
    """From when to when the robot was stopped: from a press of the button to the `continue` after its release."""
    entries = [entry for entry in record if entry["topic"] in (STOP, GO_ON)]
    found, pressed = list[tuple[float, float]](), None
    for entry in entries:
        if entry["topic"] == GO_ON and pressed is not None:
            found.append((pressed, entry["time"]))
            pressed = None
        elif entry["topic"] == STOP and entry["data"]["data"] and pressed is None:
            pressed = entry["time"]
    return found


def moved_while_stopped(record: Sequence[Entry], allowance: float) -> float:
    """How far the robot got, or turned in radians, at most, from so many seconds after a stop until continue.

    It stands before somebody sets it going, too.
    """
    most = 0.0
    begins = (-allowance, times_of(record, GO_ON)[0])
    pressed = stops(record)
    assert pressed, "nobody has pressed the button"
    for stop, go in [begins, *pressed]:
        stood = poses(record, stop + allowance, go)
        assert len(stood) > 3, "stopped for too short a time to tell"
        first = stood[0]
        for pose in stood:
            away = math.hypot(pose["x"] - first["x"], pose["y"] - first["y"])
            most = max(most, away, abs(pose["heading"] - first["heading"]))
    return most
