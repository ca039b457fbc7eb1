"""A laser scan that feeds several enums is one batch: the maze solver never turns on half of it."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import pytest

from examples.simulator.devices import GO_ON, STOP
from examples.simulator.engine import connected, load, model_of
from examples.simulator.scenarios import SCENARIOS
from examples.simulator.simulation import Message, Simulation
from robosc.run.runtime.core.controller import Controller
from tests.scenarios.rules.books import BOOKS
from tests.scenarios.runs import played, run_of

if TYPE_CHECKING:
    from pathlib import Path

    from robosc.model import rosgraph


#: The group shares the runs of the scenarios.
pytestmark = pytest.mark.xdist_group("scenarios")


class HalfSeeing(Controller):
    """A wrong controller, which makes each event of a message a batch of its own."""

    def receive(self, subscription: rosgraph.Subscription, message: Any) -> None:
        for reception in subscription.receptions:
            with self._batch():
                self._receive(reception, subscription.topic, message)
        self._note_received(subscription)


def on_half(log: list[dict[str, Any]]) -> list[str]:
    """Return the violations by commands after only a part of a scan."""
    return [violation for violation in BOOKS["maze_solver"]().violations(log) if "half of a scan" in violation]


@pytest.mark.slow
def test_nothing_is_sent_between_the_events_of_a_scan() -> None:
    assert on_half(run_of("maze_solver").log) == []


@pytest.mark.slow
def test_a_controller_that_breaks_scans_up_is_noticed() -> None:
    assert on_half(played("maze_solver", kind=HalfSeeing).log) != []


@pytest.mark.parametrize(
    ("kind", "turn"), [pytest.param(Controller, "right", id="whole"), pytest.param(HalfSeeing, "left", id="half")]
)
def test_a_corner_that_comes_up_together_with_a_wall_ahead(kind: type[Controller], turn: str, tmp_path: Path) -> None:
    """The whole second scan means a turn to the right. Its first part with the rest of the old scan means the left."""
    simulation = Simulation(SCENARIOS["maze_solver"])
    log = tmp_path / "events.jsonl"
    node = connected(simulation, load(model_of(simulation.scenario)), log, kind)
    along, corner = [5.0] * 360, [5.0] * 360
    # The robot stands because the way ahead is unknown.
    along[0] = math.nan
    for ray in (270, 240, 225):
        along[ray] = 0.5
    corner[0] = 0.3
    corner[225] = 0.5
    simulation.world.steps = 10
    node.work()  # the first tick
    node.take(Message(STOP, {"data": False}))
    node.take(Message(GO_ON, {}))
    for ranges in (along, corner):
        node.take(Message("/scan", {"ranges": ranges}))
        node.work()
    simulation.world.steps = 20
    node.work()
    node.flush()
    events = [json.loads(line)["event"] for line in log.read_text().splitlines()]
    assert [event for event in events if "rotate" in event and event.startswith("message_")] == [
        f"message_rotate_{turn}.c_trigger"
    ]
