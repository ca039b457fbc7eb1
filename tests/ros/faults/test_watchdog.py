"""A silent sensor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.ros.faults.partners import PACE

if TYPE_CHECKING:
    from tests.ros.faults.partners import Scout


def test_silent_without_watchdog(scout: Scout) -> None:
    since = scout.now()
    scout.send("/charge", data=50)
    scout.nothing(1.0)
    scout.until(lambda: len(scout.speeds(since)) > 10, "the robot drives on")
    assert "/charge: silent" not in scout.output(since)


def test_silent_with_watchdog(scout: Scout) -> None:
    since = scout.now()
    scout.world.do("silence", topic="/scan")
    scout.until_says(since, "/scan: silent for 500 ms")
    still = scout.now()
    scout.nothing(0.7)
    scout.until(lambda: len(scout.speeds(still)) > 5, "the robot drives on")
    assert set(scout.speeds(still)) == {PACE}
    scout.until_diagnosed("Lidar", "looking; /scan is silent")
    scout.until_diagnosed("Platform", "has no states", request_to_move="allowed")
    scout.world.do("repeat", topic="/scan", fields={"ranges": [1.0, PACE]}, hz=20)
    scout.until_says(since, "/scan: speaks again")
    assert scout.says(since, "/scan: silent for 500 ms") == 1
    assert "outside" not in {entry["direction"] for entry in scout.log(since)}


def test_silent_with_watchdog_that_stops(guarded: Scout) -> None:
    scout, server = guarded, guarded.serve()
    scout.rest()
    since, heard = scout.now(), len(server.said)
    scout.send("/travel_order", data=True)
    number = server.wait("goal", heard)["goal"]
    server.do("decide", number=number, accept=True)
    scout.until_state("Navigator", "travelling")
    scout.world.do("silence", topic="/scan")
    scout.until_says(since, "/scan: silent for 500 ms")
    server.wait("cancel", heard, value=number)
    scout.until_says(since, "/travel: canceled by the controller itself, an error to the model")
    assert scout.says(since, "/travel: canceled by someone else") == 0
    # The server may receive the cancel before the node sends its last message.
    scout.until(lambda: [entry for entry in scout.log(since) if entry["direction"] == "outside"], "it sends onShutdown")
    outside = [entry for entry in scout.log(since) if entry["direction"] == "outside"]
    assert [entry["event"] for entry in outside] == ["message_halt.c_trigger"]
    tripped = scout.now()
    # The node sends halt although a requirement forbids it here, and nothing else until the sensor speaks again.
    scout.until(lambda: scout.speeds(since)[-1] == 0.0, "the robot is told to halt")
    halted = scout.now()  # earlier messages have arrived now
    scout.send("/light", data=True)
    scout.nothing(0.7)
    assert [entry["event"] for entry in scout.log(tripped) if entry["direction"] == "out"] == []
    assert scout.speeds(halted) == []
    scout.until_diagnosed("Platform", "has no states", request_to_move="held back: a topic is silent")
    scout.send("/light", data=False)
    scout.send("/travel_order", data=False)
    again = scout.now()
    scout.world.do("repeat", topic="/scan", fields={"ranges": [1.0, PACE]}, hz=20)
    scout.until_says(since, "/scan: speaks again")
    scout.until(lambda: PACE in scout.speeds(again), "the robot drives again")
