"""The supervisory layer without middleware: passed and blocked commands, and its reports."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

from robosc.base.files.resources import locate
from robosc.language.configuration import Configuration
from robosc.language.configuration.parameters import layer_parameters
from robosc.model.semantics.messages import find_message
from robosc.run.runtime.core.cancel_requests import GoalTimes
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.port import Endpoint, Failure, GoalOutcome
from robosc.run.runtime.core.proxies import ActionProxy, ProxiedGoal
from robosc.run.runtime.core.settings import SafeMessages, Settings
from tests.run.runtime.fake import FakePort, Record, supervised

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.model import rosgraph

USHER = Path(__file__).parents[2] / "m2t" / "layer" / "usher.rscd"
MISSION = Path(__file__).parent / "mission.rscd"


class Bench:
    """A layer, and its robot's graph by names."""

    def __init__(self, log: Path, model: Path = USHER, on_blocked: Sequence[str] = ()) -> None:
        self.graph = supervised(model)
        self.port = FakePort()
        self.event_loop = EventLoop(lambda: self.port.time)
        self.log = log
        configuration = Configuration()
        values = {
            parameter.name: parameter.default for parameter in layer_parameters(self.graph, configuration, str(log))
        }
        instead = [find_message(self.graph, name) for name in on_blocked]
        safe = SafeMessages(on_blocked=[sending for sending in instead if sending is not None])
        self.layer = Layer(self.graph, Settings(values, configuration), self.port, self.event_loop, safe)
        (self.action,) = self.graph.actionClients
        (self.service,) = self.graph.serviceClients
        self.cancelled = 0
        self.trouble, self.waits = "", False
        self.layer.goals[self.action.cancel] = self
        self.layer.start()

    def cancel(self) -> None:
        self.cancelled += 1

    def leave(self) -> None:
        self.left = True

    def hear(self, topic: str, **fields: Any) -> None:
        subscription = next(known for known in self.graph.subscriptions if known.topic == topic)
        self.layer.receive(subscription, Record(**fields))

    def sending(self, name: str) -> rosgraph.Sending:
        sendings = [sending for publisher in self.graph.publishers for sending in publisher.sendings]
        return next(
            sending for sending in [*sendings, self.service.request, self.action.request] if sending.name == name
        )

    def passes(self, name: str) -> bool:
        return self.layer.forwarded(self.sending(name), Record()) is not None

    def blocked(self) -> list[dict[str, Any]]:
        return [json.loads(text) for topic, text in self.port.told if topic == "blocked"]

    def directions(self) -> list[tuple[str, str]]:
        self.layer._log.flush()
        lines = [json.loads(line) for line in self.log.read_text().splitlines()]
        return [(line["direction"], line["event"]) for line in lines]


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path / "events.jsonl")


def test_what_is_allowed_passes_and_is_logged(bench: Bench) -> None:
    assert bench.passes("speed")
    assert bench.passes("label")
    assert bench.blocked() == []
    assert bench.directions() == [("out", "message_speed.c_trigger"), ("out", "message_label.c_trigger")]


def test_all_requirements_that_fail_are_told(bench: Bench) -> None:
    bench.hear("/stop")
    bench.hear("battery", data=10)
    assert not bench.passes("speed")
    (report,) = bench.blocked()
    assert report["reason"] == "requirement"
    assert report["because"] == ["requirement speed needs Guard.clear", "requirement speed needs Guard.charge > 20"]
    assert report["components"]["Guard"] == {"state": "blocked", "variables": {"charge": 10}}
    assert bench.directions()[-1] == ("blocked", "message_speed.c_trigger")
    schema = json.loads(locate("schemas/blocked.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator(schema).validate(report)


def test_a_state_without_a_transition_is_told(bench: Bench) -> None:
    assert bench.passes("go_to")
    assert not bench.passes("go_to")
    (report,) = bench.blocked()
    assert (report["name"], report["reason"]) == ("Navigation.go_to", "state")
    assert report["because"] == ["Navigation.go_to.executing", "Navigation.going"]


def test_a_goal_is_cancelled_when_its_requirement_falls(bench: Bench) -> None:
    assert bench.passes("go_to")
    bench.layer.feed_back(bench.action, Record(distance_remaining=0.5))
    bench.hear("/stop")
    assert bench.cancelled == 1
    assert bench.directions()[-2:] == [("in", "message_stop.u_response"), ("out", "action_go_to.c_cancel")]
    # The goal may have succeeded before the cancel arrived.
    bench.layer.respond(bench.action, Record())
    assert bench.directions()[-2:] == [("in", "action_go_to.u_response"), ("internal", "action_go_to.c_reset")]


def test_a_canceled_goal_has_ended_when_the_robot_says_so(bench: Bench) -> None:
    assert bench.passes("go_to")
    bench.hear("/stop")
    assert not bench.passes("go_to"), "it has not ended"
    bench.layer.end_canceled(bench.action, Failure.CANCELED, "canceled")
    assert bench.directions()[-1] == ("in", "action_go_to.u_canceled")
    assert bench.port.said[-1].startswith("Navigation.go_to is blocked"), "a cancel of its own is no failure"


def test_a_goal_that_someone_else_has_canceled_is_an_error(bench: Bench) -> None:
    assert bench.passes("go_to")
    bench.layer.end_canceled(bench.action, Failure.CANCELED, "canceled")
    assert ("in", "action_go_to.u_error") in bench.directions()
    assert bench.port.said == ["/go_to: canceled"]


class Proxy(ActionProxy[ProxiedGoal]):
    """An action whose robot is always available."""

    def _is_served(self, goal: ProxiedGoal) -> bool:  # noqa: ARG002
        return True

    def _send(self, goal: ProxiedGoal) -> bool:  # noqa: ARG002
        return True

    def _send_cancel(self, goal: ProxiedGoal) -> None:
        pass

    def _is_canceling(self, goal: ProxiedGoal) -> bool:  # noqa: ARG002
        return False

    def _end(self, goal: ProxiedGoal, why: str) -> None:
        pass


@pytest.mark.parametrize(
    ("outcome", "late", "said"),
    [
        (GoalOutcome.ABORTED, False, "aborted"),
        (GoalOutcome.ABORTED, True, "aborted"),
        (GoalOutcome.LOST, False, "the server has lost the goal"),
        (GoalOutcome.LOST, True, "the server has lost the goal"),
    ],
)
def test_a_goal_without_an_end_is_lost(
    bench: Bench, monkeypatch: pytest.MonkeyPatch, outcome: GoalOutcome, late: bool, said: str
) -> None:
    told: list[tuple[Any, ...]] = []
    monkeypatch.setattr(bench.layer, "fail", lambda _, *reason: told.append(reason[:2]))
    proxy = Proxy(bench.port, bench.event_loop, bench.action, bench.layer, GoalTimes(2.0, 2.0))
    goal = ProxiedGoal("identifier", Record(), sent=True, accepted=True, late=late)
    proxy._receive_end(goal, outcome, Record())
    reason = {GoalOutcome.LOST: Failure.LOST, GoalOutcome.ABORTED: Failure.TIMEOUT if late else Failure.ABORTED}[
        outcome
    ]
    assert told == [(reason, said)]


def test_answers_and_failures_move_the_supervisor_and_it_settles(bench: Bench) -> None:
    assert bench.passes("light")
    bench.layer.respond(bench.service, Record(success=True))
    assert bench.passes("light"), "the reset has run"
    bench.layer.fail(bench.service, Failure.UNAVAILABLE, "no server within 5000 ms")
    assert bench.passes("light")
    assert bench.port.said == ["/lamp/light: no server within 5000 ms"]
    told = [line for line in bench.directions() if line[1].startswith("service")]
    assert told == [
        ("out", "service_light.c_trigger"),
        ("in", "service_light.u_response"),
        ("internal", "service_light.c_reset"),
        ("out", "service_light.c_trigger"),
        ("in", "service_light.u_error"),
        ("internal", "service_light.c_reset"),
        ("out", "service_light.c_trigger"),
    ]


def test_what_can_not_be_read_counts_as_not_received(tmp_path: Path) -> None:
    bench = Bench(tmp_path / "events.jsonl", MISSION)
    bench.hear("/route", name="short", poses=[])
    assert bench.directions() == [("in", "message_length.u_response")]
    assert bench.port.said == ["/route: there is no element 2 in an array of 0"]
    # The supervisor receives the answer as an error.
    assert bench.passes("plan")
    bench.layer.respond(bench.service, Record(cost=5.0, stops=[]))
    assert bench.directions()[-2:] == [("in", "service_plan.u_error"), ("internal", "service_plan.c_reset")]
    assert bench.port.said[-1] == "/plan: there is no element 0 in an array of 0"
    assert bench.passes("plan")
    bench.layer.respond(bench.service, Record(cost=5.0, stops=[1]))
    assert bench.passes("visit")
    bench.layer.feed_back(bench.action, Record(stops=[1]))
    assert bench.directions()[-1] == ("out", "action_visit.c_trigger")
    bench.layer.respond(bench.action, Record(stops=[1]))
    assert ("in", "action_visit.u_error") in bench.directions()


def test_who_is_turned_away_is_told_busy(bench: Bench) -> None:
    bench.layer.reject(bench.sending("light"))
    (report,) = bench.blocked()
    assert (report["reason"], report["because"]) == ("busy", [])


def test_provided_data_plays_no_part(bench: Bench) -> None:
    bench.hear("/stop")
    bench.hear("/resume")
    assert not [name for _, name in bench.directions() if name.startswith("data_")]


def test_blocked_messages_are_replaced_once_until_the_next_passes(tmp_path: Path) -> None:
    bench = Bench(tmp_path / "events.jsonl", on_blocked=["speed"])
    bench.hear("battery", data=10)
    assert not bench.passes("speed")
    assert bench.port.sent == [], "the robot was told nothing yet"
    for _ in range(2):
        bench.hear("battery", data=80)
        assert bench.passes("speed")
        bench.hear("battery", data=10)
        for _ in range(3):
            assert not bench.passes("speed")
    assert bench.port.sent == [("/speed", {"data": 0.25})] * 2, "what the model provides"
    assert [line for line in bench.directions() if line[0] == "outside"] == [("outside", "message_speed.c_trigger")] * 2
    assert len(bench.blocked()) == 7


def test_warnings_of_what_is_blocked_are_throttled(bench: Bench) -> None:
    bench.hear("/stop")
    for _ in range(3):
        assert not bench.passes("speed")
        assert not bench.passes("go_to")
    assert [text.partition(" is blocked")[0] for text in bench.port.said] == ["Drive.speed", "Navigation.go_to"]
    bench.port.time += 5
    assert not bench.passes("speed")
    assert len(bench.port.said) == 3


def test_nodes_that_go_around_the_layer_are_reported_once_and_while_it_lasts(bench: Bench) -> None:
    publisher = next(known for known in bench.graph.publishers if known.topic == "/speed")

    def look() -> set[str]:
        bench.port.statuses.clear()
        for _ in range(20):
            bench.port.time += 0.1
            bench.event_loop.run_pending()
        (*_, last) = bench.port.statuses
        return {text for status in last for text in [status.message] if "around" in text and status.level == "WARN"}

    assert look() == set()
    bench.port.others = {publisher: [Endpoint("/teleop", "std_msgs/Float32"), Endpoint("", "std_msgs/Float32")]}
    bench.port.callers = ["/planner"]
    around = [
        "/speed: /teleop publishes it, too, around this layer",
        "/lamp/light: /planner calls it, too, around this layer",
        "/go_to: /planner sends goals, too, around this layer",
    ]
    assert look() == {"has no states; " + around[0], "lamp; " + around[1], "resting; " + around[2]}
    bench.port.others, bench.port.callers = {}, []
    assert look() == set()
    assert [text for text in bench.port.said if "around" in text] == around
