"""Headers that a node fills in, and headers that it leaves to the model."""

from pathlib import Path

import pytest

import robosc
from robosc.model.semantics.messages import parts_with_headers

HERE = Path(__file__).parent
NAVIGATION = HERE.parents[2] / "examples" / "simple_navigation" / "simple_navigation.rscd"


@pytest.mark.parametrize(
    ("model", "name", "parts"),
    [
        (HERE / "porter.rscd", "travel", ["", "pose", "pose.pose", "pose.pose.position"]),
        (HERE / "porter.rscd", "grip", [""]),
        # The model sets this goal's frame itself.
        (NAVIGATION, "navigate", ["", "pose.pose", "pose.pose.orientation", "pose.pose.position"]),
    ],
)
def test_parts(model, name, parts) -> None:
    graph = robosc.to_rosgraph(robosc.load(str(model)))
    clients = [*graph.serviceClients, *graph.actionClients]
    sending = next(client.request for client in clients if client.request.name == name)
    assert [".".join(part) for part in parts_with_headers(sending)] == parts
