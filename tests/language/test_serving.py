"""Services and actions that the controller serves: the events that a robot permits, from its text."""

from __future__ import annotations

import pytest

from robosc.engine.control_loop import ControlLoop, Hooks, Settings
from tests.language.second_edition import errors, requirements, running, supervised

DESK = """robot Desk {{
  interface inspection use Fibonacci from example_interfaces
  datatype object Area {{ order: integer(0..5) }}
  datatype object Report {{ sequence: array(integer) }}
  component Arm {{
    outgoing service start with request: none, response: none
    outgoing action inspect with request: Area, response: Report, feedback: Report links inspection
    outgoing message fault with type: none
    behaviour {{
      variable left: integer(0..5) = 0
      {everywhere}
      initial marked state idle {{ on request from inspect if value.order > 1 do left := value.order goto busy }}
      marked state busy {{ {busy} on response from fault goto broken }}
      marked state broken {{ on error to inspect goto idle }}
    }}
  }}
  {outside}
}}"""
SERVICE, ACTION = "service_start", "action_inspect"


def desk(busy: str = "on response to inspect goto idle", everywhere: str = "", outside: str = "") -> str:
    return DESK.format(busy=busy, everywhere=everywhere, outside=outside)


def order(number: int) -> dict[str, int]:
    return {"i_request_order": number}


def test_a_goal_is_accepted_where_a_transition_permits_its_data() -> None:
    engine = running(desk())
    assert engine.enabled(f"{ACTION}.u_request")
    assert not engine.perform(f"{ACTION}.u_request", order(1))
    assert engine.state[ACTION] == "idle"
    assert engine.perform(f"{ACTION}.u_request", order(3))
    assert (engine.state[ACTION], engine.state["component_Arm"]) == ("executing", "busy")
    assert not engine.enabled(f"{ACTION}.u_request")


def test_only_named_answers_are_events() -> None:
    [plant] = [plant for plant in supervised(desk()).plants if plant.name == ACTION]
    assert [event.name for event in plant.events] == ["u_request", "c_response", "c_error"]
    assert [location.name for location in plant.locations] == ["idle", "executing"]
    engine = running(desk())
    engine.perform(f"{ACTION}.u_request", order(2))
    assert engine.enabled(f"{ACTION}.c_response")
    assert not engine.enabled(f"{ACTION}.c_error")
    engine.perform("message_fault.u_response")
    assert not engine.enabled(f"{ACTION}.c_response")
    assert engine.perform(f"{ACTION}.c_error")
    assert engine.state[ACTION] == "idle"


def test_a_client_cancels_where_a_transition_names_the_cancel_or_its_end() -> None:
    for busy in ("on cancel from inspect goto broken", "on canceled to inspect goto idle"):
        engine = running(desk(f"{busy} on response to inspect goto idle"))
        engine.perform(f"{ACTION}.u_request", order(2))
        assert engine.perform(f"{ACTION}.u_cancel")
        assert engine.state[ACTION] == "canceling"
        assert not engine.enabled(f"{ACTION}.u_cancel")
    assert engine.perform(f"{ACTION}.c_canceled")
    assert (engine.state[ACTION], engine.state["component_Arm"]) == ("idle", "idle")


def test_a_service_takes_requests_in_every_state() -> None:
    engine = running(desk(everywhere="on response to start if left > 0"))
    assert engine.perform(f"{SERVICE}.u_request")
    assert engine.state[SERVICE] == "open"
    assert not engine.enabled(f"{SERVICE}.u_request")
    assert not engine.enabled(f"{SERVICE}.c_response")
    engine.perform(f"{ACTION}.u_request", order(2))
    assert engine.perform(f"{SERVICE}.c_response")


def test_a_requirement_restricts_the_response() -> None:
    text = desk(
        everywhere="on response to start",
        outside="requirement start needs Arm.inspect.running requirement response to inspect after request from start",
    )
    assert requirements(text) == [
        "requirement start needs Arm.inspect.running",
        "requirement response to inspect after request from start",
    ]
    engine = running(text)
    engine.perform(f"{SERVICE}.u_request")
    assert not engine.enabled(f"{SERVICE}.c_response")
    engine.perform(f"{ACTION}.u_request", order(2))
    assert engine.enabled(f"{SERVICE}.c_response")
    assert engine.enabled(f"{ACTION}.c_response")


def test_a_request_that_would_violate_a_requirement_is_prevented_before() -> None:
    text = desk(
        everywhere="on response to start",
        outside="requirement never Arm.busy and Arm.start.running requirement start needs Arm.idle",
    )
    assert errors(text) == []
    with pytest.raises(Exception, match="request from"):
        supervised(text)


def test_each_answer_has_its_data() -> None:
    text = desk(
        "on feedback to inspect on response to inspect goto idle",
        outside="""provide inspect with { sequence: [1] } if Arm.busy
                   provide inspect with { sequence: [2] }
                   provide feedback to inspect with { sequence: [3] } if Arm.left > 2""",
    )
    names = [plant.name for plant in supervised(text).plants if plant.name.startswith("data")]
    assert names == ["data_inspect", "data_inspect_feedback"]
    loop = ControlLoop(supervised(text))
    loop.tick()
    loop.begin()
    loop.perform(f"{ACTION}.u_request", order(3))
    loop.end()
    assert loop.state["data_inspect_feedback"] == "d1"
    # Feedback comes before the response, which ends the goal.
    assert loop.state[ACTION] == "idle"


def test_feedback_is_sent_at_once_and_then_in_every_tick() -> None:
    happened: list[str] = []
    loop = ControlLoop(supervised(desk("on feedback to inspect")), Settings(), Hooks(after=happened.append))
    loop.tick()
    loop.begin()
    loop.perform(f"{ACTION}.u_request", order(3))
    loop.end()
    assert happened == [f"{ACTION}.u_request", f"{ACTION}.c_feedback"]
    loop.begin()
    loop.end()
    assert len(happened) == 2
    loop.tick()
    assert happened[2:] == [f"{ACTION}.c_feedback"]


def test_every_waiting_request_is_answered_between_two_ticks() -> None:
    loop = ControlLoop(supervised(desk(everywhere="on response to start")))
    loop.tick()
    for _ in range(3):
        loop.begin()
        assert loop.perform(f"{SERVICE}.u_request")
        loop.end()
        assert loop.state[SERVICE] == "idle"


def test_keywords_stay_names() -> None:
    text = desk().replace("fault", "canceled").replace("Area", "Outgoing")
    engine = running(text)
    assert engine.perform("message_canceled.u_response") is True


def test_wrong_words() -> None:
    assert errors(desk("on error to start on response from inspect goto idle")) == [("result-type", 13)] * 2
