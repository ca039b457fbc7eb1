"""Expressions over arrays in scripts: unreadable data blocks the event, and omitted data is not required."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import robosc
from robosc.run.simulation import Simulation

ARRAYS = Path(__file__).parents[2] / "run" / "runtime" / "arrays.rscd"


@pytest.fixture(scope="module")
def simulation() -> Simulation:
    robot = robosc.load(ARRAYS)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    return Simulation(model, robosc.to_rosgraph(robot))


@pytest.mark.parametrize(
    ("data", "accepted"),
    [
        ({"ranges": [1.0, 2.0], "first": 0, "last": 1}, True),
        # A slice past the end, an index below 0 and `min` of an empty array cannot be read.
        ({"ranges": [1.0, 2.0], "first": 0, "last": 2}, False),
        ({"ranges": [1.0, 2.0], "first": -1, "last": 1}, False),
        ({"ranges": [1.0, 2.0], "first": 1, "last": 0}, False),
        # An omitted array, or a slice with omitted bounds, is unknown.
        ({"ranges": [1.0, 2.0]}, True),
        ({"first": 0, "last": 2}, True),
    ],
)
def test_a_script_says_what_comes_in(simulation: Simulation, data: dict[str, Any], *, accepted: bool) -> None:
    happened = simulation.perform("message_scan.u_response", {"value": data})
    assert happened.accepted is accepted
    assert (None if happened.by is None else str(happened.by)) == (None if accepted else "data")


@pytest.mark.parametrize(("ranges", "accepted"), [([2.0, 1.5], "far"), ([2.0, 0.4], "near"), ([], "near")])
def test_a_condition_of_each_number_in_an_array(tmp_path: Path, ranges: list[float], accepted: str) -> None:
    path = tmp_path / "watch.rscd"
    path.write_text(
        """robot Watch { component Lidar {
          outgoing message scan with type: sensor_msgs/LaserScan
          behaviour {
            on response from scan if size(value.ranges) > 0 and all r in value.ranges: r > 0.5 goto far
            on response from scan goto near
            initial marked state unknown {} marked state near {} marked state far {}
          } } }"""
    )
    robot = robosc.load(path)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    watched = Simulation(model, robosc.to_rosgraph(robot))
    assert watched.perform("message_scan.u_response", {"value": {"ranges": ranges}}).accepted
    assert watched.engine.state["component_Lidar"] == accepted


@pytest.mark.parametrize(("numbers", "place"), [([1, 1, 5], "high"), ([1, 1], "low")])
@pytest.mark.parametrize("is_lone", [True, False])
def test_the_whole_array_of_the_only_field(tmp_path: Path, numbers: list[int], place: str, *, is_lone: bool) -> None:
    """The event log has the array alone as the value of such a message."""
    path = tmp_path / "gauge.rscd"
    path.write_text(
        """robot Gauge {
          interface levels use Float64MultiArray from std_msgs
          datatype object Levels { data: array(double) }
          component Tank {
            outgoing message levels with type: Levels links levels
            behaviour {
              on response from levels if any level in value.data: level > 4.0 goto high
              on response from levels goto low
              initial marked state unknown {} marked state low {} marked state high {}
            } } }"""
    )
    robot = robosc.load(path)
    model = robosc.to_sct(robot)
    robosc.synthesize(model)
    tank = Simulation(model, robosc.to_rosgraph(robot))
    assert tank.perform("message_levels.u_response", {"value": numbers if is_lone else {"data": numbers}}).accepted
    assert tank.engine.state["component_Tank"] == place
