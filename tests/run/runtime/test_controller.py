"""The controller without middleware: its commands, their times, and its reports."""

from __future__ import annotations

import json
import math
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from robosc.base.files.resources import locate
from robosc.language.configuration import NO_STOP, NO_STOP_ON_SILENCE, Configuration
from robosc.run.runtime.core.port import CancelAnswer, Endpoint, GoalOutcome
from tests.run.runtime.fake import Record, World
from tests.searching import examples

if TYPE_CHECKING:
    from collections.abc import Callable

TESTS = Path(__file__).parents[2]
COURIER = TESTS / "m2t" / "cpp" / "courier.rscd"
SCOUT = TESTS / "ros" / "faults" / "scout.rscd"
LINE = TESTS.parent / "examples" / "line_follower" / "line_follower.rscd"
MAZE = TESTS.parent / "examples" / "maze_solver" / "maze_solver.rscd"

UNANSWERED = "the server does not answer the request to cancel the goal within 5000 ms"
#: A goal that succeeds while it is being canceled.
ENDS = ("c_trigger", "c_cancel", "u_feedback", "u_response", "c_reset")


@pytest.fixture
def courier(tmp_path: Path) -> World:
    world = World(COURIER, tmp_path / "events.jsonl", Configuration(on_shutdown=[]))
    world.port.types = {"ranges": "sequence<float>"}
    return world.start()


def events(world: World) -> list[dict[str, Any]]:
    world.controller._log.flush()
    return [json.loads(line) for line in world.log.read_text().splitlines()]


def sent(world: World, topic: str) -> list[dict[str, Any]]:
    return [data for name, data in world.port.sent if name == topic]


def component(world: World, name: str) -> dict[str, Any]:
    world.wait(0.1)
    told = [json.loads(text) for topic, text in world.port.told if topic == "state"]
    variables: dict[str, Any] = told[-1]["components"][name]["variables"]
    return variables


def test_does_nothing_before_the_first_tick(courier: World) -> None:
    courier.hear("scan", ranges=[0.5, 3.0, 3.0, 7.0], angle_min=1.0)
    courier.wait(0.09)
    assert courier.port.sent == []
    courier.wait(0.02)
    (target,) = sent(courier, "target")
    assert target == {"pose": {"position": {"x": 0.5, "y": -1.5, "z": 13.0}}}


def test_integers_saturate_and_what_is_not_finite_is_withheld(courier: World) -> None:
    courier.port.types = {"data": "uint8"}
    courier.hear("count", data=299)
    assert component(courier, "Counter")["limited"] == 200
    assert component(courier, "Counter")["capped"] == -297
    assert {"data": 255} in sent(courier, "sum")
    courier.hear("count", data=-298)
    assert component(courier, "Counter")["capped"] == 0
    before = len(sent(courier, "ratio"))
    courier.wait(0.5)
    assert len(sent(courier, "ratio")) == before
    assert "ratio is withheld: its data would not be finite" in courier.port.said


def test_integers_of_the_node_saturate_at_64_bits(courier: World) -> None:
    for _ in range(3):
        courier.hear("count", data=2**62)
    assert component(courier, "Counter")["total"] == 2**63 - 1


def test_the_log_has_each_event_with_its_data(courier: World) -> None:
    courier.hear("word", data='idle "ü"')
    courier.hear("scan", ranges=[0.5, 3.0, 3.0, 7.0], angle_min=1.0)
    courier.wait(0.2)
    courier.controller.close()
    told = events(courier)
    validator = Draft202012Validator(json.loads(locate("schemas/event-log.schema.json").read_text()))
    assert not [error for line in told for error in validator.iter_errors(line)]
    data = {line["event"]: line.get("data") for line in told}
    assert data["message_word.u_response"] == {"value": 'idle "ü"'}
    assert data["message_side.u_response"] == {"value": "ahead"}
    assert data["message_detail.u_response"] == {"value": {"ranges": {"0": 0.5, "3": 7.0}}}
    assert data["message_sum.c_trigger"] == {"value": 1.0}


def test_what_one_message_feeds_is_one_batch(tmp_path: Path) -> None:
    # Turning on half a scan would be a command between two events of one message.
    world = World(MAZE, tmp_path / "events.jsonl").start()
    world.wait(0.15)
    subscription = next(topic for topic in world.graph.subscriptions if topic.topic == "/scan")
    batch = [f"message_{reception.name}.u_response" for reception in subscription.receptions]
    assert len(batch) > 1
    for distance in (0.2, 3.0, 0.3, 2.0):
        world.hear("scan", ranges=[distance] * 360)
    world.controller.close()
    names = [line["event"] for line in events(world)]
    starts = [place for place, name in enumerate(names) if name == batch[0]]
    assert len(starts) == 4
    assert all(names[start : start + len(batch)] == batch for start in starts)


@pytest.fixture
def make(tmp_path: Path) -> Callable[..., World]:
    def made(**values: Any) -> World:
        configuration = Configuration.model_validate({"retryMs": 400, "onShutdown": ["halt"], **values})
        world = World(SCOUT, tmp_path / "events.jsonl", configuration)
        world.port.types = {"data": "boolean"}
        return world.start()

    return made


def test_a_service_is_called_again_after_the_retry_time(make: Callable[..., World]) -> None:
    world = make()
    world.hear("light", data=True)
    world.wait(0.15)
    assert len(world.port.calls) == 1
    world.port.calls[0].failed("torn")
    world.wait(0.3)
    assert len(world.port.calls) == 1
    world.wait(0.3)
    assert len(world.port.calls) == 2
    assert [text for text in world.port.said if "lamp" in text] == ["/lamp: the call failed: torn"]
    names = [line["event"] for line in events(world)]
    assert names.index("service_lamp.u_error") < names.index("service_lamp.c_reset")


def travelling(world: World) -> None:
    world.port.types = {}
    world.hear("scan", ranges=[3.0, 0.3])
    world.hear("travel_order", data=True)
    world.wait(0.15)
    world.port.goals[0].handlers.accepted()
    world.event_loop.run_pending()


def test_a_silent_topic_trips_the_watchdog_and_speaking_again_ends_it(make: Callable[..., World]) -> None:
    world = make(watchdogMs={"scan": 500}, watchdogStops=True)
    world.wait(0.45)
    world.hear("scan", ranges=[3.0, 0.3])
    world.wait(0.49)
    assert not any("silent" in text for text in world.port.said)
    world.wait(0.1)
    assert "/scan: silent for 500 ms" in world.port.said
    assert [line for line in events(world) if line["direction"] == "outside"]
    count = len(world.port.sent)
    world.wait(1)
    assert len(world.port.sent) == count
    world.hear("scan", ranges=[3.0, 0.3])
    world.wait(0.2)
    assert "/scan: speaks again" in world.port.said
    assert len(world.port.sent) > count


def test_a_withheld_command_has_something_safe_sent_in_its_place_once(make: Callable[..., World]) -> None:
    """It is sent again if the withheld command was meanwhile disabled or sent."""

    def halted() -> int:
        return len([line for line in events(world) if line["direction"] == "outside"])

    world = make(onWithheld=["halt"])
    world.wait(0.15)
    world.hear("scan", ranges=[3.0, 0.3])
    assert sent(world, "/cmd_vel")[-1]["linear"]["x"] == 0.3
    assert halted() == 0
    world.hear("scan", ranges=[3.0, math.nan])
    world.wait(0.15)
    assert sent(world, "/cmd_vel")[-1]["linear"]["x"] == 0.0
    assert halted() == 1
    count = len(world.port.sent)
    world.wait(1)
    assert (halted(), len(world.port.sent)) == (1, count)
    for front in (0.1, 3.0):
        world.hear("scan", ranges=[front, math.nan])
    assert halted() == 2, "the supervisor had forbidden it in between"
    for pace in (0.3, math.nan):
        world.hear("scan", ranges=[3.0, pace])
        world.wait(0.15)
    assert halted() == 3, "it had been sent in between"
    assert {line["event"] for line in events(world) if line["direction"] == "outside"} == {"message_halt.c_trigger"}


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ({}, [NO_STOP]),
        ({"watchdogStops": True}, [NO_STOP_ON_SILENCE]),
        ({"watchdogStops": True, "onShutdown": []}, [NO_STOP_ON_SILENCE]),
        ({"onShutdown": []}, []),
        ({"watchdogStops": True, "onShutdown": ["halt"]}, []),
    ],
)
def test_says_at_its_start_that_nothing_stops_the_robot(
    values: dict[str, Any], expected: list[str], tmp_path: Path
) -> None:
    world = World(SCOUT, tmp_path / "events.jsonl", Configuration.model_validate(values)).start()
    assert world.port.said == expected


def test_stopping_cancels_goals_then_sends_the_last_messages_and_nothing_more(make: Callable[..., World]) -> None:
    world = make()
    travelling(world)
    count = len(world.port.sent)
    world.controller.stop()
    assert world.port.goals[0].cancels == 1
    assert len(world.port.sent) == count + 1
    assert world.controller.busy
    world.port.goals[0].handlers.ended(GoalOutcome.CANCELED, None, "")
    world.wait(2)
    assert not world.controller.busy
    assert len(world.port.sent) == count + 1
    assert [line["event"] for line in events(world) if line["direction"] == "outside"] == ["message_halt.c_trigger"]


@pytest.mark.parametrize(
    ("case", "report"),
    [
        ((4.0, 6.0, 6.5), "the goal has not ended when this node ends: the server cancels the goal"),
        ((4.0, None, 9.0), f"the goal has not ended when this node ends: {UNANSWERED}"),
        ((None, None, 5.0), "the goal may still begin when this node ends: not accepted within 5000 ms"),
    ],
)
def test_the_end_waits_for_acceptance_then_for_the_answer_to_the_cancel_then_a_little_for_the_end(
    make: Callable[..., World],
    monkeypatch: pytest.MonkeyPatch,
    case: tuple[float | None, float | None, float],
    report: str,
) -> None:
    accepts, cancels, seconds = case
    world = make()
    for module in ("clients", "cancel_requests"):
        steady = SimpleNamespace(monotonic=lambda: world.port.time)
        monkeypatch.setattr(f"robosc.run.runtime.core.{module}.time", steady)
    world.port.types = {}
    world.hear("scan", ranges=[3.0, 0.3])
    world.hear("travel_order", data=True)
    world.wait(0.1)
    (goal,) = world.port.goals
    start = world.port.time
    world.controller.stop()
    while world.controller.busy:
        if world.port.time - start == accepts:
            goal.handlers.accepted()
        if world.port.time - start == cancels:
            goal.handlers.cancel_answered(CancelAnswer.ACCEPTED)
        world.wait(0.125)
    assert world.port.time - start == pytest.approx(seconds, abs=0.3)
    world.controller.close()
    assert world.port.said[-1] == f"/travel: {report}"
    assert goal.cancels >= 1


def test_a_refused_goal_is_canceling_and_the_diagnostics_warn(make: Callable[..., World]) -> None:
    """No other goal is sent before this one ends, whatever the orders. Its feedback and its success happen."""

    def message() -> str:
        return next(status.message for status in world.port.statuses[-1] if status.component == "Navigator")

    world = make(diagnosticsMs=100)
    travelling(world)
    (goal,) = world.port.goals
    world.hear("travel_order", data=False)
    assert goal.cancels == 1
    goal.handlers.cancel_answered(CancelAnswer.REFUSED)
    world.wait(0.3)
    assert message().endswith("; /travel: the server refuses to cancel the goal")
    world.wait(0.3)
    assert goal.cancels == 2, "after retryMs"
    goal.handlers.cancel_answered(CancelAnswer.ACCEPTED)
    world.hear("travel_order", data=True)
    goal.handlers.feedback(Record(distance_remaining=1.5, number_of_recoveries=0))
    world.wait(20)
    assert (message().count(";"), len(world.port.goals), goal.cancels) == (0, 1, 2)
    goal.handlers.ended(GoalOutcome.SUCCEEDED, Record(), "")
    world.wait(0.2)
    told = [line["event"] for line in events(world) if line["event"].startswith("action_travel")]
    assert told == [f"action_travel.{event}" for event in ENDS]


def test_a_goal_that_the_node_itself_cancels_is_canceled_by_the_plant(make: Callable[..., World]) -> None:
    """In `executing` the end is an error, in `canceling` it is `canceled`."""
    world = make(watchdogMs={"scan": 500}, watchdogStops=True)
    travelling(world)
    world.wait(1)
    assert world.port.goals[0].cancels == 1
    world.port.goals[0].handlers.ended(GoalOutcome.CANCELED, None, "")
    world.wait(0.1)
    names = [line["event"] for line in events(world)]
    assert ("action_travel.u_error" in names) != ("action_travel.u_canceled" in names)
    assert ("action_travel.c_cancel" in names) == ("action_travel.u_canceled" in names)


def test_wiring_is_reported_by_name_and_once(make: Callable[..., World]) -> None:
    world = make()
    scan, other = world.graph.subscriptions[0], world.graph.publishers[0]
    fits = Endpoint("/camera", world.port.type_name(scan.interface), "it is best effort")
    world.port.others = {
        scan: [Endpoint("/lidar", "std_msgs/Empty"), fits],
        other: [
            Endpoint("/teleop", world.port.type_name(other.interface)),
            Endpoint("/wheels", "std_msgs/Empty", listens=True),
            Endpoint("/logger", world.port.type_name(other.interface), "it is volatile", listens=True),
        ],
        world.graph.subscriptions[1]: [],
    }
    world.wait(10)
    expected = world.port.type_name(scan.interface)
    assert world.port.said == [
        f"{scan.topic}: /lidar publishes std_msgs/Empty, not {expected}",
        f"{scan.topic}: /camera offers a quality of service that does not fit: it is best effort",
        f"{other.topic}: /teleop publishes it, too",
        f"{other.topic}: /wheels expects std_msgs/Empty, not {world.port.type_name(other.interface)}",
        f"{other.topic}: /logger asks for a quality of service that does not fit: it is volatile",
        f"{world.graph.subscriptions[1].topic}: nobody publishes it after 5 s",
    ]


def test_the_state_is_told_on_change_and_to_whoever_comes(make: Callable[..., World]) -> None:
    world = make()
    assert [topic for topic, _ in world.port.told] == ["definition"]
    world.wait(0.5)
    states = [json.loads(text) for topic, text in world.port.told if topic == "state"]
    validator = Draft202012Validator(json.loads(locate("schemas/state.schema.json").read_text()))
    assert states
    assert not [error for report in states for error in validator.iter_errors(report)]
    world.port.hearing = 0
    count = len(world.port.told)
    world.wait(0.5)
    assert len(world.port.told) == count


_STEPS = st.lists(
    st.tuples(
        st.sampled_from(("light", "order", "scan", "wait", "answer", "fail", "accept", "end")), st.integers(0, 9)
    ),
    max_size=25,
)


@pytest.mark.slow
@settings(max_examples=examples(20), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(steps=_STEPS)
def test_what_goes_out_is_what_is_logged(steps: list[tuple[str, int]], tmp_path: Path) -> None:
    log = tmp_path / "events.jsonl"
    log.unlink(missing_ok=True)
    world = World(SCOUT, log, Configuration.model_validate({"onShutdown": ["halt"]})).start()
    for step, number in steps:
        if step == "light":
            world.hear("light", data=bool(number % 2))
        elif step == "order":
            world.hear("travel_order", data=bool(number % 2))
        elif step == "scan":
            world.hear("scan", ranges=[number / 3] * (number % 4))
        elif step == "wait":
            world.wait(number / 10)
        elif world.port.calls and step in ("answer", "fail"):
            handlers = world.port.calls[-1]
            handlers.answered(Record(message="m", success=True)) if step == "answer" else (handlers.failed(""))
        elif world.port.goals and step == "accept":
            world.port.goals[-1].handlers.accepted()
        elif world.port.goals and step == "end":
            world.port.goals[-1].handlers.ended(list(GoalOutcome)[number % 3], None, "")
        world.event_loop.run_pending()
    world.controller.stop()
    count = len(world.port.sent)
    world.wait(3)
    world.controller.close()
    told = events(world)
    assert len(world.port.sent) == count
    messages = [
        line for line in told if line["direction"] in ("out", "outside") and line["event"].startswith("message")
    ]
    assert len(messages) == count
    assert sum(line["event"] == "action_travel.c_trigger" for line in told) >= len(world.port.goals)
    assert sum(line["event"] == "service_lamp.c_trigger" for line in told) >= len(world.port.calls)
    assert all(goal.cancels <= 2 for goal in world.port.goals)
