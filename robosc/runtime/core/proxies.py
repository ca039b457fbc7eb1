"""What a layer offers its controller in the place of the robot's services and actions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from robosc.runtime.core.clients import POLL, Answers, ServiceClient

if TYPE_CHECKING:
    from robosc.metamodel import rosgraph
    from robosc.runtime.core.event_loop import EventLoop
    from robosc.runtime.core.layer import Layer
    from robosc.runtime.core.port import Message, Port


class Answer(Protocol):
    """The answer that a caller of the layer waits for; exactly one of these is called."""

    def give(self, response: Message) -> None:
        """The response."""

    def fail(self, why: str) -> None:
        """There is none: an error in ROS 1, in ROS 2, which knows none, the response that nothing was set in."""


class ServiceProxy:
    """A service for the controller behind which stands the robot's one; `timeout` in seconds."""

    def __init__(
        self, port: Port, event_loop: EventLoop, service: rosgraph.ServiceClient, layer: Layer, timeout: float
    ) -> None:
        self._service = service
        self._layer = layer
        self._waiting: Answer | None = None
        self._client = ServiceClient(port, event_loop, service, timeout, Answers(self._respond, self._fail))

    def call(self, request: Message, answer: Answer) -> None:
        """A call of the controller's, which is forwarded where the layer lets it pass."""
        if self._waiting is not None:
            self._layer.reject(self._service.request)
            answer.fail("blocked: another call waits")
        elif not self._layer.passes(self._service.request):
            answer.fail("blocked by the supervisor")
        else:
            self._waiting = answer
            self._client.call(request)

    def _respond(self, response: Message) -> None:
        self._layer.respond(self._service, response)
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.give(response)

    def _fail(self, why: str) -> None:
        self._layer.fail(self._service, why)
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.fail(why)


@dataclass(eq=False)
class ProxiedGoal:
    """A goal of the controller's: `request` is what it sent. `cancelled`: by the supervisor."""

    identifier: Any
    request: Message
    sent: bool = False
    accepted: bool = False
    cancelled: bool = False


_Goal = TypeVar("_Goal", bound=ProxiedGoal)


class ActionProxy(ABC, Generic[_Goal]):
    """An action for the controller behind which stands the robot's one, with one goal at a time.

    Goals keep their identity. `timeout`, in seconds, bounds the search for a server with the wait for acceptance, and
    how long the server may be gone while it has the goal.
    """

    def __init__(
        self, port: Port, event_loop: EventLoop, action: rosgraph.ActionClient, layer: Layer, timeout: float
    ) -> None:
        self._port = port
        self._event_loop = event_loop
        self._action = action
        self._layer = layer
        self._timeout = timeout
        self._goal: _Goal | None = None
        self._deadline = 0.0

    # What the middleware does

    @abstractmethod
    def _is_served(self, goal: _Goal) -> bool:
        """Whether the robot's server is there, as far as the goal needs it now."""

    @abstractmethod
    def _send(self, goal: _Goal) -> bool:
        """Sends the goal to the robot; whether it could be sent."""

    @abstractmethod
    def _send_cancel(self, goal: _Goal) -> None:
        """Asks the robot to cancel the goal."""

    @abstractmethod
    def _end(self, goal: _Goal, why: str) -> None:
        """Tells the controller of the end of a goal that the robot says nothing of; one that was sent is cancelled."""

    def _watch(self, goal: _Goal, now: float) -> None:  # noqa: ARG002  # ROS 1 looks at the goal
        """The server is there and has the goal."""
        self._deadline = now + self._timeout

    # What the layer does

    def cancel(self) -> None:
        """Cancels the goal at hand, before the robot has accepted it as soon as it does."""
        goal = self._goal
        if goal is not None and not goal.cancelled:
            goal.cancelled = True
            if goal.accepted:
                self._send_cancel(goal)

    def _receive_goal(self, goal: _Goal) -> None:
        """A goal of the controller's, which is forwarded where the layer lets it pass."""
        if self._goal is not None:
            self._layer.reject(self._action.request)
            self._end(goal, "blocked: another goal has not ended")
            return
        self._goal = goal
        if self._layer.passes(self._action.request):
            self._deadline = self._event_loop.clock() + self._timeout
            self._poll(goal)
        else:
            self._goal = None
            self._end(goal, "blocked by the supervisor")

    def _at_hand(self, identifier: Any) -> _Goal | None:
        """The goal at hand, if it is the one with this identifier."""
        return self._goal if self._goal is not None and self._goal.identifier == identifier else None

    def _receive_feedback(self, identifier: Any, feedback: Message) -> bool:
        """Feedback of the robot's; whether it is forwarded."""
        goal = self._at_hand(identifier)
        if goal is not None:
            self._layer.feed_back(self._action, feedback)
        return goal is not None

    def _receive_end(self, goal: _Goal, result: Message, failure: str | None) -> None:
        """The robot has ended the goal at hand: it has failed, for a reason, or succeeded with a result."""
        if failure is None:
            self._layer.respond(self._action, result)
        else:
            self._fail(goal, failure)
        self._goal = None

    def _fail(self, goal: _Goal, why: str) -> None:
        if goal.cancelled and why.startswith("cancelled"):
            self._layer.cancel_ended(self._action)
        else:
            self._layer.fail(self._action, why)

    def _give_up(self, goal: _Goal, why: str) -> None:
        """Nobody waits for the goal any more."""
        self._fail(goal, why)
        self._goal = None
        self._end(goal, why)

    def _poll(self, goal: _Goal) -> None:
        """Sends the goal as soon as there is a server; then watches that it is accepted and stays."""
        if self._goal is not goal:
            return
        now = self._event_loop.clock()
        if goal.cancelled and not goal.sent:
            self._give_up(goal, "cancelled before it was sent")
            return
        served = self._is_served(goal)
        if served and not goal.sent and self._send(goal):
            goal.sent = True
        elif served and goal.accepted:
            self._watch(goal, now)
        elif now >= self._deadline:
            within = f" within {round(self._timeout * 1000)} ms"
            missing = ("not accepted" if goal.sent else "no server") + within
            self._give_up(goal, "the server is gone" if goal.accepted else missing)
            return
        self._event_loop.call_later(POLL, lambda: self._poll(goal))

    def _warn(self, why: str) -> None:
        self._port.warn(f"{self._action.identifier}: {why}")
