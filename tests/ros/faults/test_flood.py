"""2,000 messages a second for two seconds, or `ROBOSC_FLOOD_SECONDS`. `benchmarks/flood.py` runs for a minute."""

from __future__ import annotations

import logging
import os
from itertools import pairwise
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.ros.faults.partners import Scout

RATE = 2000
SECONDS = int(os.environ.get("ROBOSC_FLOOD_SECONDS", "2"))
#: On a busy machine a node may process the messages late.
PATIENCE = SECONDS + 240


@pytest.fixture
def scout(patient: Scout) -> Scout:
    return patient


def test_flood(scout: Scout) -> None:
    server = scout.serve()
    since, number = scout.now(), RATE * SECONDS
    scout.world.do("flood", topic="/pulse", hz=RATE, count=number)
    scout.nothing(2.0)
    memory = scout.memory()
    # The node receives everything else during the flood: an answer, a result, and each message of the other topics.
    server.do("answer_at_once", fields={"success": True, "message": "seen"})
    server.do("accept_at_once", accept=True, succeed=True)
    scout.send("/light", data=True)
    scout.send("/travel_order", data=True)
    # The first stop would cancel the goal.
    scout.until_state("Navigator", "arrived", PATIENCE)
    for count in range(1, 6):
        scout.send("/stop")
        scout.until_event(since, "message_stop.u_response", count, PATIENCE)
        scout.send("/continue")
        scout.until_event(since, "message_continue.u_response", count, PATIENCE)
    scout.until_state("Lamp", "lit", PATIENCE)
    assert scout.world.wait("sent", since.world, seconds=PATIENCE)["count"] == number
    scout.until(lambda: scout.variable("Encoder", "last") == number, "the last one arrives", seconds=PATIENCE)

    def logged() -> list[int]:
        return [entry["data"]["value"] for entry in scout.events(since, "message_pulse.u_response")]

    # A report may arrive before the log lines of its tick.
    scout.until(lambda: logged()[-1:] == [number], "the log tells of the last one", seconds=PATIENCE)
    grown = scout.memory() - memory
    received = logged()
    assert all(earlier < later for earlier, later in pairwise(received))
    assert scout.variable("Encoder", "pulses") == len(received)
    assert scout.variable("Encoder", "total") == sum(received)
    if scout.version == 2:
        assert received == list(range(1, number + 1))
    else:
        # ROS 1 drops the oldest messages of a topic with a full queue of ten; their number depends on the machine.
        assert len(received) > number / 20
    assert len(scout.events(since, "message_stop.u_response")) == 5
    assert grown < 10
    logging.info("%d of %d received; %.0f MB, then %+.1f MB", len(received), number, memory, grown)
