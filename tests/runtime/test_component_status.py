"""What a node tells on `/diagnostics`, without middleware; on live graphs `tests/ros` looks at it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from robosc.configuration import Configuration
from robosc.configuration.parameters import controller_parameters, layer_parameters
from tests.runtime.fake import World, supervised

if TYPE_CHECKING:
    from robosc.runtime.core.port import ComponentStatus

COURIER = Path(__file__).parents[1] / "m2t" / "cpp" / "courier.rscd"
SCOUT = Path(__file__).parents[1] / "ros" / "faults" / "scout.rscd"


def status(world: World, component: str) -> ComponentStatus:
    return next(reported for reported in world.port.statuses[-1] if reported.component == component)


@pytest.mark.parametrize(
    ("milliseconds", "reports"), [(0, 0), (1, 10), (100, 10), (250, 5), (1000, 1), (86_400_000, 1)]
)
def test_reports_once_in_whole_ticks(tmp_path: Path, milliseconds: int, reports: int) -> None:
    world = World(COURIER, tmp_path / "events.jsonl", diagnostics_ms=milliseconds).start()
    world.wait(1.05)
    assert len(world.port.statuses) == reports


def test_tells_nobody_where_nobody_listens(tmp_path: Path) -> None:
    world = World(COURIER, tmp_path / "events.jsonl")
    world.port.hearing = 0
    world.start().wait(3.0)
    assert world.port.statuses == []


def test_a_configuration_without_it_has_no_parameter() -> None:
    graph = supervised(COURIER)
    for declared in (controller_parameters, layer_parameters):
        names = [parameter.name for parameter in declared(graph, Configuration(diagnostics_ms=0), "")]
        assert "diagnostics_ms" not in names


def test_values_are_texts_as_people_read_them(tmp_path: Path) -> None:
    world = World(COURIER, tmp_path / "events.jsonl", diagnostics_ms=100).start()
    world.port.types = {"ranges": "sequence<float>"}
    world.hear("scan", ranges=[math.nan, 3.0, 3.0, -math.inf], angle_min=1.0)
    world.hear("word", data="\ud800 <b>")
    world.wait(0.15)
    assert status(world, "Scanner").values[:4] == [
        ("state", "looking"),
        ("seen", "far"),
        ("first", "nan"),
        ("before", "-1.5"),
    ]
    assert ("fourth", "-inf") in status(world, "Scanner").values
    assert ("text", "? <b>") in status(world, "Counter").values
    office = dict(status(world, "Office").values)
    assert office["request to target"] == "allowed"
    assert office["request to report"] == "allowed"
    world.hear("count", data=200)
    world.wait(0.1)
    forbidden = [
        "requirement Counter.limited > 100 disables report",
        "requirement report needs Scanner.looking => Counter.limited < 50",
    ]
    assert dict(status(world, "Office").values)["request to report"] == f"forbidden: {'; '.join(forbidden)}"
