"""Each rule of the showcases objects to a recording that violates it, and not earlier."""

from __future__ import annotations

import ast
import inspect
from typing import Any

import pytest

from tests.scenarios.rules import showcases
from tests.scenarios.rules.showcases import SLACK, Sprayer, WarehouseRobot

Log = list[dict[str, Any]]
DONE, REFUSED = {"success": True}, {"success": False}
HOME = {"pose": {"header": {"frame_id": "map"}}}


def heard(name: str, value: Any = None, time: float = 1.0, event: str = "u_response") -> dict[str, Any]:
    return {"time": time, "direction": "in", "event": f"any_{name}.{event}", "data": {"value": value}}


def sent(name: str, value: Any = None, time: float = 1.0, event: str = "c_trigger") -> dict[str, Any]:
    return heard(name, value, time, event) | {"direction": "out"}


def scans(*ranges: float, time: float = 1.0) -> Log:
    return [heard(f"{lidar}_scan", {"ranges": [*ranges]}, time) for lidar in ("Ahead", "Behind")]


def limit(speed: float) -> dict[str, Any]:
    return sent("speed_limit", {"speed_limit": speed})


def with_button(log: Log) -> Log:
    """Prefix a recording with `continue`, and repeat the state of the button in it."""
    pressed, time, found = False, 0.0, Log()
    for entry in [GO_ON, *log]:
        if entry["time"] > time:
            time = entry["time"]
            found.append(heard("pressed", pressed, time))
        if entry["event"] == "any_pressed.u_response":
            pressed = entry["data"]["value"]
        found.append(entry)
    return found


FREE = [*scans(2.0), *(heard(f"{side}_touched", False) for side in ("Front", "Rear", "Left", "Right"))]
IN_DOCK = [*FREE, heard("charge", {"percentage": 0.8})]
ORDERED = [*IN_DOCK, heard("order", {})]
OFF_DOCK = [*ORDERED, sent("undock"), heard("undock", DONE)]
IN_AISLE = [*OFF_DOCK, sent("enter"), heard("enter", DONE)]
UNDER_WAY = [*IN_AISLE, sent("navigate", {})]
ARRIVED = [*UNDER_WAY, heard("navigate")]
AT_SHELF = [*ARRIVED, sent("leave"), heard("leave", DONE)]
SERVED = [*AT_SHELF, sent("raise"), heard("raise", DONE), heard("served")]
HOMEBOUND = [*SERVED, sent("lower"), heard("lower", DONE), sent("enter"), heard("enter", DONE)]
AT_HOME = [*HOMEBOUND, sent("navigate", HOME), heard("navigate"), sent("leave"), heard("leave", DONE)]
GOAL, HALT = (heard("fetch", event=event) for event in ("u_request", "u_cancel"))
CALL = heard("again", event="u_request")
ORDERED_BY_GOAL = [*IN_DOCK, GOAL]
SHELVED = [*ORDERED_BY_GOAL, *AT_HOME[len(ORDERED) :], sent("dock"), heard("dock", DONE)]
TWICE = [sent("dock"), heard("dock", REFUSED), sent("dock", time=6.0), heard("dock", REFUSED, 6.0)]
THRICE = [*TWICE, sent("dock", time=36.0), heard("dock", event="u_error", time=36.0)]
STOP, RELEASED, GO_ON = heard("pressed", True), heard("pressed", False), heard("continue")
GOING = [RELEASED, GO_ON]
CANCELED = [sent("navigate", event="c_cancel"), heard("navigate", event="u_canceled")]
STOPPED = [sent("drive", event="c_cancel"), heard("drive", event="u_canceled")]
AGAIN = sent("navigate", {})

WAREHOUSE = [
    ([*IN_AISLE, STOP], sent("navigate", {}), "stop is pressed"),
    ([*IN_AISLE, heard("Left_touched", True)], sent("navigate", {}), "a bumper is touched"),
    ([*IN_AISLE, *scans(0.4)], sent("navigate", {}), "something is in the way"),
    ([*IN_AISLE, *scans()], sent("navigate", {}), "something is in the way"),
    (IN_AISLE, sent("navigate", {}, 1.6 + SLACK), "a lidar is silent"),
    # Before its departure, the robot would turn back.
    ([*UNDER_WAY, heard("charge", {"percentage": 0.19})], sent("navigate", {}), "out with little power"),
    ([*UNDER_WAY, heard("charge", {"percentage": 0.19})], STOP, "the journey has not been cancelled"),
    ([*UNDER_WAY, STOP], STOP, "the journey has not been cancelled"),
    ([*ORDERED, GOAL], STOP, "a goal was accepted during another mission"),
    (UNDER_WAY, heard("served", time=1.6 + SLACK), "the journey has not been cancelled"),
    ([*FREE, limit(1.0), *scans(1.0)], STOP, "the limit is too high"),
    (UNDER_WAY, sent("navigate", {}), "there is a journey already"),
    (OFF_DOCK, sent("navigate", {}), "nobody has let it into the aisle"),
    ([*ORDERED, heard("enter", DONE)], sent("navigate", {}), "it is in its dock"),
    (ARRIVED, sent("navigate", {}), "it has nowhere to go"),
    ([*IN_AISLE, sent("raise")], sent("navigate", {}), "the shelf is lifted"),
    ([*UNDER_WAY, heard("navigate", event="u_error")], sent("navigate", {}), "it has just failed"),
    (HOMEBOUND, sent("navigate", {"pose": {"header": {"frame_id": "moon"}}}), "that is not home"),
    (IN_AISLE, sent("navigate", event="c_cancel"), "there is no journey"),
    (UNDER_WAY, sent("navigate", event="c_cancel"), "it may go on"),
    (ORDERED, sent("enter"), "it is still in its dock"),
    (AT_SHELF, sent("enter"), "it has nothing to do there"),
    ([*OFF_DOCK, sent("raise")], sent("enter"), "people are there"),
    (IN_AISLE, sent("enter"), "it is there already"),
    ([*OFF_DOCK, sent("enter")], sent("enter"), "it is there already"),
    (OFF_DOCK, sent("leave"), "it is not there"),
    (UNDER_WAY, sent("leave"), "it drives there"),
    # The goal has not ended.
    ([*UNDER_WAY, STOP, CANCELED[0]], sent("leave"), "it drives there"),
    ([*UNDER_WAY, STOP, CANCELED[0], *GOING], sent("navigate", {}), "there is a journey already"),
    ([*UNDER_WAY, STOP, CANCELED[0]], CANCELED[0], "there is no journey"),
    ([*ARRIVED, sent("leave"), heard("order", {})], sent("navigate", {}), "nobody has let it into the aisle"),
    (IN_AISLE, sent("leave"), "it is not yet done there"),
    ([*AT_SHELF, STOP], sent("raise"), "the lift is stopped"),
    (ARRIVED, sent("raise"), "it is among people"),
    (OFF_DOCK, sent("raise"), "it is not below the shelf"),
    ([*AT_SHELF, sent("raise")], sent("raise"), "it is up"),
    ([*SERVED, STOP], sent("lower"), "the lift is stopped"),
    ([*AT_SHELF, heard("raise", REFUSED)], sent("lower"), "it is down"),
    (SERVED[:-1], sent("lower"), "somebody takes something"),
    ([*ORDERED, STOP], sent("undock"), "the dock is stopped"),
    (OFF_DOCK, sent("undock"), "it is off its dock"),
    ([*ORDERED, sent("undock")], sent("undock"), "it leaves its dock already"),
    ([*ORDERED, sent("undock"), STOP], STOP, "the dock moves it on"),
    ([*ORDERED, STOP], sent("undock", event="c_cancel"), "it does not move at its dock"),
    (IN_DOCK, sent("undock"), "nothing is ordered"),
    ([*FREE, heard("charge", {"percentage": 0.25}), heard("order", {})], sent("undock"), "little power"),
    ([*AT_HOME, STOP], sent("dock"), "the dock is stopped"),
    (HOMEBOUND, sent("dock"), "it is not at home"),
    ([*AT_HOME, sent("dock")], sent("dock"), "it docks already"),
    ([*AT_HOME, *THRICE], sent("dock", time=100.0), "nobody was asked"),
    ([*AT_HOME, *TWICE[:2]], sent("dock", time=5.9), "it was refused just now"),
    ([*AT_HOME, *TWICE], sent("dock", time=35.9), "it was refused just now"),
    ([*ORDERED_BY_GOAL, HALT], sent("undock"), "the order is canceled"),
    (IN_DOCK, sent("again", DONE, event="c_response"), "the answer is wrong"),
    ([*SHELVED, CALL], sent("again", REFUSED, event="c_response"), "the answer is wrong"),
    (IN_DOCK, sent("fetch", event="c_response"), "there is no goal"),
    (ORDERED_BY_GOAL, sent("fetch", event="c_response"), "it is not at home"),
    ([*ORDERED_BY_GOAL, HALT], sent("fetch", event="c_response"), "nobody was served"),
    ([*ORDERED_BY_GOAL, HALT], sent("fetch", event="c_error"), "the order was canceled"),
    (SHELVED, sent("fetch", event="c_error"), "the shelf was served"),
    (SHELVED, sent("fetch", event="c_canceled"), "the order was not canceled"),
    (FREE, limit(0.5), "that is no limit"),
    ([*FREE, *scans(1.4)], limit(1.0), "too fast for what is near"),
    (FREE, limit(0.3), "nothing is near"),
]


def place(x: float, y: float = 0.0, time: float = 1.0) -> dict[str, Any]:
    return heard("odometry", {"pose": {"pose": {"position": {"x": x, "y": y}}}}, time)


READY = [heard("heartbeat"), place(0.0), heard("level", 0.5), heard("Left_sprayed", False)]
ROUTE = [*READY, heard("route", {"poses": [{}]})]
AUTOMATIC = [*ROUTE, heard("automatic", True)]
DRIVING = [*AUTOMATIC, sent("drive", {})]
BY_HAND = [*READY, heard("wish", {})]
#: The operator holds the stick during a change of the mode.
HELD = [*READY, heard("automatic", True), heard("wish", {}), heard("automatic", False), heard("wish", {})]

SPRAYER = [
    ([*DRIVING, STOP], STOP, "the journey has not been cancelled"),
    ([*DRIVING, heard("automatic", False)], STOP, "the journey has not been cancelled"),
    ([*DRIVING, place(100.1)], STOP, "the journey has not been cancelled"),
    ([*DRIVING, place(0.0, -40.1)], STOP, "the journey has not been cancelled"),
    (DRIVING, heard("heartbeat", time=1.6 + SLACK), "the journey has not been cancelled"),
    ([*DRIVING, place(0.0, time=2.1 + SLACK)], STOP, "the journey has not been cancelled"),
    (DRIVING, sent("Left_open", False), "that is not what the valve is told"),
    (READY, sent("Left_open", True), "nothing is to be sprayed"),
    (DRIVING, sent("Right_open", True), "nothing is to be sprayed"),
    ([*DRIVING, heard("level", 0.02)], sent("Left_open", True), "nothing is to be sprayed"),
    ([*BY_HAND, place(100.1)], sent("Left_open", True), "nothing is to be sprayed"),
    (DRIVING, sent("Left_shut", False), "that is to be sprayed"),
    (BY_HAND, sent("Left_shut", False), "that is to be sprayed"),
    (DRIVING, sent("obey", {}), "it drives by itself"),
    ([*DRIVING, STOP, STOPPED[0]], sent("obey", {}), "it drives by itself"),
    ([*DRIVING, STOP, STOPPED[0]], sent("halt"), "the wheels are not its own"),
    ([*DRIVING, STOP, STOPPED[0]], STOPPED[0], "there is no journey"),
    ([*BY_HAND, STOP], sent("obey", {}), "the stick does not count"),
    ([*BY_HAND, heard("automatic", True)], sent("obey", {}), "the stick does not count"),
    (BY_HAND, sent("obey", {}, 2.1 + SLACK), "the stick does not count"),
    (HELD, sent("obey", {}), "nobody holds the stick"),
    ([*BY_HAND, STOP, *GOING, heard("wish", {})], sent("obey", {}), "nobody holds the stick"),
    (BY_HAND, sent("obey", {}, 1.4 + SLACK), "nobody holds the stick"),
    (DRIVING, sent("halt"), "the wheels are not its own"),
    (BY_HAND, sent("halt"), "the stick is held"),
    (AUTOMATIC, sent("drive", event="c_cancel"), "there is no journey"),
    (DRIVING, sent("drive", event="c_cancel"), "it may go on"),
    (DRIVING, sent("drive", {}), "there is a journey already"),
    (ROUTE, sent("drive", {}), "it is driven by hand"),
    ([*AUTOMATIC, STOP], sent("drive", {}), "it may not drive there"),
    ([*AUTOMATIC, place(0.0, 40.1)], sent("drive", {}), "it may not drive there"),
    ([*READY, heard("automatic", True)], sent("drive", {}), "the route is at its end"),
    ([*DRIVING, heard("drive")], sent("drive", {}), "the route is at its end"),
    ([*DRIVING, heard("drive", event="u_error")], sent("drive", {}), "it has just failed"),
]
CASES = [(WarehouseRobot, *case) for case in WAREHOUSE] + [(Sprayer, *case) for case in SPRAYER]


@pytest.mark.parametrize(("book", "before", "bad", "words"), CASES)
def test_a_bad_recording_is_noticed(
    book: type[WarehouseRobot | Sprayer], before: Log, bad: dict[str, Any], words: str
) -> None:
    *_, last = book().violations(with_button([*before, bad]))
    assert f": {words} (" in last


@pytest.mark.parametrize(
    ("book", "good"),
    [
        (WarehouseRobot, [*AT_HOME, *THRICE, heard("try_again", time=50.0), sent("dock", time=50.0)]),
        (WarehouseRobot, [*UNDER_WAY, *scans(1.0), scans(0.4)[0], sent("navigate", event="c_cancel"), STOP]),
        (WarehouseRobot, [*FREE, limit(1.0), scans(1.0)[0], limit(0.3), STOP]),
        (Sprayer, [*DRIVING, sent("Left_open", True), sent("Right_shut", False), heard("drive"), sent("halt")]),
        (WarehouseRobot, [*UNDER_WAY, heard("Left_touched", True), *CANCELED, heard("Left_touched", False), AGAIN]),
        (Sprayer, [*DRIVING, STOP, *STOPPED, sent("halt"), sent("Left_shut", False)]),
        (Sprayer, [*BY_HAND, sent("obey", {}), place(100.1), sent("Left_shut", False), sent("obey", {})]),
        (
            Sprayer,
            [*HELD, sent("halt"), heard("heartbeat", time=1.9), heard("wish", {}, 1.9), sent("obey", {}, 1.9)],
        ),
    ],
)
def test_a_good_recording_is_not(book: type[WarehouseRobot | Sprayer], good: Log) -> None:
    assert book().violations(with_button(good)) == []


def test_every_rule_is_tried() -> None:
    tree = ast.parse(inspect.getsource(showcases))
    pairs = [node.elts for node in ast.walk(tree) if isinstance(node, ast.Tuple) and len(node.elts) == 2]
    rules = {
        pair[1].value
        for pair in pairs
        if isinstance(pair[1], ast.Constant)
        and isinstance(pair[1].value, str)
        and not isinstance(pair[0], ast.Constant)
    }
    assert len(rules) > 40
    assert rules == {words for *_, words in CASES}
