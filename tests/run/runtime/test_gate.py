"""A layer with its controller in the same process: outcomes of commands, and every end of a goal."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from robosc.language.configuration import Configuration
from robosc.language.configuration.parameters import layer_parameters
from robosc.model.semantics.messages import find_message
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.gate import GatedLayer, Outcome
from robosc.run.runtime.core.port import CancelAnswer, Endpoint, GoalOutcome
from robosc.run.runtime.core.settings import SafeMessages, Settings
from tests.run.runtime.fake import FakePort, Record, supervised

if TYPE_CHECKING:
    from robosc.model import rosgraph

USHER = Path(__file__).parents[2] / "m2t" / "layer" / "usher.rscd"
#: Timeouts of the tests, in seconds.
TIMEOUT = 5.0


class Bench:
    """A gated layer of a model on a fake port. Only `wait` advances time."""

    def __init__(self, model: Path = USHER) -> None:
        self.graph = supervised(model)
        self.port = FakePort()
        self.event_loop = EventLoop(lambda: self.port.time)
        configuration = Configuration()
        values = {each.name: each.default for each in layer_parameters(self.graph, configuration, "")}
        safe = SafeMessages(on_blocked=[self.sending("speed")])
        self.layer = GatedLayer(self.graph, Settings(values, configuration), self.port, self.event_loop, safe)
        self.layer.start()
        self.outcomes: list[Outcome] = []

    def sending(self, name: str) -> rosgraph.Sending:
        sending = find_message(self.graph, name)
        assert sending is not None
        return sending

    def hear(self, topic: str, **fields: Any) -> None:
        self.layer.receive(next(each for each in self.graph.subscriptions if each.topic == topic), Record(**fields))

    def wait(self, seconds: float = 0.0) -> None:
        until = self.port.time + seconds
        while (left := self.event_loop.run_pending()) is not None and self.port.time + left <= until:
            self.port.time += left
            if not left and not seconds:
                break
        self.port.time = until
        self.event_loop.run_pending()

    def start(self) -> None:
        (action,) = self.graph.actionClients
        self.layer.start_goal(action, Record(), self.outcomes.append)
        self.wait()

    def call(self) -> None:
        (service,) = self.graph.serviceClients
        self.layer.call(service, Record(data=True), self.outcomes.append)
        self.wait()

    @property
    def status(self) -> str:
        """The status of the latest goal."""
        (action,) = self.layer.actions.values()
        assert action.latest is not None
        return action.latest.status

    def cancel(self) -> None:
        (action,) = self.layer.actions.values()
        action.cancel()
        self.wait()


def last(bench: Bench) -> tuple[str, str]:
    """Return verdict and reason of the last outcome."""
    return bench.outcomes[-1].verdict, bench.outcomes[-1].reason


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_a_message_passes_the_layer(bench: Bench) -> None:
    speed = bench.sending("speed")
    assert bench.layer.verdict(speed) is None
    assert bench.layer.send(speed, Record(data=0.5)).verdict == "sent"
    bench.hear("/stop")
    verdict = bench.layer.verdict(speed, Record(data=0.5))
    assert verdict is not None
    assert (verdict.reason, verdict.because) == ("requirement", ["requirement speed needs Guard.clear"])
    assert bench.port.sent == [("/speed", {"data": 0.5})]
    refused = bench.layer.send(speed, Record(data=0.5))
    assert (refused.verdict, refused.reason, refused.because) == (
        "refused",
        "requirement",
        ("requirement speed needs Guard.clear",),
    )
    assert bench.port.sent[1:] == [("/speed", {})], "the message of `on_blocked`, with the defaults of ROS"


def test_nodes_that_go_around_the_layer_are_listed(bench: Bench) -> None:
    assert bench.layer.graph_faults() == []
    topic = next(each for each in bench.graph.publishers if each.topic == "/speed")
    bench.port.others = {topic: [Endpoint("/teleop", "std_msgs/Float32")]}
    bench.wait(1.5)
    assert bench.layer.graph_faults() == ["/speed: /teleop publishes it, too, around this layer"]


def test_release_stops_only_what_was_sent(bench: Bench) -> None:
    bench.layer.release()
    assert bench.port.sent == []
    bench.layer.send(bench.sending("speed"), Record(data=0.5))
    bench.start()
    bench.port.goals[0].handlers.accepted()
    bench.wait()
    bench.layer.release()
    bench.wait()
    assert bench.port.sent[1:] == [("/speed", {"data": 0.25})]
    assert bench.port.goals[0].cancels == 1
    assert bench.layer.busy


def test_a_service_answers_fails_or_is_busy(bench: Bench) -> None:
    bench.call()
    bench.call()
    assert last(bench) == ("refused", "busy")
    bench.port.calls[0].answered(Record(success=True))
    bench.wait()
    assert (bench.outcomes[-1].verdict, bench.outcomes[-1].message.success) == ("answered", True)
    bench.call()
    bench.port.calls[1].failed("broken")
    bench.wait()
    assert last(bench) == ("failed", "failed")
    bench.call()
    bench.wait(TIMEOUT + 1)
    assert last(bench) == ("failed", "timeout")
    bench.port.served = False
    bench.call()
    bench.wait(TIMEOUT + 1)
    assert last(bench) == ("failed", "unavailable")
    bench.hear("/stop")
    bench.call()
    assert last(bench) == ("refused", "requirement")
    assert len(bench.outcomes) == 6


@pytest.mark.parametrize("outcome", [GoalOutcome.SUCCEEDED, GoalOutcome.ABORTED, GoalOutcome.CANCELED])
def test_a_goal_runs_to_its_end(bench: Bench, outcome: GoalOutcome) -> None:
    bench.start()
    assert (bench.outcomes, bench.status) == ([], "waiting")
    handlers = bench.port.goals[0].handlers
    # Feedback may arrive before the acceptance.
    handlers.feedback(Record(distance_remaining=0.5))
    bench.wait()
    assert (last(bench), bench.status) == (("accepted", ""), "executing")
    handlers.accepted()
    bench.wait()
    assert (last(bench), bench.status) == (("accepted", ""), "executing")
    handlers.ended(outcome, Record(), "")
    bench.wait()
    assert (len(bench.outcomes), bench.status) == (1, str(outcome))
    bench.start()
    assert len(bench.port.goals) == 2, "the next goal passes"


def test_a_rejected_goal_has_failed(bench: Bench) -> None:
    bench.start()
    bench.port.goals[0].handlers.rejected()
    bench.wait()
    assert (last(bench), bench.status) == (("failed", "rejected"), "rejected")


def test_a_goal_without_server_has_failed(bench: Bench) -> None:
    bench.port.served = False
    bench.start()
    bench.wait(TIMEOUT + 1)
    assert (last(bench), bench.status, bench.port.goals) == (("failed", "unavailable"), "unavailable", [])


def test_a_goal_that_is_canceled_before_it_is_sent(bench: Bench) -> None:
    bench.port.served = False
    bench.start()
    bench.cancel()
    bench.port.served = True
    bench.wait(1)
    assert (last(bench), bench.status, bench.port.goals) == (("failed", "canceled"), "canceled", [])


def test_a_goal_whose_server_dies_is_lost(bench: Bench) -> None:
    bench.start()
    bench.port.goals[0].handlers.accepted()
    bench.wait()
    bench.port.served = False
    bench.wait(TIMEOUT + 1)
    assert (last(bench), bench.status) == (("accepted", ""), "lost")


def test_a_goal_that_is_accepted_too_late_is_canceled(bench: Bench) -> None:
    bench.start()
    bench.wait(TIMEOUT + 1)
    goal = bench.port.goals[0]
    assert (bench.outcomes, goal.cancels) == ([], 1)
    goal.handlers.accepted()
    bench.wait()
    assert (last(bench), goal.cancels, bench.status) == (("accepted", ""), 2, "canceling")
    goal.handlers.cancel_answered(CancelAnswer.ACCEPTED)
    goal.handlers.ended(GoalOutcome.CANCELED, Record(), "")
    bench.wait()
    assert bench.status == "canceled"


def test_a_goal_that_is_never_accepted_is_lost(bench: Bench) -> None:
    bench.start()
    bench.wait(40)
    assert (last(bench), bench.status) == (("failed", "lost"), "lost")
    bench.port.goals[0].handlers.accepted()
    bench.wait()
    assert bench.port.goals[0].cancels == 2, "it counted as lost"


def test_a_cancel_is_repeated_until_the_server_accepts(bench: Bench) -> None:
    bench.start()
    goal = bench.port.goals[0]
    goal.handlers.accepted()
    bench.wait()
    bench.cancel()
    goal.handlers.cancel_answered(CancelAnswer.REFUSED)
    bench.wait(TIMEOUT + 1)
    assert goal.cancels == 2
    goal.handlers.cancel_answered(CancelAnswer.ACCEPTED)
    bench.wait(3 * TIMEOUT)
    assert (goal.cancels, bench.status) == (2, "canceling")


def test_a_violated_assumption_refuses_everything(tmp_path: Path) -> None:
    model = tmp_path / "usher.rscd"
    text = USHER.read_text(encoding="utf-8")
    model.write_text(
        f"{text.rstrip()[:-1]}\n  assume A1: response from resume needs Guard.blocked\n}}\n", encoding="utf-8"
    )
    bench = Bench(model)
    bench.hear("/resume")
    assert bench.layer.send(bench.sending("speed"), Record(data=0.5)).reason == "assumption"
    verdict = bench.layer.verdict(bench.sending("label"))
    assert verdict is not None
    assert (verdict.reason, verdict.because) == ("assumption", bench.layer.violated())


def test_an_integer_outside_of_its_range_is_refused(tmp_path: Path) -> None:
    """The supervisor decides about the data that the robot gets, not about the nearest value in the range."""
    robot = tmp_path / "geared.rscd"
    robot.write_text("""robot Geared {
  component Base {
    incoming message speed with identifier: "/speed", type: integer(0..5) links number
  }
  interface number use Int32 from std_msgs
  requirement speed needs value <= 5 and value >= 0
}
""")
    bench = Bench(robot)
    for value in (6, -1, 2**31 - 1):
        outcome = bench.layer.send(bench.sending("speed"), Record(data=value))
        assert (outcome.verdict, outcome.reason) == ("refused", "data")
        assert list(outcome.because) == [f"its data is {value}, expected 0 to 5"]
    assert bench.layer.send(bench.sending("speed"), Record(data=5)).verdict == "sent"
