"""A service whose server is absent, dies, answers late, or fails."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.ros.faults.partners import Scout

TRIGGER, RESPONSE, ERROR = (f"service_lamp.{event}" for event in ("c_trigger", "u_response", "u_error"))
#: Seconds, as in `controller-config.json`.
TIMEOUT, RETRY = 1.0, 0.4
LIT = {"success": True, "message": "lit"}


def test_absent_at_start(scout: Scout) -> None:
    scout.dismiss_server()
    since = scout.now()
    scout.send("/light", data=True)
    assert scout.until_event(since, ERROR, count=2)["data"] == {"reason": "unavailable"}
    # The node reports each reason once, for any number of attempts.
    assert scout.says(since, "/lamp: no server within 1000 ms") == 1
    assert scout.ticked_between(since, TRIGGER, ERROR)
    scout.until_diagnosed("Lamp", "dark; /lamp: no server within 1000 ms")
    server = scout.serve()
    server.do("answer_at_once", fields=LIT)
    scout.until_state("Lamp", "lit")
    scout.until_diagnosed("Lamp", "lit", request_to_lamp="not possible in Lamp.lit")
    assert scout.variable("Lamp", "answer") == "lit"
    steps = [entry for entry in scout.log(since) if entry["event"].startswith("service_lamp")]
    assert [step["event"] for step in steps[:4]] == [TRIGGER, ERROR, "service_lamp.c_reset", TRIGGER]
    assert steps[1]["time"] - steps[0]["time"] > TIMEOUT - 0.1
    assert steps[2]["time"] - steps[1]["time"] > RETRY - 0.01


def test_server_of_another_type(scout: Scout) -> None:
    if scout.version == 1:
        pytest.skip("ROS 1 has one server for a name")
    scout.dismiss_server()
    impostor = scout.meet("impostor")
    impostor.do("serve", name="/lamp", kind="std_srvs/Trigger")
    since = scout.now()
    fault = "/lamp: /impostor serves std_srvs/srv/Trigger, not std_srvs/srv/SetBool"
    scout.until_says(since, fault)
    scout.send("/light", data=True)
    scout.until_says(since, "/lamp: the server has another type")
    scout.until_diagnosed("Lamp", f"dark; {fault}; /lamp: the server has another type")
    assert impostor.process.stdin is not None
    impostor.process.stdin.close()
    impostor.process.wait()
    scout.serve().do("answer_at_once", fields=LIT)
    scout.until_state("Lamp", "lit")
    scout.until_diagnosed("Lamp", "lit")
    assert scout.says(since, fault) == 1


def test_second_server(scout: Scout) -> None:
    if scout.version == 1:
        pytest.skip("ROS 1 has one server for a name")
    scout.serve()
    rival = scout.meet("rival")
    since = scout.now()
    rival.do("serve", name="/lamp", kind="std_srvs/SetBool")
    fault = "/lamp: /rival and /server serve it: only one answer counts"
    scout.until_says(since, fault)
    scout.until_diagnosed("Lamp", f"dark; {fault}")
    assert rival.process.stdin is not None
    rival.process.stdin.close()
    rival.process.wait()
    scout.until_diagnosed("Lamp", "dark")
    assert scout.says(since, fault) == 1


def test_dies_while_it_answers(scout: Scout) -> None:
    server = scout.serve()
    since = scout.now()
    scout.send("/light", data=True)
    server.wait("called")
    scout.kill_server()
    reason = scout.until_event(since, ERROR)["data"]["reason"]
    texts = {"failed": "/lamp: the call failed", "timeout": "/lamp: no answer within 1000 ms"}
    assert {known: scout.says(since, text) for known, text in texts.items()} == {
        known: known == reason for known in texts
    }
    scout.serve().do("answer_at_once", fields=LIT)
    scout.until_state("Lamp", "lit")


def test_answers_late(scout: Scout) -> None:
    server = scout.serve()
    since, heard = scout.now(), len(server.said)
    scout.send("/light", data=True)
    first = server.wait("called", heard)["called"]
    assert server.wait("called", heard)["data"] == {"data": True}
    error = scout.until_event(since, ERROR)
    assert error["time"] - scout.events(since, TRIGGER)[0]["time"] > TIMEOUT - 0.1
    assert scout.ticked_between(since, TRIGGER, ERROR)
    assert error["data"] == {"reason": "timeout"}
    scout.until_says(since, "/lamp: no answer within 1000 ms")
    # The answer to the first call arrives during the second call and counts for neither.
    server.wait("called", heard, value=first + 1)
    server.do("answer", number=first, fields={"success": True, "message": "first"})
    scout.nothing(0.3)
    assert scout.events(since, RESPONSE) == []
    second = {"success": True, "message": "second"}
    server.do("answer_at_once", fields=second)  # for later calls, if the second one has timed out on a busy machine
    server.do("answer", number=first + 1, fields=second)
    scout.until_state("Lamp", "lit")
    assert scout.variable("Lamp", "answer") == "second"
    scout.until_event(since, RESPONSE)  # a report may arrive before the log lines of its tick
    assert len(scout.events(since, RESPONSE)) == 1


def test_fails(scout: Scout) -> None:
    if scout.version == 2:
        pytest.skip("a service of ROS 2 can't fail")
    server = scout.serve()
    since, heard = scout.now(), len(server.said)
    scout.send("/light", data=True)
    server.do("answer", number=server.wait("called", heard)["called"], fields=None)
    assert scout.until_event(since, ERROR)["data"] == {"reason": "failed"}
    scout.until_says(since, "/lamp: the call failed")
    server.do("answer_at_once", fields=LIT)
    scout.until_state("Lamp", "lit")
