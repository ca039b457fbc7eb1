"""An action whose server is absent, dies, is late; a goal that comes to nothing; a goal that is given up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.ros.faults.partners import Moment, Peer, Scout

TRIGGER, RESPONSE, FEEDBACK, ERROR, CANCEL = (
    f"action_travel.{each}" for each in ("c_trigger", "u_response", "u_feedback", "u_error", "c_cancel")
)
#: Seconds, as `controller-config.json` has them; and what a busy machine may add.
TIMEOUT, RETRY, SLACK = 1.0, 0.4, 1.5


@pytest.fixture
def server(scout: Scout) -> Peer:
    """The server; every goal that the test leaves behind is over afterwards."""
    return scout.serve()


def test_absent_at_start(scout: Scout) -> None:
    scout.dismiss_server()
    since = scout.now()
    scout.send("/travel_order", data=True)
    scout.until_event(since, ERROR, count=2)
    assert scout.says(since, "/travel: no server within 1000 ms") == 1
    assert scout.longest_pause(since) < TIMEOUT - 0.1
    steps = [each for each in scout.log(since) if each["event"].startswith("action_travel")]
    assert [each["event"] for each in steps[:4]] == [TRIGGER, ERROR, "action_travel.c_reset", TRIGGER]
    assert steps[1]["time"] - steps[0]["time"] < TIMEOUT + SLACK
    assert RETRY - 0.01 < steps[2]["time"] - steps[1]["time"] < RETRY + SLACK
    scout.serve(succeed=True)
    arrive_sometime(scout)


def test_feedback(scout: Scout, server: Peer) -> None:
    _, number = travel(scout, server)
    server.do("progress", number=number, fields={"distance_remaining": 2.5})
    scout.until(lambda: scout.variable("Navigator", "distance") == 2.5, "feedback arrives")
    succeed(scout, server, number)


def test_goal_rejected(scout: Scout, server: Peer) -> None:
    since, number = travel(scout, server, accept=False)
    error = scout.until_event(since, ERROR)
    assert error["time"] - scout.events(since, TRIGGER)[0]["time"] < TIMEOUT
    scout.until_says(since, "/travel: rejected")
    succeed(scout, server, number + 1)


@pytest.mark.parametrize(
    ("how", "text"), [("aborted", "/travel: aborted"), ("cancelled", "/travel: cancelled by someone else")]
)
def test_goal_ends_otherwise(scout: Scout, server: Peer, how: str, text: str) -> None:
    since, number = travel(scout, server)
    scout.until_state("Navigator", "travelling")
    server.do("end", number=number, how=how)
    scout.until_event(since, ERROR)
    scout.until_says(since, text)
    assert scout.events(since, RESPONSE) == scout.events(since, CANCEL) == []
    succeed(scout, server, number + 1)


def test_accepted_late(scout: Scout, server: Peer) -> None:
    since, number = travel(scout, server, accept=None)
    error = scout.until_event(since, ERROR)
    assert TIMEOUT - 0.1 < error["time"] - scout.events(since, TRIGGER)[0]["time"] < TIMEOUT + SLACK
    scout.until_says(since, "/travel: not accepted within 1000 ms")
    assert scout.longest_pause(since) < TIMEOUT - 0.1
    # The goal may still begin; so there is no other before it has ended.
    scout.nothing(RETRY + 0.4)
    assert len(scout.events(since, TRIGGER)) == 1
    heard = len(server.said) if scout.version == 2 else 0
    server.do("decide", number=number, accept=True)
    server.wait("cancel", heard, value=number)
    succeed(scout, server, number + 1)
    assert len(scout.events(since, ERROR)) == 1


def test_result_after_cancel(scout: Scout, server: Peer) -> None:
    server.do("on_cancel", answer="ignore")
    since, number = travel(scout, server)
    scout.until_state("Navigator", "travelling")
    scout.send("/travel_order", data=False)
    scout.until_event(since, CANCEL)
    server.wait("cancel", value=number)
    # It goes on, and nobody listens to it; another goal waits for its end.
    server.do("progress", number=number, fields={"distance_remaining": 9.0})
    scout.until_state("Navigator", "home")
    scout.send("/travel_order", data=True)
    scout.nothing(0.5)
    assert len(scout.events(since, TRIGGER)) == 1
    server.do("end", number=number, how="succeeded")
    second = server.wait("goal", value=number + 1)["goal"]
    assert scout.events(since, RESPONSE) == scout.events(since, FEEDBACK) == scout.events(since, ERROR) == []
    succeed(scout, server, second)


def test_cancelled_before_acceptance(scout: Scout, server: Peer) -> None:
    since, number = travel(scout, server, accept=None)
    scout.send("/travel_order", data=False)
    scout.until_event(since, CANCEL)
    server.do("decide", number=number, accept=True)
    server.wait("cancel", value=number)
    scout.until_state("Navigator", "home")
    scout.send("/travel_order", data=True)
    succeed(scout, server, number + 1)
    assert scout.events(since, ERROR) == []
    assert len(scout.events(since, RESPONSE)) == 1


def test_cancel_refused(scout: Scout, server: Peer) -> None:
    server.do("on_cancel", answer="refuse")
    since, number = travel(scout, server)
    scout.until_state("Navigator", "travelling")
    scout.send("/stop")
    scout.until_event(since, CANCEL)
    server.wait("cancel", value=number)
    if scout.version == 2:
        # A server of ROS 1 can't refuse, it can only go on.
        scout.until_says(since, "/travel: the server refuses to cancel the goal")
    server.do("end", number=number, how="succeeded")
    scout.nothing(0.3)
    assert scout.events(since, RESPONSE) == scout.events(since, ERROR) == []


def test_dies_with_the_goal(scout: Scout, server: Peer) -> None:
    since, _ = travel(scout, server)
    scout.until_state("Navigator", "travelling")
    scout.kill_server()
    scout.until_event(since, ERROR, seconds=30)
    scout.until_says(since, "/travel: the server is gone")
    assert scout.longest_pause(since) < TIMEOUT - 0.1
    scout.serve(succeed=True)
    arrive_sometime(scout)


@pytest.mark.usefixtures("server")
def test_comes_back_between_two_goals(scout: Scout) -> None:
    scout.kill_server()
    since = scout.now()
    scout.serve(succeed=True)
    scout.send("/travel_order", data=True)
    arrive_sometime(scout)
    assert scout.says(since, "/travel: the server is gone") == 0


def travel(scout: Scout, server: Peer, accept: bool | None = True) -> tuple[Moment, int]:
    """Has the robot set off; when that began, and the number of its goal. `accept`: None leaves the goal waiting."""
    since, heard = scout.now(), len(server.said)
    scout.send("/travel_order", data=True)
    goal = server.wait("goal", heard)
    assert goal["data"]["pose"]["pose"]["position"]["x"] == 0.25
    if accept is not None:
        server.do("decide", number=goal["goal"], accept=accept)
    return since, goal["goal"]


def succeed(scout: Scout, server: Peer, number: int) -> None:
    """A goal comes in, or has come, and reaches its end."""
    server.wait("goal", value=number)
    server.do("decide", number=number, accept=True)
    server.do("end", number=number, how="succeeded")
    scout.until_state("Navigator", "arrived")


def arrive_sometime(scout: Scout) -> None:
    """A goal succeeds at a server that is new, perhaps not the first one."""
    # ROS 2 does not tell it from the remains of one before it, nor whether its answers find the node yet: a goal that
    # is sent too soon is lost, which takes 30 s, and one more may be.
    scout.until_state("Navigator", "arrived", seconds=90)
