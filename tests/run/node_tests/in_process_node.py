"""A controller as a node without ROS: the player plays traces against it as against a real node."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.base.ros_types import RosTypes
from robosc.language.configuration.parameters import controller_parameters
from robosc.run.node_tests.drive import parameters
from robosc.run.node_tests.messages import leaf_values
from robosc.run.node_tests.robot import PlayedRequest, Robot, RunningGoal
from robosc.run.node_tests.samples import all_incoming
from robosc.run.node_tests.trace_player import START, Port, answered, cancelled, fed_back
from robosc.run.runtime.core.controller import Controller
from robosc.run.runtime.core.event_log import EventLog
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.port import CancelAnswer, GoalOutcome
from robosc.run.runtime.core.settings import Settings

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from queue import Queue

    from robosc.base.ros_types import RosDistribution
    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph, sct
    from robosc.run.runtime.core.port import CallHandlers, GoalHandlers

_OUTCOMES = {"succeeded": GoalOutcome.SUCCEEDED, "aborted": GoalOutcome.ABORTED, "canceled": GoalOutcome.CANCELED}


class _Goal(RunningGoal):
    asked: Callable[[], None]

    def cancel(self) -> None:
        super().cancel()
        self.asked()
        # The player's servers behave like this: the client repeats an unanswered request.
        self.handlers.cancel_answered(CancelAnswer.ACCEPTED)


class _Robot(Robot):
    """A robot that passes all sent data to the player."""

    port: Port

    def publish(self, publisher: rosgraph.Publisher, message: Any) -> None:
        self.port.sent[publisher.topic].put(message)

    def call(self, client: rosgraph.ServiceClient, request: Any, handlers: CallHandlers) -> None:
        super().call(client, request, handlers)
        self.port.sent[client.identifier].put(request)

    def send_goal(self, client: rosgraph.ActionClient, goal: Any, handlers: GoalHandlers) -> RunningGoal:
        made = _Goal(handlers)
        made.asked = lambda: self.port.sent[cancelled(client.identifier)].put(None)
        self.goals[client] = made
        handlers.accepted()
        self.port.sent[client.identifier].put(goal)
        return made


class Client(PlayedRequest):
    """A client that passes all answers to the player."""

    def __init__(self, answers: Queue[Any], feedback: Queue[Any] | None = None) -> None:
        self._answers = answers
        self.feedback = feedback

    def give(self, response: Any = None) -> None:
        self._answers.put(response)

    def feed_back(self, feedback: Any) -> None:
        assert self.feedback is not None
        self.feedback.put(feedback)

    def end(self, outcome: GoalOutcome, result: Any) -> None:
        self._answers.put((outcome.value, result))


class _AtOnce(EventLog):
    """A log that writes each line to its file immediately."""

    active = True

    def __init__(self, path: Path) -> None:
        super().__init__("")
        self._file = path.open("a", encoding="utf-8", buffering=1)

    def append(self, line: str) -> None:
        self._file.write(line)

    def close(self) -> None:
        self._file.close()


class InProcessNode(Port):
    """The node of a graph, which writes its event log to a file."""

    def __init__(
        self, connections: dict[str, Any], graph: rosgraph.RosGraph, configuration: Configuration, log: Path
    ) -> None:
        super().__init__(connections)
        distribution: RosDistribution = RosTypes().distributions[0]
        self._now = START * connections["period"]
        self._graph = graph
        self._incoming = all_incoming(graph, distribution)
        self._robot = _Robot(graph, distribution, lambda: self._now, self._incoming)
        self._robot.port = self
        self._event_loop = EventLoop(lambda: self._now)
        values = {parameter.name: parameter.default for parameter in controller_parameters(graph, configuration, "")}
        settings = Settings(values | parameters(graph, configuration), configuration)
        self._controller = Controller(graph, settings, self._robot, self._event_loop)
        self._controller.log_to(_AtOnce(log))

    def connect(self) -> None:
        self._controller.start()

    def set_time(self, seconds: float) -> None:
        self._now = seconds
        self._work()

    def publish(self, topic: str, fields: dict[str, Any]) -> None:
        subscription = next(known for known in self._graph.subscriptions if known.topic == topic)
        self._controller.receive(subscription, self._made(subscription.receptions[0].event, fields))
        self._work()

    def answer(self, service: str, fields: dict[str, Any]) -> None:
        client, (_, handlers) = next(call for call in self._robot.calls.items() if call[0].identifier == service)
        handlers.answered(self._made(client.response.event, fields))
        self._work()

    def fail(self, service: str) -> None:
        """Leave the call unanswered, as in ROS 2."""

    def feed_back(self, action: str, fields: dict[str, Any]) -> None:
        client, goal = self._goal(action)
        goal.handlers.feedback(self._made(client.feedback.event, fields))
        self._work()

    def end(self, action: str, outcome: str, fields: dict[str, Any]) -> None:
        client, goal = self._goal(action)
        ends = {"succeeded": client.response, "aborted": client.error, "canceled": client.canceled}
        goal.handlers.ended(_OUTCOMES[outcome], self._made(ends[outcome].event, fields), "")
        self._work()

    def call(self, service: str, fields: dict[str, Any]) -> None:
        server = next(server for server in self._graph.serviceServers if server.identifier == service)
        request = self._made(server.request.event, fields)
        self._controller.services[server].call(request, Client(self.sent[answered(service)]))
        self._work()

    def send_goal(self, action: str, fields: dict[str, Any]) -> None:
        server = next(server for server in self._graph.actionServers if server.identifier == action)
        goal = self._made(server.request.event, fields)
        if self._controller.actions[server].accepts(goal):
            client = Client(self.sent[answered(action)], self.sent[fed_back(action)])
            self._controller.actions[server].begin(client, goal)
        self._work()

    def cancel(self, action: str) -> None:
        server = next(server for server in self._graph.actionServers if server.identifier == action)
        assert self._controller.actions[server].cancel()
        self._work()

    def _goal(self, action: str) -> tuple[rosgraph.ActionClient, RunningGoal]:
        return next(goal for goal in self._robot.goals.items() if goal[0].identifier == action)

    def _made(self, event: sct.Event, fields: dict[str, Any]) -> Any:
        return self._incoming[event].message(leaf_values(fields))

    def _work(self) -> None:
        while self._event_loop.run_pending() == 0:
            pass
