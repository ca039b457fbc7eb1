"""A controller that serves services and actions: clients call it, send goals, and cancel them. See `serving`."""

from __future__ import annotations

import json
from contextlib import contextmanager
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import pytest

from tests.ros.faults.partners import Peer
from tests.ros.running import Runner
from tests.ros.workspaces import SERVING, Workspace, middleware

if TYPE_CHECKING:
    import subprocess
    from collections.abc import Callable, Iterator, Sequence
    from contextlib import AbstractContextManager
    from pathlib import Path

    from tests.ros.processes import Processes

TOPICS = ("answer", "close", "open", "arrival", "finish", "collapse", "halted", "home")
TOUR, PATROL = "nav2_msgs/FollowWaypoints", "nav2_msgs/NavigateToPose"
ORDER, RING = "std_srvs/SetBool", "std_srvs/Trigger"
MANAGED = "managed_clerk"
#: As in the model: with this number of loops the controller rejects a tour.
LONG = 5


class Transition(IntEnum):
    """Transitions of managed nodes, with the numbers of lifecycle_msgs."""

    CONFIGURE = 1
    CLEAN_UP = 2
    ACTIVATE = 3
    DEACTIVATE = 4


@dataclass
class Clerk:
    """A running node with a peer that sends its messages, requests and goals."""

    version: int
    processes: Processes
    world: Peer
    process: subprocess.Popen[bytes]
    folder: Path

    def events(self, since: int = 0) -> list[str]:
        """Return the events in the log."""
        log = self.folder / "events.jsonl"
        text = log.read_text(encoding="utf-8") if log.exists() else ""
        return [json.loads(line)["event"] for line in text[: text.rfind("\n") + 1].splitlines()[since:]]

    def output(self) -> str:
        """Return the output of the node."""
        return (self.folder / "node.log").read_text(errors="replace")

    def until(self, since: int, event: str, count: int = 1) -> None:
        """Wait until an event has happened."""
        self.processes.wait_until(lambda: self.events(since).count(event) >= count, event)

    def tell(self, topic: str) -> None:
        """Send a message and wait until the node has handled it."""
        since = len(self.events())
        self.world.do("publish", topic=f"/{topic}", fields={})
        self.until(since, f"message_{topic}.u_response")

    def order(self, data: bool) -> int:
        """Call the service `/order`; return the number of the call."""
        number: int = self.world.do("call", name="/order", kind=ORDER, fields={"data": data})
        return number

    def answer(self, number: int) -> Any:
        """Return the response to a call."""
        return self.world.wait("answered", value=number)["data"]

    def tour(self, loops: int, poses: Sequence[dict[str, Any]] = ({},)) -> int:
        """Send a goal to `/tour`; return its number."""
        fields = {"number_of_loops": loops, "poses": poses}
        number: int = self.world.do("start", name="/tour", kind=TOUR, fields=fields)
        return number

    def accepted(self, number: int) -> bool:
        """Return whether the node accepts a goal."""
        return bool(self.world.wait("accepted", value=number)["yes"])

    def ended(self, number: int) -> tuple[str, Any]:
        """Return how a goal has ended, and its result."""
        end = self.world.wait("ended", value=number)
        return end["how"], end["data"]

    def change(self, *transitions: Transition) -> None:
        """Change the state of a managed node."""
        for transition in transitions:
            fields = {"transition": {"id": int(transition)}}
            kind = "lifecycle_msgs/ChangeState"
            number = self.world.do("call", name=f"/{MANAGED}/change_state", kind=kind, fields=fields)
            assert self.answer(number)["success"]


@contextmanager
def serving(
    nodes: Workspace | Runner, folder: Path, *parameters: str, package: str = "clerk_controller"
) -> Iterator[Clerk]:
    """Run the node with its peer until it listens. Configure a managed node. `parameters` are as `name:=value`."""
    with middleware(nodes, folder) as processes:
        values = [f"event_log:={folder / 'events.jsonl'}", *parameters]
        if isinstance(nodes, Runner):
            settings = SERVING / "controller-config.json"
            command: list[Any] = nodes.command(SERVING / "clerk.rscd", *values, configuration=settings, own_types=True)
        elif nodes.ros.version == 1:
            executable = nodes.folder / "devel/lib/clerk_controller/clerk_controller"
            command = [executable, "__name:=clerk_controller", *(f"_{value}" for value in values)]
        else:
            command = nodes.node(package, *values)
        node = processes.start("node", command)
        world = Peer(processes, nodes.ros.python, nodes.ros.version, "world")
        for topic in TOPICS:
            world.do("advertise", topic=f"/{topic}", kind="std_msgs/Empty")
        clerk = Clerk(nodes.ros.version, processes, world, node, folder)
        if package == MANAGED:
            clerk.change(Transition.CONFIGURE)
        processes.wait_until(
            lambda: all(world.do("listeners", topic=f"/{topic}") for topic in TOPICS), "the node listens"
        )
        yield clerk


@pytest.fixture
def served(
    nodes: Workspace | Runner,
    kept: Callable[[str, Callable[[], AbstractContextManager[Clerk]]], Clerk],
    tmp_path_factory: pytest.TempPathFactory,
) -> Clerk:
    """A node without open requests and goals, shared by the tests."""
    return kept("served", lambda: serving(nodes, tmp_path_factory.mktemp("serving") / "run"))


def test_a_request_waits_for_its_response(served: Clerk) -> None:
    since = len(served.events())
    first = served.order(data=True)
    served.until(since, "service_order.u_request")
    second = served.order(data=False)
    served.tell("answer")
    assert served.answer(first) == {"success": True, "message": "done"}
    served.until(since, "service_order.u_request", count=2)
    served.tell("answer")
    assert served.answer(second) == {"success": False, "message": "done"}
    served.until(since, "service_order.c_response", count=2)
    events = [event for event in served.events(since) if "_order." in event]
    # The events that select the data of the response come in between.
    assert [event for event in events if not event.startswith("data_")] == [
        "service_order.u_request",
        "service_order.c_response",
    ] * 2


def test_a_request_may_have_its_response_at_once(served: Clerk) -> None:
    numbers = [served.world.do("call", name="/ring", kind=RING, fields={}) for _ in range(5)]
    assert [served.answer(number) for number in numbers] == [{"success": False, "message": ""}] * 5


def test_ten_requests_wait_and_then_the_oldest_gets_no_response(served: Clerk) -> None:
    since = len(served.events())
    numbers = [served.order(data=True)]
    served.until(since, "service_order.u_request")
    refusal = "/order: more than 10 requests wait: the oldest one is …".removesuffix("…")
    for _ in range(10):
        numbers.append(served.order(data=True))
        served.tell("home")  # ROS 2 itself keeps only some requests of a burst.
    assert refusal not in served.output()
    numbers.append(served.order(data=True))
    served.processes.wait_until(lambda: refusal in served.output(), "a request is refused")
    for count in range(1, 12):
        served.until(since, "service_order.u_request", count)
        served.tell("answer")
        served.until(since, "service_order.c_response", count)
    answers = len(numbers) - (served.version == 2)
    served.processes.wait_until(
        lambda: sum(entry["answered"] in numbers for entry in served.world.all("answered")) == answers, "all answers"
    )
    given = {entry["answered"]: entry["data"] for entry in served.world.all("answered") if entry["answered"] in numbers}
    # A client of ROS 2 gets nothing; a call of ROS 1 fails. The threads of the clients call in any order.
    refused = [number for number in numbers if given.get(number) is None]
    assert len(refused) == 1
    assert refused != numbers[:1]


def test_a_goal_succeeds_with_feedback_and_result(served: Clerk) -> None:
    goal = served.tour(3)
    assert served.accepted(goal)
    # One goal at a time.
    assert not served.accepted(served.tour(3))
    served.tell("arrival")
    assert served.world.wait("feedback", value=goal)["data"] == {"current_waypoint": 1}
    served.tell("arrival")
    served.processes.wait_until(lambda: len(feedback(served, goal)) == 2, "feedback")
    assert feedback(served, goal) == [1, 2]
    served.tell("finish")
    assert served.ended(goal) == ("succeeded", {"missed_waypoints": [3, 2]})
    again = served.tour(0)
    assert served.accepted(again)
    served.tell("finish")
    assert served.ended(again) == ("succeeded", {"missed_waypoints": [0, 0]})


def feedback(served: Clerk, goal: int) -> list[int]:
    return [entry["data"]["current_waypoint"] for entry in served.world.all("feedback") if entry["feedback"] == goal]


def test_a_goal_is_rejected_because_of_its_data_or_the_state(served: Clerk) -> None:
    since = len(served.events())
    assert not served.accepted(served.tour(LONG))
    assert not served.accepted(served.tour(1, poses=[]))
    served.processes.wait_until(
        lambda: "/tour: there is no element 0 in an array of 0" in served.output(), "the node reports the data"
    )
    served.tell("close")
    assert not served.accepted(served.tour(1))
    served.tell("open")
    assert "action_tour.u_request" not in served.events(since)
    goal = served.tour(LONG - 1)
    assert served.accepted(goal)
    served.tell("finish")
    assert served.ended(goal) == ("succeeded", {"missed_waypoints": [LONG - 1, 0]})


def test_a_goal_is_aborted(served: Clerk) -> None:
    goal = served.tour(2)
    assert served.accepted(goal)
    served.tell("collapse")
    assert served.ended(goal) == ("aborted", {"missed_waypoints": [2, 0]})


def test_a_client_cancels_a_goal(served: Clerk) -> None:
    since = len(served.events())
    goal = served.tour(1)
    assert served.accepted(goal)
    served.world.do("cancel", number=goal)
    if served.version == 2:
        assert served.world.wait("cancel_answered", value=goal)["yes"]
    served.until(since, "action_tour.u_cancel")
    assert not any(entry["ended"] == goal for entry in served.world.all("ended"))
    served.tell("halted")
    assert served.ended(goal) == ("cancelled", {"missed_waypoints": [1, 0]})


def test_a_canceled_goal_may_still_succeed(served: Clerk) -> None:
    since = len(served.events())
    goal = served.tour(1)
    assert served.accepted(goal)
    served.world.do("cancel", number=goal)
    served.until(since, "action_tour.u_cancel")
    served.tell("finish")
    assert served.ended(goal) == ("succeeded", {"missed_waypoints": [1, 0]})


def test_a_cancel_that_no_transition_names_is_rejected_and_a_requirement_withholds_the_result(served: Clerk) -> None:
    since = len(served.events())
    goal = served.world.do("start", name="/patrol", kind=PATROL, fields={})
    assert served.accepted(goal)
    served.world.do("cancel", number=goal)
    if served.version == 2:
        assert not served.world.wait("cancel_answered", value=goal)["yes"]
    order = served.order(data=True)
    served.until(since, "service_order.u_request")
    served.tell("home")
    served.tell("answer")
    assert served.answer(order)["success"]
    assert served.ended(goal)[0] == "succeeded"
    served.until(since, "action_patrol.c_response")
    events = served.events(since)
    steps = ["message_home.u_response", "service_order.c_response", "action_patrol.c_response"]
    assert [event for event in events if event in steps] == steps
    assert "action_patrol.u_cancel" not in events


def test_another_server_is_reported(served: Clerk, nodes: Workspace | Runner) -> None:
    other = Peer(served.processes, nodes.ros.python, nodes.ros.version, "other")
    other.do("act", name="/tour", kind=TOUR)
    fault = "/tour: /clerk_controller and /other serve it: only one answer counts"
    fault = fault if served.version == 2 else "/tour/status: /other publishes it, too"
    served.processes.wait_until(lambda: fault in served.output(), "the node reports the other server")
    assert other.process.stdin is not None
    other.process.stdin.close()
    other.process.wait()


def test_the_end_of_the_node_aborts_its_goal_and_drops_its_requests(nodes: Workspace | Runner, tmp_path: Path) -> None:
    with serving(nodes, tmp_path / "run") as clerk:
        goal = clerk.tour(1)
        assert clerk.accepted(goal)
        numbers = [clerk.order(data=True), clerk.order(data=True)]
        clerk.until(0, "service_order.u_request")
        assert clerk.processes.stop(clerk.process) == 0
        assert clerk.ended(goal) == ("aborted", {"missed_waypoints": []})
        assert "/tour: the goal is aborted because this node ends" in clerk.output()
        # The second request may not have arrived.
        assert "/order: requests without a response at the end of this node: 2"[:-1] in clerk.output()
        if clerk.version == 1:
            assert [clerk.answer(number) for number in numbers] == [None, None]


def test_an_inactive_node_rejects_goals_and_answers_nothing(ros2_workspace: Workspace, tmp_path: Path) -> None:
    with serving(ros2_workspace, tmp_path / "run", package=MANAGED) as clerk:
        assert not clerk.accepted(clerk.tour(1))
        order = clerk.order(data=True)
        clerk.tell("home")
        assert "service_order.u_request" not in clerk.events()
        clerk.change(Transition.ACTIVATE)
        clerk.until(0, "service_order.u_request")
        clerk.tell("answer")
        assert clerk.answer(order)["success"]
        goal = clerk.tour(1)
        assert clerk.accepted(goal)
        clerk.change(Transition.DEACTIVATE)
        clerk.world.do("cancel", number=goal)
        assert clerk.world.wait("cancel_answered", value=goal)["yes"]
        clerk.until(0, "action_tour.u_cancel")
        clerk.tell("halted")
        clerk.tell("home")
        assert "action_tour.c_canceled" not in clerk.events()
        clerk.change(Transition.ACTIVATE)
        assert clerk.ended(goal) == ("cancelled", {"missed_waypoints": [1, 0]})
        lost = clerk.tour(1)
        assert clerk.accepted(lost)
        # The node has received the request for the result before this feedback is back.
        clerk.tell("arrival")
        clerk.world.wait("feedback", value=lost)
        clerk.change(Transition.DEACTIVATE, Transition.CLEAN_UP)
        assert clerk.ended(lost) == ("aborted", {"missed_waypoints": []})
        assert "/tour: the goal is aborted because this node ends" in clerk.output()
        clerk.change(Transition.CONFIGURE, Transition.ACTIVATE)
        again = clerk.tour(2)
        assert clerk.accepted(again)
        clerk.processes.wait_until(
            lambda: all(clerk.world.do("listeners", topic=f"/{topic}") for topic in TOPICS), "the node listens"
        )
        clerk.tell("finish")
        assert clerk.ended(again) == ("succeeded", {"missed_waypoints": [2, 0]})
