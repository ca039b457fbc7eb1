"""Runs of scenarios without a middleware, each played once, and what they must show."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from examples.simulator.engine import play
from examples.simulator.playing import over
from examples.simulator.scenarios import SCENARIOS
from examples.simulator.simulation import Simulation

Entry = Mapping[str, Any]


@dataclass(frozen=True)
class Run:
    """A simulation that is over, and what its controller logged."""

    simulation: Simulation
    log: Sequence[Entry]

    @property
    def record(self) -> Sequence[Entry]:
        return self.simulation.record


def played(name: str, seed: int = 0, **changes: Any) -> Run:
    """A run of a scenario from start to end; `changes` are those of `examples.simulator.engine.play`."""
    simulation = Simulation(SCENARIOS[name], seed)
    log = play(simulation, over(simulation), quiet=True, **changes)
    return Run(simulation, log)


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


def moved_while_stopped(record: Sequence[Entry], allowance: float) -> float:
    """How far the robot got, or turned in radians, at most, from so many seconds after a stop until continue."""
    most = 0.0
    for stop, go in zip(times_of(record, "/stop"), times_of(record, "/continue"), strict=True):
        stood = poses(record, stop + allowance, go)
        assert len(stood) > 3, "stopped for too short a time to tell"
        first = stood[0]
        for pose in stood:
            away = math.hypot(pose["x"] - first["x"], pose["y"] - first["y"])
            most = max(most, away, abs(pose["heading"] - first["heading"]))
    return most
