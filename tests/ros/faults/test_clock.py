"""Simulated time that stops and jumps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from robosc.model.semantics.definition import TRANSITIONS_KEPT
from tests.ros.faults.conftest import scouting
from tests.ros.faults.partners import MOVE

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from tests.ros.faults.conftest import Controller, Keep
    from tests.ros.faults.partners import Moment, Scout

START = 1000.0
#: Number of messages in one flood.
PORTION = 1000


@pytest.fixture
def simulated(controller: Controller, kept: Keep, tmp_path_factory: pytest.TempPathFactory) -> Scout:
    """A node in simulated time without watchdogs."""
    names = {1: ["watchdog_ms/scan:=0"], 2: ["watchdog_ms.scan:=0", "use_sim_time:=true"]}
    parameters = names[controller.place.ros.version]

    def node() -> AbstractContextManager[Scout]:
        return scouting(controller, tmp_path_factory.mktemp("clock") / "run", *parameters, clock=START)

    return kept("simulated", node)


def ticks(scout: Scout, since: Moment) -> int:
    """Count the ticks in which the node drives."""
    return len(scout.events(since, MOVE))


def jump(scout: Scout, seconds: float) -> None:
    """Set the clock, and wait until the node uses the new time."""
    scout.world.do("clock", seconds=seconds)
    scout.until(lambda: seconds <= scout.log()[-1]["time"] < seconds + 60, "the node knows the time")


def stop(scout: Scout) -> Moment:
    """Stop the clock, and wait until the node no longer ticks; return the moment after that."""

    def nothing_more() -> bool:
        since = scout.now()
        scout.nothing(0.3)
        return ticks(scout, since) == 0

    scout.world.do("clock", seconds=None)
    scout.until(nothing_more, "the node ticks no more")
    return scout.now()


def test_time_of_the_clock(simulated: Scout) -> None:
    jump(simulated, 2 * START)
    since = simulated.now()
    simulated.until(lambda: ticks(simulated, since) > 10, "it ticks")
    times = [entry["time"] for entry in simulated.log(since)]
    assert all(2 * START < time < 2 * START + 60 for time in times)


def test_clock_stands_still(simulated: Scout) -> None:
    since = stop(simulated)
    simulated.nothing(0.7)
    assert ticks(simulated, since) == 0
    # The node still receives messages, and sends reactions at once.
    simulated.world.do("repeat", topic="/scan", fields={"ranges": [0.1]}, hz=20)
    simulated.until_event(since, "message_halt.c_trigger")
    simulated.world.do("clock", seconds=3 * START)
    simulated.rest()


def test_events_while_the_clock_stands_still(simulated: Scout) -> None:
    """The node reports events after the clock continues; of too many events it keeps the last ones."""
    since = stop(simulated)
    pulse = "message_pulse.u_response"

    def arrived() -> list[Any]:
        return [entry["data"]["value"] for entry in simulated.events(since, pulse)]

    # ROS 1 drops messages that a busy node has no room for, but not the last one, so the number of floods varies.
    while len(arrived()) <= TRANSITIONS_KEPT:
        told = simulated.now()
        simulated.world.do("flood", topic="/pulse", hz=2000, count=PORTION)
        simulated.world.wait("sent", told.world)
        simulated.until(lambda: arrived()[-1:] == [PORTION], "the last one arrives")
    simulated.world.do("clock", seconds=6 * START)
    simulated.until(lambda: simulated.states(since), "the node reports")
    reported = max((report["transitions"] for report in simulated.states(since)), key=len)
    assert len(reported) == TRANSITIONS_KEPT
    assert reported.count(pulse) > TRANSITIONS_KEPT / 2
    assert MOVE in reported, "the last ones are kept"


@pytest.mark.parametrize("seconds", [9 * START, 4 * START], ids=["forwards", "backwards"])
def test_clock_jumps(simulated: Scout, seconds: float) -> None:
    simulated.rest()
    jump(simulated, seconds)
    start = simulated.now()
    simulated.until(lambda: ticks(simulated, start) > 20, "it ticks after the jump")
    # The node does not make up for missed ticks: it makes one tick in 50 ms and at most a few late ones.
    times = [entry["time"] for entry in simulated.events(start, MOVE)]
    assert len(times) <= (times[-1] - times[0]) / 0.05 + 3


def test_silent_without_any_watchdog(simulated: Scout) -> None:
    since = simulated.now()
    simulated.world.do("silence", topic="/scan")
    simulated.nothing(1.0)
    simulated.until(lambda: ticks(simulated, since) > 5, "it ticks on")
    assert "silent" not in simulated.output()
