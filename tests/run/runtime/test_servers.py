"""Services and actions that a controller serves, without middleware: whom it answers, when, and with which data."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from robosc.language.configuration import Configuration
from robosc.run.runtime.core.servers import MOST_WAITING
from tests.run.runtime.fake import Record, World

if TYPE_CHECKING:
    from robosc.run.runtime.core.port import GoalOutcome

DESK = Path(__file__).with_name("desk.rscd")
POSES = [Record(pose=Record(position=Record(x=1.5)))]


@dataclass
class Caller:
    """Client of a service with the responses to its call."""

    responses: list[dict[str, Any]] = field(default_factory=list)

    def give(self, response: Any = None) -> None:
        self.responses.append(response.plain())


@dataclass
class Client:
    """Client of an action with the fate of its goal."""

    fate: list[tuple[str, dict[str, Any]]] = field(default_factory=list)
    is_answered: bool = False

    def feed_back(self, feedback: Any) -> None:
        self.fate.append(("feedback", feedback.plain()))

    def end(self, outcome: GoalOutcome, result: Any) -> None:
        self.fate.append((str(outcome), result.plain()))


class Desk(World):
    """A controller of the desk after its first tick."""

    def __init__(self, folder: Path, configuration: Configuration | None = None, **parameters: Any) -> None:
        super().__init__(DESK, folder / "events.jsonl", configuration or Configuration(on_shutdown=[]), **parameters)
        self.port.types = {"costs": "sequence<float>", "sequence": "sequence<int32>", "sum": "int64"}
        self.start().wait(0.11)

    def call(self, name: str = "/add", **fields: Any) -> Caller:
        """Call a service."""
        caller = Caller()
        server = next(known for known in self.graph.serviceServers if known.identifier == name)
        self.controller.services[server].call(Record(**fields), caller)
        self.event_loop.run_pending()
        return caller

    def send(self, name: str = "/count", **fields: Any) -> Client | None:
        """Send a goal; return its client if the controller accepts the goal."""
        goal, client = Record(**fields), Client()
        server = self.actions[name]
        if not server.accepts(goal):
            return None
        server.begin(client, goal)
        self.event_loop.run_pending()
        return client

    def cancel(self, name: str = "/count") -> bool:
        """Ask to cancel the present goal of an action; return whether the controller accepts that."""
        accepted: bool = self.actions[name].cancel()
        self.event_loop.run_pending()
        return accepted

    def answer(self) -> None:
        """Let the controller answer the open request of `/add`."""
        self.hear("answer")
        self.event_loop.run_pending()

    @property
    def actions(self) -> dict[str, Any]:
        return {known.identifier: server for known, server in self.controller.actions.items()}

    def events(self, *, of: str) -> list[str]:
        """Return the events of a plant in the log."""
        self.controller.flush_log()
        lines = map(json.loads, self.log.read_text().splitlines())
        return [
            f"{line['direction']} {line['event'].partition('.')[2]}"
            for line in lines
            if line["event"].startswith(f"{of}.")
        ]


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(tmp_path)


def test_requests_are_answered_in_the_order_of_their_arrival(desk: Desk) -> None:
    callers = [desk.call(a=number) for number in (3, 1, 2)]
    assert desk.events(of="service_add") == ["in u_request"]
    for answered, number in enumerate((3, 1, 2), start=1):
        desk.answer()
        assert [len(caller.responses) for caller in callers] == [1] * answered + [0] * (3 - answered)
        assert callers[answered - 1].responses == [{"sum": number}]
    assert desk.events(of="service_add") == ["in u_request", "out c_response"] * 3


def test_the_oldest_of_too_many_requests_is_dropped(desk: Desk) -> None:
    callers = [desk.call(a=number % 10) for number in range(MOST_WAITING + 1)]
    warning = "/add: more than 10 requests wait: the oldest one is dropped"
    assert warning not in desk.port.said
    callers += [desk.call(a=8), desk.call(a=9)]
    assert desk.port.said.count(warning) == 1  # the next one after five seconds
    for _ in callers:
        desk.answer()
    desk.wait(0.1)  # ten reactions in a tick
    answered = [index for index, caller in enumerate(callers) if caller.responses]
    assert answered == [0, *range(3, len(callers))]
    assert callers[-1].responses == [{"sum": 9}]


def test_calls_one_after_another_are_answered_at_once(desk: Desk) -> None:
    desk.hear("level", data=0.25)
    callers = [desk.call("/costs") for _ in range(5)]
    assert [caller.responses for caller in callers] == [[{"costs": [0.25]}]] * 5


def test_an_answer_that_cannot_be_sent_waits(desk: Desk) -> None:
    desk.hear("level", data=math.nan)
    caller = desk.call("/costs")
    desk.wait(0.5)
    assert caller.responses == []
    assert "costs_response is withheld: its costs would not be finite" in desk.port.said
    desk.hear("level", data=2.0)
    desk.wait(0.1)
    assert caller.responses == [{"costs": [2.0]}]


def test_a_goal_needs_its_state_and_its_data(desk: Desk) -> None:
    assert desk.send(order=0) is None
    client = desk.send(order=3)
    assert client is not None
    assert client.fate == [("feedback", {"sequence": [3]})]
    assert desk.send(order=3) is None
    assert desk.events(of="action_count") == ["in u_request", "out c_feedback"]


@pytest.mark.parametrize(("end", "event", "outcome"), [(1, "response", "succeeded"), (2, "error", "aborted")])
def test_a_goal_ends_with_its_result(desk: Desk, end: int, event: str, outcome: str) -> None:
    for order in (2, 5):
        client = desk.send(order=order)
        assert client is not None
        desk.hear("end", data=end)
        assert client.fate == [("feedback", {"sequence": [order]}), (outcome, {"sequence": [order, 0]})]
    assert desk.events(of="action_count") == ["in u_request", "out c_feedback", f"out c_{event}"] * 2


@pytest.mark.parametrize(("end", "outcome"), [(1, "succeeded"), (2, "aborted"), (3, "canceled")])
def test_a_canceled_goal_is_open_until_it_ends(desk: Desk, end: int, outcome: str) -> None:
    client = desk.send(order=1)
    assert client is not None
    assert desk.cancel()
    assert desk.events(of="action_count")[-1] == "in u_cancel"
    desk.wait(1.0)
    assert desk.send(order=1) is None
    assert len(client.fate) == 1
    desk.hear("end", data=end)
    assert client.fate[1:] == [(outcome, {"sequence": [1, 0]})]
    assert not desk.cancel()


def test_a_cancel_comes_too_late_if_its_goal_ends_meanwhile(desk: Desk) -> None:
    client = desk.send(order=1)
    assert client is not None
    assert desk.actions["/count"].cancel()
    desk.hear("end", data=1)
    assert desk.send(order=2) is not None
    desk.event_loop.run_pending()
    assert client.fate[-1] == ("succeeded", {"sequence": [1, 0]})
    assert "in u_cancel" not in desk.events(of="action_count")


def test_a_cancel_that_no_transition_names_is_rejected(desk: Desk) -> None:
    assert desk.send(order=1) is not None
    client = desk.send("/tour", poses=POSES)
    assert client is not None
    assert client.fate == []
    assert not desk.cancel("/tour")


def test_a_requirement_holds_an_answer_back(desk: Desk) -> None:
    assert desk.send(order=1) is not None
    client = desk.send("/tour", poses=POSES)
    assert client is not None
    desk.wait(1.0)
    assert client.fate == []
    desk.hear("end", data=1)
    desk.wait(0.1)
    assert client.fate == [("succeeded", {})]


def test_a_client_that_repeats_its_goal_does_not_flood_the_log(desk: Desk) -> None:
    rejected = "/tour: a goal is rejected: its data or the present state does not permit it"
    for _ in range(3):
        assert desk.send("/tour", poses=[]) is None
    assert desk.port.said.count(rejected) == 1
    desk.wait(5.1)
    assert desk.send("/tour", poses=[]) is None
    assert desk.port.said.count(rejected) == 2


def test_a_goal_whose_data_cannot_be_read_is_rejected(desk: Desk) -> None:
    assert desk.send("/tour", poses=[]) is None
    rejected = "/tour: a goal is rejected: its data or the present state does not permit it"
    assert desk.port.said == ["/tour: there is no element 0 in an array of 0", rejected]
    assert desk.events(of="action_tour") == []
    assert desk.send("/tour", poses=POSES) is not None


def test_a_request_against_an_assumption_is_dropped_and_stops_the_robot(desk: Desk) -> None:
    client = desk.send(order=1)
    assert client is not None
    assert desk.cancel()
    caller = desk.call("/costs")
    assert desk.events(of="service_costs") == ["violated u_request"]
    assert any("no longer as the model describes" in text for text in desk.port.said)
    # Its answers are held back, and it accepts no more goals.
    desk.hear("end", data=3)
    assert len(client.fate) == 1
    assert desk.send("/tour", poses=POSES) is None
    assert caller.responses == []


def test_after_a_dropped_request_comes_the_next_one(tmp_path: Path) -> None:
    desk = Desk(tmp_path, Configuration(on_shutdown=[], on_violation="report"))
    assert desk.send(order=1) is not None
    assert desk.cancel()
    dropped = desk.call("/costs")
    desk.hear("end", data=3)
    assert desk.call("/costs").responses == [{"costs": [0.0]}]
    assert dropped.responses == []


def test_a_silent_sensor_holds_answers_back(tmp_path: Path) -> None:
    desk = Desk(tmp_path, **{"watchdog_stops": True, "watchdog_ms.level": 200})
    desk.hear("level", data=1.0)
    client, caller = desk.send(order=1), desk.call(a=3)
    assert client is not None
    desk.wait(0.3)
    assert "/level: silent for 200 ms" in desk.port.said
    desk.answer()
    desk.hear("end", data=1)
    desk.wait(0.5)
    assert (len(client.fate), caller.responses) == (1, [])
    assert desk.send("/tour", poses=POSES) is None
    desk.hear("level", data=1.0)
    desk.wait(0.1)
    assert client.fate[-1] == ("succeeded", {"sequence": [1, 0]})
    assert caller.responses == [{"sum": 3}]
    assert desk.send("/tour", poses=POSES) is not None


def test_answers_wait_for_the_topics_of_wait_for(tmp_path: Path) -> None:
    desk = Desk(tmp_path, Configuration(on_shutdown=[], wait_for=["level"]))
    caller = desk.call("/costs")
    desk.wait(0.5)
    assert caller.responses == []
    assert desk.send(order=1) is None
    desk.hear("level", data=1.0)
    desk.wait(0.1)
    assert caller.responses == [{"costs": [1.0]}]
    assert desk.send(order=1) is not None


def test_the_end_of_the_node_aborts_the_goal_and_drops_the_requests(desk: Desk) -> None:
    client, callers = desk.send(order=1), [desk.call(a=1), desk.call(a=2)]
    assert client is not None
    desk.answer()
    third = desk.call(a=3)
    desk.controller.stop()
    assert desk.controller.busy
    client.is_answered = True
    assert client.fate[1:] == [("aborted", {})]
    assert "/count: the goal is aborted because this node ends" in desk.port.said
    assert "/add: requests without a response at the end of this node: 2" in desk.port.said
    desk.answer()
    assert desk.send(order=1) is None
    assert desk.call(a=4).responses == []
    assert [caller.responses for caller in (*callers, third)] == [[{"sum": 1}], [], []]


def test_a_node_without_an_open_goal_ends_at_once(desk: Desk) -> None:
    client = desk.send(order=1)
    assert client is not None
    desk.hear("end", data=1)
    desk.controller.stop()
    assert not desk.controller.busy
    desk.call(a=1)
    assert desk.events(of="service_add") == []


def test_another_server_of_the_name_is_reported(desk: Desk) -> None:
    desk.port.servers = [("/desk", "example_interfaces/Fibonacci"), ("/rival", "example_interfaces/Fibonacci")]
    desk.wait(1.0)
    assert "/count: /desk and /rival serve it: only one answer counts" in desk.port.said
