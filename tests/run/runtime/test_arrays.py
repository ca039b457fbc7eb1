"""Expressions over arrays and doubles in a running controller, and their undefined values."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from tests.run.runtime.fake import Record, World

ARRAYS = Path(__file__).parent / "arrays.rscd"


@pytest.fixture
def world(tmp_path: Path) -> World:
    made = World(ARRAYS, tmp_path / "events.jsonl")
    made.port.types = {"limits": "float64[]", "steps": "int32"}
    made.start()
    made.port.said.clear()
    return made


def variables(world: World) -> dict[str, Any]:
    world.wait(0.1)
    told = [json.loads(text) for topic, text in world.port.told if topic == "state"]
    found: dict[str, Any] = told[-1]["components"]["Lidar"]
    return found


def logged(world: World, event: str) -> list[dict[str, Any]]:
    world.controller._log.flush()
    lines = [json.loads(line) for line in world.log.read_text().splitlines()]
    return [line for line in lines if line["event"] == event]


def scan(world: World, ranges: list[float], first: int, last: int, *obstacles: Record) -> None:
    world.hear("scan", ranges=ranges, first=first, last=last, obstacles=list(obstacles))


def obstacle(distance: float, *tags: int) -> Record:
    return Record(distance=distance, tags=list(tags))


def test_what_is_read_of_a_slice(world: World) -> None:
    """Slices `a[i..j]` include both ends; `min(a)` and `max(a)` skip NaN."""
    scan(world, [0.1, 3.0, math.nan, 2.0, 0.2], 1, 3)
    assert variables(world)["variables"] == {"last": "clear", "nearest": 2.0, "quotient": 2.6, "whole": 0}
    scan(world, [0.1, 3.0, 2.0, 0.4], 1, 3)
    assert variables(world)["variables"]["last"] == "near"


def test_elements_that_are_objects(world: World) -> None:
    """`any r in a: C` and `count r in a: C`, also nested."""
    scan(world, [3.0], 0, 0, obstacle(0.5, 1, 7), obstacle(0.5), obstacle(3.0, 7))
    assert variables(world)["variables"]["last"] == "clear"
    scan(world, [3.0], 0, 0, obstacle(0.5, 1, 7), obstacle(0.5, 7))
    assert variables(world)["variables"]["last"] == "crowded"


@pytest.mark.parametrize(
    ("ranges", "first", "last", "fault"),
    [
        ([1.0, 2.0], 1, 2, "there are no elements 1 to 2 in an array of 2"),
        ([1.0, 2.0], -1, 0, "there are no elements -1 to 0 in an array of 2"),
        ([1.0, 2.0], 1, 0, "there is no number in an array of 0"),
        ([math.nan], 0, 0, "there is no number in an array of 1"),
    ],
)
def test_a_message_that_cannot_be_read_counts_as_not_received(
    world: World, ranges: list[float], first: int, last: int, fault: str
) -> None:
    """A slice past the end and `min` of an empty array cannot be read.

    A throttled warning names topic, index and length.
    """
    before = variables(world)["variables"]
    scan(world, ranges, first, last)
    assert variables(world)["variables"] == before
    assert world.port.said == [f"/scan: {fault}"]
    assert logged(world, "message_scan.u_response") == []
    # The enum's rule does not match, and the message's other event happens.
    assert len(logged(world, "message_ahead.u_response")) == 1


def test_the_log_has_lists_where_any_element_may_be_read(world: World) -> None:
    scan(world, [0.1, 3.0], 1, 1, obstacle(0.5, 7))
    (line,) = logged(world, "message_scan.u_response")
    assert line["data"] == {"value": {"ranges": [0.1, 3.0], "first": 1, "last": 1}}


def test_an_array_literal_is_sent(world: World) -> None:
    """Array literals `[1.0, 0.0]` in provided data."""
    scan(world, [4.0], 0, 0)
    world.wait(0.1)
    assert world.port.sent[-1] == ("/drive", {"limits": [-1.0, 2.6, 4.0], "steps": 3})
    assert logged(world, "message_drive.c_trigger")[-1]["data"] == {"value": {"limits": [-1.0, 2.6, 4.0], "steps": 3}}


def test_provided_data_that_cannot_be_read_is_withheld(world: World) -> None:
    """The command is withheld and reported, as with NaN."""
    world.hear("divide", data=math.nan)
    world.port.sent.clear()
    world.wait(0.3)
    assert world.port.sent == []
    assert {text for text in world.port.said if "withheld" in text} == {"drive is withheld: NaN cannot be rounded"}


def test_an_element_that_is_not_finite_withholds_a_command(world: World) -> None:
    world.hear("divide", data=0.0)
    world.port.sent.clear()
    world.wait(0.3)
    assert world.port.sent == []
    assert set(world.port.said) == {"drive is withheld: its limits would not be finite"}


def test_an_internal_event_waits_until_it_can_be_read(world: World) -> None:
    """Until then it happens for no component, and none of its data is stored."""
    world.hear("divide", data=math.nan)
    world.hear("step")
    assert variables(world)["state"] == "counting"
    assert "component_Lidar.c_tau1: NaN cannot be rounded" in [text for text in world.port.said if "tau" in text]


def test_an_answer_that_cannot_be_read_is_an_error_and_an_error_happens_anyway(world: World) -> None:
    """An unreadable answer of a service or action is an `error`. The unreadable data of an error is not stored."""
    world.wait(0.1)
    world.port.calls[-1].answered(Record(number=math.nan))
    world.wait(0.1)
    assert len(logged(world, "service_dock.u_response")) == 0
    assert len(logged(world, "service_dock.u_error")) == 1
    assert variables(world)["variables"]["whole"] == 0
    assert "/dock: NaN cannot be rounded" in world.port.said
    assert [text for text in world.port.said if "u_error" in text] == []
