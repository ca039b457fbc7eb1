"""The second opinions themselves: they object to controllers of models that lack something."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from examples.simulator.engine import EXAMPLES, load
from examples.simulator.scenarios import SCENARIOS
from tests.scenarios.rules.books import BOOKS
from tests.scenarios.runs import played

if TYPE_CHECKING:
    from pathlib import Path

#: Something that a model demands, without which its controller goes wrong in the scenario, and what is left instead.
DEMANDS = [
    ("line_follower", " and EmergencyStop.in_service", ""),
    ("line_follower", " and Lidar.free", ""),
    ("simple_navigation", "requirement navigate needs EmergencyStop.in_service", ""),
    ("simple_navigation", "requirement Navigation.recalled disables navigate", ""),
    ("obstacle_navigation", "requirement navigate needs EmergencyStop.in_service", ""),
    ("obstacle_navigation", "Navigation.recoveries > 5", "Navigation.recoveries > 0"),
    ("object_finder", "requirement move needs Lidar.front = front_clear", ""),
    ("object_finder", " and !ObjectDetector.found", ""),
    ("maze_solver", "requirement EmergencyStop.stopped disables { move, rotate_left, rotate_right }", ""),
    ("maze_solver", "Lidar.front = wall_ahead and on_its_way", "on_its_way"),
    ("push_ball", "    EmergencyStop.in_service\n    and !Ball", "    !Ball"),
    ("push_ball", "BallDetector.offset) / 200", "BallDetector.offset) / 250"),
    ("person_follower", " and PersonDetector.detected", ""),
    ("supervised_line_follower", "requirement step needs Lidar.front = clear", ""),
    ("supervised_line_follower", "requirement step needs EmergencyStop.in_service", ""),
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "demand", "instead"), DEMANDS)
def test_a_demand_less_is_noticed(name: str, demand: str, instead: str, tmp_path: Path) -> None:
    text = (EXAMPLES / name / f"{name}.rscd").read_text()
    assert text.count(demand) == 1
    model = tmp_path / f"{name}.rscd"
    model.write_text(text.replace(demand, instead))
    log = played(name, models=load(model)).log
    assert BOOKS[name]().violations(log) != []


def test_every_second_opinion_is_tried() -> None:
    assert {name for name, *_ in DEMANDS} == {*SCENARIOS}
