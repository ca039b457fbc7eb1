"""Unreadable data: its event happens for no component, and none of its data is stored."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robosc.language.configuration import Configuration
from robosc.run.runtime.core.port import GoalOutcome
from tests.run.runtime.fake import Record, World
from tests.searching import examples

if TYPE_CHECKING:
    from collections.abc import Sequence

MISSION = Path(__file__).parent / "mission.rscd"
WATCHED = Configuration.model_validate({"watchdogMs": {"route": 500}, "retryMs": 400})


@pytest.fixture
def world(tmp_path: Path) -> World:
    made = World(MISSION, tmp_path / "events.jsonl", WATCHED)
    made.port.types = {"again": "boolean"}
    made.start()
    made.port.said.clear()
    return made


def pose(x: float, *tags: int) -> Record:
    return Record(x=x, tags=list(tags))


def events(world: World) -> list[dict[str, Any]]:
    world.controller._log.flush()
    return [json.loads(line) for line in world.log.read_text().splitlines()]


def names(world: World) -> list[str]:
    return [line["event"] for line in events(world)]


def component(world: World, name: str) -> dict[str, Any]:
    world.wait(0.1)
    told = [json.loads(text) for topic, text in world.port.told if topic == "state"]
    reported: dict[str, Any] = told[-1]["components"][name]
    return reported


def test_a_message_that_is_too_short_counts_as_not_received(world: World) -> None:
    world.hear("route", name="first", poses=[pose(10.0), pose(11.0), pose(12.0)])
    world.hear("route", name="second", poses=[pose(20.0)])
    planner = component(world, "Planner")["variables"]
    # The other event of the same message still happens.
    assert planner == {"size": "short", "name": "first", "first": 10.0, "second": 11.0, "third": 12.0}
    assert names(world).count("message_length.u_response") == 2
    assert names(world).count("message_route.u_response") == 1
    assert world.port.said == ["/route: there is no element 2 in an array of 1"]


def test_the_event_happens_for_no_component(world: World) -> None:
    world.hear("record")
    # The recorder can read its part, the planner cannot.
    world.hear("route", name="short", poses=[pose(20.0, 7, 8)])
    assert component(world, "Recorder") == {"state": "empty", "variables": {"tag": 0, "routes": 0}}
    # Now the planner can read its part, and the recorder cannot.
    long = [pose(10.0, 7), pose(11.0), pose(12.0)]
    world.hear("route", name="long", poses=long)
    assert component(world, "Recorder") == {"state": "empty", "variables": {"tag": 0, "routes": 0}}
    assert component(world, "Planner")["variables"]["name"] == ""
    assert component(world, "Planner")["variables"]["first"] == 1.0
    world.hear("route", name="long", poses=[pose(10.0, 7, 8), *long[1:]])
    assert component(world, "Recorder") == {"state": "filled", "variables": {"tag": 8, "routes": 1}}
    assert component(world, "Planner")["variables"]["first"] == 10.0


def test_read_is_only_what_the_present_state_needs(world: World) -> None:
    world.hear("toggle")
    world.hear("route", name="empty", poses=[])
    assert component(world, "Planner")["variables"]["name"] == "empty"
    assert world.port.said == []
    assert "data" in next(line for line in events(world) if line["event"] == "message_route.u_response")


def test_an_index_within_an_index(world: World) -> None:
    world.hear("toggle")
    world.hear("record")
    world.hear("route", name="flat", poses=[pose(10.0, 7)])
    assert world.port.said == ["/route: there is no element 1 in an array of 1"]
    world.wait(6)
    world.hear("route", name="none", poses=[])
    assert world.port.said[-1] == "/route: there is no element 0 in an array of 0"
    assert names(world).count("message_route.u_response") == 0


def test_it_is_said_once_in_five_seconds(world: World) -> None:
    def said() -> int:
        return len([text for text in world.port.said if "element" in text])

    for number in range(3):
        world.hear("route", name="short", poses=[pose(20.0)] * (number % 2))
    assert said() == 1
    world.wait(5)
    world.hear("route", name="short", poses=[])
    assert said() == 2


def test_the_log_shows_what_can_be_read(world: World) -> None:
    world.hear("toggle")
    world.hear("route", name="one", poses=[pose(10.0)])
    world.controller.close()
    (line,) = [line for line in events(world) if line["event"] == "message_route.u_response"]
    assert line["data"] == {"value": {"poses": {"0": {"x": 10.0}}, "name": "one"}}


def test_the_watchdog_hears_only_what_is_received(world: World) -> None:
    for _ in range(6):
        world.hear("route", name="short", poses=[])
        world.wait(0.1)
    assert "/route: silent for 500 ms" in world.port.said
    world.hear("toggle")
    world.hear("route", name="short", poses=[])
    assert "/route: speaks again" in world.port.said


def test_an_answer_that_is_too_short_is_an_error(world: World) -> None:
    world.wait(0.15)
    world.port.calls[0].answered(Record(cost=5.0, stops=[]))
    assert component(world, "Visitor") == {
        "state": "planning",
        "variables": {"cost": 1.0, "stop": 0, "next": 0, "failures": 1},
    }
    world.wait(0.2)
    assert len(world.port.calls) == 1
    world.wait(0.3)
    world.port.calls[1].answered(Record(cost=6.0, stops=[]))
    world.wait(0.6)
    # The reason is reported once, and again after a readable answer.
    assert [text for text in world.port.said if "plan" in text] == ["/plan: there is no element 0 in an array of 0"]
    world.port.calls[2].answered(Record(cost=7.0, stops=[3]))
    assert component(world, "Visitor")["variables"] == {"cost": 7.0, "stop": 3, "next": 0, "failures": 2}
    answers = [line for line in events(world) if line["event"].startswith("service_plan.u")]
    assert [answer["event"] for answer in answers] == [*["service_plan.u_error"] * 2, "service_plan.u_response"]
    assert answers[0]["data"] == {"value": {"cost": 5.0}}


def test_feedback_and_results(world: World) -> None:
    world.wait(0.15)
    world.port.calls[0].answered(Record(cost=5.0, stops=[3]))
    world.wait(0.15)
    goal = world.port.goals[0].handlers
    goal.accepted()
    goal.feedback(Record(stops=[1]))
    assert component(world, "Visitor")["variables"]["next"] == 0
    goal.feedback(Record(stops=[1, 2]))
    assert component(world, "Visitor")["variables"]["next"] == 2
    goal.ended(GoalOutcome.SUCCEEDED, Record(stops=[9]), "")
    visitor = component(world, "Visitor")
    assert visitor == {"state": "planned", "variables": {"cost": 5.0, "stop": 3, "next": 2, "failures": 1}}
    assert "/visit: there is no element 1 in an array of 1" in world.port.said
    world.wait(0.45)
    world.port.goals[1].handlers.ended(GoalOutcome.SUCCEEDED, Record(stops=[8, 9]), "")
    assert component(world, "Visitor")["variables"] | {"failures": 0} == {
        "cost": 5.0,
        "stop": 8,
        "next": 9,
        "failures": 0,
    }
    assert "action_visit.c_reset" in names(world)


def needs(following: bool, recorder: str, tags: Sequence[int]) -> bool:
    """Return whether poses with these numbers of tags have all data that this model reads."""
    planner = not following or len(tags) > 2
    return planner and (recorder != "empty" or (len(tags) > 0 and tags[0] > 1))


@pytest.mark.slow
@settings(max_examples=examples(30), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(
        st.one_of(st.sampled_from(("toggle", "record")), st.lists(st.integers(0, 3), max_size=4)),
        min_size=1,
        max_size=30,
    )
)
def test_no_variable_holds_what_an_earlier_message_said(tmp_path: Path, steps: list[str | list[int]]) -> None:
    """All data of a message have its number: after an event, every assigned variable has that number."""
    log = tmp_path / "events.jsonl"
    log.write_text("")
    world = World(MISSION, log).start()
    following, recorder = True, "off"
    expected = {"first": 1, "second": 2, "third": 3, "tag": 0, "routes": 0}
    happened = 0
    for number, step in enumerate(steps, 10):
        if isinstance(step, str):
            world.hear(step)
            following ^= step == "toggle"
            recorder = recorder if step == "toggle" else "empty" if recorder == "off" else "off"
            continue
        world.hear("route", name=str(number), poses=[pose(number, *[number] * tags) for tags in step])
        if needs(following, recorder, step):
            happened += 1
            if following:
                expected |= dict.fromkeys(("first", "second", "third"), number)
            expected |= {"tag": number} if recorder == "empty" else {}
            expected["routes"] += recorder != "off"
            recorder = "filled" if recorder == "empty" else recorder
        world.port.hearing += 1  # a new subscriber receives the state
        planner, kept = component(world, "Planner"), component(world, "Recorder")
        found = planner["variables"] | kept["variables"]
        assert {name: found[name] for name in expected} == expected
        assert (planner["state"], kept["state"]) == ("following" if following else "paused", recorder)
    assert names(world).count("message_route.u_response") == happened
    world.controller.close()
