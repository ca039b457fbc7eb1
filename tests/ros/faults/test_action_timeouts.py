"""An action whose server is absent, dies, or accepts too late."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.ros.faults.partners import MOVE, PATIENCE
from tests.ros.faults.test_actions import ERROR, TRIGGER, travel

if TYPE_CHECKING:
    from tests.ros.faults.partners import Peer, Scout

#: Seconds, as in `controller-config.json`.
TIMEOUT, RETRY = 1.0, 0.4
GONE = "/travel: the server is gone"


@pytest.fixture
def server(scout: Scout) -> Peer:
    """The server, with no open goal of an earlier test."""
    return scout.serve()


def test_absent_at_start(scout: Scout) -> None:
    scout.dismiss_server()
    since = scout.now()
    scout.send("/travel_order", data=True)
    assert scout.until_event(since, ERROR, count=2)["data"] == {"reason": "unavailable"}
    assert scout.says(since, "/travel: no server within 1000 ms") == 1
    assert scout.ticked_between(since, TRIGGER, ERROR)
    steps = [entry for entry in scout.log(since) if entry["event"].startswith("action_travel")]
    assert [step["event"] for step in steps[:4]] == [TRIGGER, ERROR, "action_travel.c_reset", TRIGGER]
    assert steps[1]["time"] - steps[0]["time"] > TIMEOUT - 0.1
    assert steps[2]["time"] - steps[1]["time"] > RETRY - 0.01
    scout.serve(succeed=True)
    arrive_sometime(scout)


def test_accepted_late(scout: Scout, server: Peer) -> None:
    since, number = travel(scout, server, accept=None)
    scout.until_says(since, "/travel: not accepted within 1000 ms")
    # The goal may still begin, so it has not ended, and the node sends no other goal.
    scout.nothing(RETRY + 0.4)
    assert scout.events(since, ERROR) == []
    assert len(scout.events(since, TRIGGER)) == 1
    assert scout.state("Navigator") == "travelling"
    heard = len(server.said) if scout.version == 2 else 0
    server.do("accept_at_once", accept=True, succeed=True)  # for later goals
    server.do("decide", number=number, accept=True)
    server.wait("cancel", heard, value=number)
    error = scout.until_event(since, ERROR)
    assert error["time"] - scout.events(since, TRIGGER)[0]["time"] > TIMEOUT - 0.1
    assert error["data"] == {"reason": "timeout"}
    assert scout.ticked_between(since, TRIGGER, ERROR)
    arrive_sometime(scout)


def test_dies_with_the_goal(scout: Scout, server: Peer) -> None:
    server.do("accept_at_once", accept=True)
    scout.send("/travel_order", data=True)
    scout.until_state("Navigator", "travelling")
    since = scout.now()
    scout.kill_server()
    assert scout.until_event(since, ERROR)["data"] == {"reason": "lost"}
    scout.until_says(since, GONE)
    scout.until_event(since, MOVE)
    scout.serve(succeed=True)
    arrive_sometime(scout)


@pytest.mark.usefixtures("server")
def test_comes_back_between_two_goals(scout: Scout) -> None:
    """The node reports the death of a server only for a goal of that server."""
    scout.kill_server()
    since = scout.now()
    scout.serve(succeed=True)
    assert scout.says(since, GONE) == 0
    scout.send("/travel_order", data=True)
    arrive_sometime(scout)
    # The node may notice the death after it has sent the goal, which is lost then.
    assert scout.says(since, GONE) <= len(scout.events(since, ERROR))


def arrive_sometime(scout: Scout) -> None:
    """Wait until a goal succeeds at a new server; earlier goals may be lost."""
    # ROS 2 does not distinguish the new server from the remains of the old one, and does not report whether the answers
    # of the server reach the node yet. A goal sent too early is lost after 30 s, and so may be the next.
    scout.until_state("Navigator", "arrived", seconds=3 * PATIENCE)
