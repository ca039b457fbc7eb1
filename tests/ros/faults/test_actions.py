"""Goals that fail and goals that are canceled, independent of the time for their acceptance."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.ros.faults.conftest import ACCEPTANCE_SECONDS

if TYPE_CHECKING:
    from tests.ros.faults.partners import Moment, Peer, Scout

TRIGGER, RESPONSE, FEEDBACK, ERROR, CANCEL, CANCELED = (
    f"action_travel.{event}" for event in ("c_trigger", "u_response", "u_feedback", "u_error", "c_cancel", "u_canceled")
)


@pytest.fixture
def scout(patient: Scout) -> Scout:
    return patient


@pytest.fixture
def server(scout: Scout) -> Peer:
    """The server, with no open goal of an earlier test."""
    return scout.serve()


def test_feedback(scout: Scout, server: Peer) -> None:
    _, number = travel(scout, server)
    server.do("progress", number=number, fields={"distance_remaining": 2.5})
    scout.until(lambda: scout.variable("Navigator", "distance") == 2.5, "feedback arrives")
    succeed(scout, server, number)


def test_goal_rejected(scout: Scout, server: Peer) -> None:
    since, number = travel(scout, server, accept=False)
    error = scout.until_event(since, ERROR)
    assert error["time"] - scout.events(since, TRIGGER)[0]["time"] < ACCEPTANCE_SECONDS
    assert error["data"] == {"reason": "rejected"}
    scout.until_says(since, "/travel: rejected")
    succeed(scout, server, number + 1)


@pytest.mark.parametrize(
    ("how", "text", "reason"),
    [
        ("aborted", "/travel: aborted", "aborted"),
        ("cancelled", "/travel: canceled by someone else", "canceled"),
        ("open", "/travel: the server has lost the goal", "lost"),
    ],
)
def test_goal_ends_otherwise(scout: Scout, server: Peer, how: str, text: str, reason: str) -> None:
    since, number = travel(scout, server)
    scout.until_state("Navigator", "travelling")
    server.do("end", number=number, how=how)
    assert scout.until_event(since, ERROR)["data"] == {"reason": reason}
    scout.until(lambda: scout.variable("Navigator", "why") == reason, "the reason is kept")
    scout.until_says(since, text)
    assert scout.events(since, RESPONSE) == scout.events(since, CANCEL) == []
    if how == "open":
        server.do("end", number=number, how="succeeded")
    succeed(scout, server, number + 1)


def test_result_after_cancel(scout: Scout, server: Peer) -> None:
    server.do("on_cancel", answer="ignore")
    since, number = travel(scout, server)
    scout.until_state("Navigator", "travelling")
    scout.send("/travel_order", data=False)
    scout.until_event(since, CANCEL)
    server.wait("cancel", value=number)
    # The goal goes on and its feedback arrives; the next goal waits for its end.
    server.do("progress", number=number, fields={"distance_remaining": 9.0})
    scout.until(lambda: scout.variable("Navigator", "distance") == 9.0, "feedback arrives")
    scout.send("/travel_order", data=True)
    scout.until_event(since, "message_travel_order.u_response", count=3)
    scout.nothing(0.5)
    assert len(scout.events(since, TRIGGER)) == 1
    assert scout.state("Navigator") == "stopping"
    server.do("end", number=number, how="succeeded")
    scout.until_event(since, RESPONSE)
    assert scout.events(since, CANCELED) == scout.events(since, ERROR) == []
    scout.until_state("Navigator", "arrived")


def test_canceled_before_acceptance(scout: Scout, server: Peer) -> None:
    since, number = travel(scout, server, accept=None)
    scout.send("/travel_order", data=False)
    scout.until_event(since, CANCEL)
    server.do("decide", number=number, accept=True)
    server.wait("cancel", value=number)
    scout.until_event(since, CANCELED)
    scout.until_state("Navigator", "home")
    scout.send("/travel_order", data=True)
    succeed(scout, server, number + 1)
    scout.until_event(since, RESPONSE)  # a report may arrive before the log lines of its tick
    assert scout.events(since, ERROR) == []
    assert len(scout.events(since, RESPONSE)) == 1


def test_rejected_after_cancel(scout: Scout, server: Peer) -> None:
    """The next goal waits for the end of the rejected one."""
    since, number = travel(scout, server, accept=None)
    scout.send("/travel_order", data=False)
    scout.until_event(since, CANCEL)
    scout.send("/travel_order", data=True)
    scout.until_event(since, "message_travel_order.u_response", count=3)
    server.do("decide", number=number, accept=False)
    succeed(scout, server, number + 1)
    scout.until_event(since, ERROR)
    assert scout.events(since, CANCELED) == []


def test_cancel_refused(scout: Scout, server: Peer) -> None:
    server.do("on_cancel", answer="refuse")
    since, number = travel(scout, server)
    scout.until_state("Navigator", "travelling")
    scout.send("/stop")
    scout.until_event(since, CANCEL)
    server.wait("cancel", value=number)
    if scout.version == 2:
        # A server of ROS 1 can't refuse a cancel; it can only continue the goal.
        scout.until_says(since, "/travel: the server refuses to cancel the goal")
        heard = len(server.said)
        server.wait("cancel", heard, value=number)
        scout.until_diagnosed("Navigator", "stopping; /travel: the server refuses to cancel the goal")
    scout.until_state("Navigator", "stopping")
    server.do("end", number=number, how="succeeded")
    scout.until_event(since, RESPONSE)
    assert scout.events(since, ERROR) == scout.events(since, CANCELED) == []
    if scout.version == 2:
        assert scout.says(since, "/travel: the server refuses to cancel the goal") == 1


def test_other_goal_canceled_by_mistake(scout: Scout, server: Peer) -> None:
    if scout.version == 1:
        pytest.skip("a server of ROS 1 does not answer a request to cancel")
    server.do("on_cancel", answer="mistake")
    since, number = travel(scout, server)
    scout.until_state("Navigator", "travelling")
    scout.send("/stop")
    server.wait("cancel", value=number)
    scout.until_says(since, "/travel: the server refuses to cancel the goal")
    heard = len(server.said)
    server.wait("cancel", heard, value=number)
    server.do("on_cancel", answer="grant")
    scout.until_event(since, CANCELED)
    assert scout.events(since, ERROR) == scout.events(since, RESPONSE) == []


def test_second_server(scout: Scout, server: Peer) -> None:
    if scout.version == 1:
        pytest.skip("nodes of ROS 1 do not look at servers")
    rival = scout.meet("rival")
    since = scout.now()
    rival.do("act", name="/travel", kind="nav2_msgs/NavigateToPose")
    fault = "/travel: /rival and /server serve it: only one answer counts"
    scout.until_says(since, fault)
    scout.until_diagnosed("Navigator", f"home; {fault}")
    # The rejection of this goal is its end, independent of the other goal.
    _, number = travel(scout, server, accept=None)
    scout.send("/travel_order", data=False)
    scout.until_event(since, CANCEL)
    rival.do("decide", number=rival.wait("goal")["goal"], accept=False)
    assert scout.until_event(since, ERROR)["data"] == {"reason": "rejected"}
    server.do("decide", number=number, accept=True)
    server.do("end", number=number, how="succeeded")
    scout.until_diagnosed("Navigator", f"home; {fault}; /travel: rejected")
    assert rival.process.stdin is not None
    rival.process.stdin.close()
    rival.process.wait()
    scout.until_diagnosed("Navigator", "home; /travel: rejected")
    assert scout.says(since, fault) == 1


def travel(scout: Scout, server: Peer, accept: bool | None = True) -> tuple[Moment, int]:
    """Order the robot to set off; return the moment before the order and the number of the goal.

    `accept` decides about the goal; None leaves the goal waiting.
    """
    since, heard = scout.now(), len(server.said)
    scout.send("/travel_order", data=True)
    goal = server.wait("goal", heard)
    assert goal["data"]["pose"]["pose"]["position"]["x"] == 0.25
    if accept is not None:
        server.do("decide", number=goal["goal"], accept=accept)
    return since, goal["goal"]


def succeed(scout: Scout, server: Peer, number: int) -> None:
    """Wait for a goal, and let it succeed."""
    server.wait("goal", value=number)
    server.do("decide", number=number, accept=True)
    server.do("end", number=number, how="succeeded")
    scout.until_state("Navigator", "arrived")
