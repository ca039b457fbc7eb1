"""A node that ends while the robot drives, and a node that restarts."""

from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING

import pytest

from tests.ros.faults.partners import PACE, PATIENCE

if TYPE_CHECKING:
    from tests.ros.faults.partners import Peer, Scout


HALT = ("outside", "message_halt.c_trigger")


def under_way(scout: Scout) -> tuple[Peer, int]:
    """Start a goal on a driving robot; return the server and the number of the goal."""
    scout.rest()
    server = scout.serve()
    heard = len(server.said)
    scout.send("/travel_order", data=True)
    number = server.wait("goal", heard)["goal"]
    server.do("decide", number=number, accept=True)
    scout.until_state("Navigator", "travelling")
    return server, number


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_shutdown_while_driving(guarded: Scout, number: signal.Signals) -> None:
    server, goal = under_way(guarded)
    since = guarded.now()
    guarded.until(lambda: PACE in guarded.speeds(since), "it drives")
    os.kill(guarded.process.pid, number)
    assert guarded.process.wait(PATIENCE) == 0
    server.wait("cancel", value=goal)
    guarded.until(lambda: guarded.speeds(since)[-1] == 0.0, "the last command is to halt")
    last = [entry for entry in guarded.log(since) if entry["direction"] in ("out", "outside")][-1]
    assert (last["direction"], last["event"]) == HALT
    assert last["data"] == {"value": {"linear": {"x": 0.0}}}
    assert "Traceback" not in guarded.output()


def test_shutdown_while_the_goal_brakes(guarded: Scout) -> None:
    server, goal = under_way(guarded)
    server.do("on_cancel", answer="ignore")
    os.kill(guarded.process.pid, signal.SIGINT)
    assert guarded.process.wait(PATIENCE) == 0
    server.wait("cancel", value=goal)
    guarded.until_says(None, "/travel: the goal has not ended when this node ends: …")
    server.do("end", number=goal, how="cancelled")


def test_shutdown_while_the_server_refuses(guarded: Scout) -> None:
    if guarded.version == 1:
        pytest.skip("a server of ROS 1 can't refuse a cancel")
    server, goal = under_way(guarded)
    server.do("on_cancel", answer="refuse")
    os.kill(guarded.process.pid, signal.SIGINT)
    assert guarded.process.wait(PATIENCE) == 0
    server.wait("cancel", value=goal)
    guarded.until_says(
        None, "/travel: the goal has not ended when this node ends: the server refuses to cancel the goal"
    )
    server.do("end", number=goal, how="succeeded")


def test_shutdown_before_acceptance(guarded: Scout) -> None:
    guarded.rest()
    server = guarded.serve()
    heard = len(server.said)
    guarded.send("/travel_order", data=True)
    goal = server.wait("goal", heard)["goal"]
    since = guarded.now()
    os.kill(guarded.process.pid, signal.SIGINT)
    # The node waits at most `action_timeout_ms` for the acceptance of the goal, so the decision follows at once.
    guarded.until(lambda: HALT in [(entry["direction"], entry["event"]) for entry in guarded.log(since)], "it stops")
    server.do("decide", number=goal, accept=True)
    server.wait("cancel", heard, value=goal)
    assert guarded.process.wait(PATIENCE) == 0
    assert "Traceback" not in guarded.output()


def test_killed_and_restarted(guarded: Scout) -> None:
    server, _ = under_way(guarded)
    guarded.process.kill()
    assert guarded.process.wait(PATIENCE) == -signal.SIGKILL
    guarded.nothing(0.5)
    dead = guarded.now()
    guarded.nothing(0.5)
    assert guarded.commands(dead) == []
    guarded.restart()
    guarded.until(lambda: guarded.states(dead), "the new node reports")
    # The new node does not know the orders to the old one.
    first = guarded.states(dead)[0]["components"]
    assert first["Navigator"]["state"] == "home"
    assert not any(first["Operator"]["variables"].values())
    guarded.ready()
    server.do("answer_at_once", fields={"success": True, "message": "again"})
    guarded.send("/light", data=True)
    guarded.until_state("Lamp", "lit")
