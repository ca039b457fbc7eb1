"""The world has all connections of a scenario's controller (thesis, tables 6.1 to 6.7), with the same types."""

from __future__ import annotations

import pytest

from examples.simulator.engine import load, model_of
from examples.simulator.scenarios import SCENARIOS
from examples.simulator.simulation import Simulation


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_topic_is_there(name: str) -> None:
    simulation = Simulation(SCENARIOS[name])
    graph = load(model_of(SCENARIOS[name])).rosgraph
    wanted = [
        (simulation.says, [(subscription.topic, subscription.interface) for subscription in graph.subscriptions]),
        (simulation.hears, [(publisher.topic, publisher.interface) for publisher in graph.publishers]),
        (simulation.serves, [(client.identifier, client.interface) for client in graph.actionClients]),
    ]
    assert sum(len(connections) for _, connections in wanted) >= 5
    for offered, connections in wanted:
        for topic, interface in connections:
            assert offered[topic] == f"{interface.package}/{interface.type}"
