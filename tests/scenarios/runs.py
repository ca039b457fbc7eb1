"""Runs of scenarios without a middleware, each executed once, and measures of their results."""

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
    """A finished simulation, and the log of its controller."""

    simulation: Simulation
    log: Sequence[Entry]

    @property
    def record(self) -> Sequence[Entry]:
        return self.simulation.record


def played(name: str, seed: int = 0, until: float | str = "end", **changes: Any) -> Run:
    """Run a scenario from its start; `until` is the argument of `over`, `changes` are those of `play`."""
    simulation = Simulation(SCENARIOS[name], seed)
    log = play(simulation, over(simulation, until), quiet=True, **changes)
    return Run(simulation, log)


def violations_of(name: str, models: Models) -> list[str]:
    """Run a scenario with these models until its rule book finds a fault; return the faults."""
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
    """Return the run of a scenario that the pictures show."""
    return played(name)


def poses(record: Iterable[Entry], start: float = 0.0, end: float = math.inf) -> list[Mapping[str, Any]]:
    """Return the poses of the robot in an interval."""
    return [entry["data"] for entry in record if entry["topic"] == "pose" and start <= entry["time"] < end]


def times_of(record: Iterable[Entry], topic: str) -> list[float]:
    """Return the times of the messages on a topic."""
    return [entry["time"] for entry in record if entry["topic"] == topic]


def stops(record: Iterable[Entry]) -> list[tuple[float, float]]:
    """Return the intervals from a press of the button to the `continue` after its release."""
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
    """Return the largest movement or turn (in radians) of a stopped robot, from `allowance` seconds after the stop on.

    The robot also stands before its first `continue`.
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
