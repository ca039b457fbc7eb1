"""Data that is too short, not a number, or out of range: reception, stored values and commands."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from tests.ros.faults.partners import PACE

if TYPE_CHECKING:
    from tests.ros.faults.partners import Moment, Scout


@pytest.fixture
def scout(patient: Scout) -> Scout:
    return patient


def scan(scout: Scout, *ranges: float) -> Moment:
    """Publish only this scan; return the moment from which the node has received no other."""
    scout.world.do("repeat", topic="/scan", fields={"ranges": ranges}, hz=20)
    # Earlier scans may still be on their way or in reaction.
    scout.until_event(scout.now(), "message_view.u_response", count=9)
    scout.until_reported()
    return scout.now()


def test_array_too_short(scout: Scout) -> None:
    before = scout.now()
    since = scan(scout, 1.0)
    scans = scout.variable("Lidar", "scans")
    scout.until_says(before, "/scan: there is no element 1 in an array of 1")
    # A message that the node cannot read does not reset the watchdog.
    scout.until_says(before, "/scan: silent for 500 ms")
    scout.until(lambda: len(scout.speeds(since)) > 5, "the robot drives on")
    assert set(scout.speeds(since)) == {PACE}
    # The same message has two events: this one occurs, the unreadable one does not.
    scout.until_event(since, "message_view.u_response")
    assert scout.events(since, "message_rays.u_response") == []
    assert (scout.variable("Lidar", "pace"), scout.variable("Lidar", "scans")) == (PACE, scans)
    # The node prints the warning at most once in five seconds.
    assert scout.says(before, "/scan: there is no element 1 in an array of 1") == 1


def test_array_empty(scout: Scout) -> None:
    since = scan(scout)
    scout.until(lambda: len(scout.speeds(since)) > 5, "the robot is told to halt")
    assert set(scout.speeds(since)) == {0.0}
    assert scout.variable("Lidar", "front") == "nothing"
    assert scout.variable("Lidar", "pace") == PACE


def test_answer_too_short(scout: Scout) -> None:
    server, since = scout.serve(), scout.now()
    failures = scout.variable("Surveyor", "failures")
    server.do("answer_at_once", fields={"costs": [2.5]})
    scout.send("/survey_order", data=True)
    error = scout.until_event(since, "service_survey.u_error", count=2)
    scout.until_reported()
    assert scout.variable("Surveyor", "low") != 2.5
    assert scout.variable("Surveyor", "failures") > failures
    # The log contains the readable part of the answer, and the reason once.
    assert error["data"] == {"value": {"costs": {"0": 2.5}}, "reason": "unreadable"}
    assert scout.variable("Surveyor", "why") == "unreadable"
    assert scout.says(since, "/survey: there is no element 1 in an array of 1") == 1
    assert scout.events(since, "service_survey.u_response") == []
    server.do("answer_at_once", fields={"costs": [2.0, 3.0]})
    scout.until_state("Surveyor", "done")
    scout.until_reported()
    assert (scout.variable("Surveyor", "low"), scout.variable("Surveyor", "high")) == (2.0, 3.0)


def test_result_too_short(scout: Scout) -> None:
    server, since = scout.serve(), scout.now()
    heard = len(server.said)
    scout.send("/tour_order", data=True)
    for missed in ([7], [4, 5]):
        number = server.wait("goal", heard)["goal"]
        heard = len(server.said)
        server.do("decide", number=number, accept=True)
        server.do("end", number=number, how="succeeded", fields={"missed_waypoints": missed})
        if missed == [7]:
            error = scout.until_event(since, "action_tour.u_error")
            scout.until_reported()
            assert scout.variable("Surveyor", "first") != 7
            assert error["data"] == {"value": {"missed_waypoints": {"0": 7}}, "reason": "unreadable"}
            assert scout.says(since, "/tour: there is no element 1 in an array of 1") == 1
    scout.until_state("Surveyor", "done")
    scout.until_reported()
    assert (scout.variable("Surveyor", "first"), scout.variable("Surveyor", "second")) == (4, 5)


def test_result_of_an_aborted_goal(scout: Scout) -> None:
    """An error carries the result: a condition on a missing element is false, and the node stores no such element."""
    server, since = scout.serve(), scout.now()
    heard = len(server.said)
    scout.send("/tour_order", data=True)
    first, second = (scout.variable("Surveyor", name) for name in ("first", "second"))
    cases = [([], (first, second)), ([7], (7, second)), ([7, 8], (7, 8)), ([9], (7, 8))]
    for count, (missed, kept) in enumerate(cases, start=1):
        number = server.wait("goal", heard)["goal"]
        heard = len(server.said)
        server.do("decide", number=number, accept=True)
        server.do("end", number=number, how="aborted", fields={"missed_waypoints": missed})
        error = scout.until_event(since, "action_tour.u_error", count=count)
        # The log contains the elements that any expression reads.
        shown = {str(index): value for index, value in enumerate(missed)}
        assert error["data"] == ({"value": {"missed_waypoints": shown}} if shown else {}) | {"reason": "aborted"}
        scout.until_reported()
        assert (scout.variable("Surveyor", "first"), scout.variable("Surveyor", "second")) == kept


@pytest.mark.parametrize(
    ("distance", "front", "speed"),
    [(math.nan, "nothing", 0.0), (math.inf, "clear", PACE), (-math.inf, "obstructed", 0.0)],
)
def test_no_number_decides(scout: Scout, distance: float, front: str, speed: float) -> None:
    since = scan(scout, distance, PACE)
    scout.until(lambda: len(scout.speeds(since)) > 5, "the robot is told something")
    assert scout.variable("Lidar", "front") == front
    assert set(scout.speeds(since)) == {speed}


def test_no_number_is_sent(scout: Scout) -> None:
    before = scout.now()
    for pace in (math.nan, math.inf, -math.inf):
        since = scan(scout, 1.0, pace)
        scout.until_event(since, "message_view.u_response", count=8)
        assert scout.speeds(since) == []
        assert scout.events(since, "message_move.c_trigger") == []
    scout.until_says(before, "move is withheld: its linear.x would not be finite")
    scout.until_diagnosed(
        "Platform", "has no states; move is withheld", request_to_move="held back: its data cannot be sent"
    )
    # The node sends the configured command instead, once, although a requirement forbids it.
    assert [entry["event"] for entry in scout.log(before) if entry["direction"] == "outside"] == [
        "message_halt.c_trigger"
    ]


@pytest.mark.parametrize(("sent", "stored"), [(30000, 100), (-32768, 0), (101, 100), (-1, 0), (100, 100), (42, 42)])
def test_out_of_range(scout: Scout, sent: int, stored: int) -> None:
    since = scout.now()
    scout.send("/charge", data=sent)
    scout.until_event(since, "message_charge.u_response")
    scout.until_reported()
    assert scout.variable("Battery", "level") == stored


@pytest.mark.parametrize(("sent", "stored", "cancelled"), [(-7, 0, False), (2, 2, False), (30000, 0, True)])
def test_feedback_out_of_range(scout: Scout, sent: int, stored: int, cancelled: bool) -> None:
    server = scout.serve()
    since, heard = scout.now(), len(server.said)
    scout.send("/travel_order", data=True)
    number = server.wait("goal", heard)["goal"]
    server.do("decide", number=number, accept=True)
    server.do("progress", number=number, fields={"distance_remaining": math.nan, "number_of_recoveries": sent})
    scout.until_event(since, "action_travel.u_feedback")
    if cancelled:
        # The value saturates at 3: the node cancels because of a requirement, and `on canceled` resets the number.
        server.wait("cancel", heard, value=number)
        scout.until_event(since, "action_travel.u_canceled")
    else:
        server.do("end", number=number, how="succeeded")
        scout.until_state("Navigator", "arrived")
    scout.until_reported()
    assert scout.variable("Navigator", "recoveries") == stored
    assert bool(scout.events(since, "action_travel.c_cancel")) is cancelled
