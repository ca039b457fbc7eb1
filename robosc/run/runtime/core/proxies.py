"""Services and actions that a layer offers its controller in place of the robot's."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from robosc.run.runtime.core.cancel_requests import CANCELING, CancelRequests, GoalTimes
from robosc.run.runtime.core.clients import LOST, LOST_GOAL, LOST_RESULT, POLL, UNKNOWN_GOAL, Answers, ServiceClient
from robosc.run.runtime.core.port import CancelAnswer, Failure, GoalOutcome

if TYPE_CHECKING:
    from robosc.model import rosgraph
    from robosc.run.runtime.core.event_loop import EventLoop
    from robosc.run.runtime.core.layer import Layer
    from robosc.run.runtime.core.port import Answer, Message, Port


class ServiceProxy:
    """Service offered to the controller as a proxy of the robot's service; `timeout` in seconds."""

    def __init__(
        self, port: Port, event_loop: EventLoop, service: rosgraph.ServiceClient, layer: Layer, timeout: float
    ) -> None:
        self._service = service
        self._layer = layer
        self._waiting: Answer | None = None
        self._client = ServiceClient(port, event_loop, service, timeout, Answers(self._respond, self._fail))

    def call(self, request: Message, answer: Answer) -> None:
        """Handle a call of the controller: forward it if the layer lets it pass."""
        if self._waiting is not None:
            self._layer.reject(self._service.request)
            answer.give()
        elif self._layer.forwarded(self._service.request, request) is None:
            answer.give()
        else:
            self._waiting = answer
            self._client.call(request)

    def _respond(self, response: Message) -> None:
        self._layer.respond(self._service, response)
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.give(response)

    def _fail(self, reason: Failure, why: str, _: Message) -> None:
        self._layer.fail(self._service, reason, why)
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.give()


@dataclass(eq=False)
class ProxiedGoal:
    """Goal of the controller; `request` is the message that it sent.

    `canceled`: the layer cancels it. `late`: the robot has not accepted it in time. `over`: it has ended, and its
    result is pending.
    """

    identifier: Any
    request: Message
    sent: bool = False
    accepted: bool = False
    canceled: bool = False
    late: bool = False
    over: bool = False


_Goal = TypeVar("_Goal", bound=ProxiedGoal)


class ActionProxy(ABC, Generic[_Goal]):
    """Action offered to the controller as a proxy of the robot's action, with one goal at a time.

    Goals keep their identity. The timeout also bounds how long the server may be gone while it has the goal.
    """

    def __init__(
        self,
        port: Port,
        event_loop: EventLoop,
        action: rosgraph.ActionClient,
        layer: Layer,
        times: GoalTimes,
    ) -> None:
        self._port = port
        self._event_loop = event_loop
        self._action = action
        self._layer = layer
        self._times = times
        self._goal: _Goal | None = None
        self._deadline = 0.0
        self._requests = self._new_requests()

    def _new_requests(self) -> CancelRequests:
        def send() -> None:
            if self._goal is not None:
                self._send_cancel(self._goal)

        return CancelRequests(self._event_loop, self._times, send, self._warn)

    # Interface to the middleware

    @abstractmethod
    def _is_served(self, goal: _Goal) -> bool:
        """Return whether the robot's server is available, as far as the goal needs it now."""

    @abstractmethod
    def _send(self, goal: _Goal) -> bool:
        """Send the goal to the robot; return whether it could be sent."""

    @abstractmethod
    def _send_cancel(self, goal: _Goal) -> None:
        """Send a request to cancel the goal to the robot."""

    @abstractmethod
    def _is_canceling(self, goal: _Goal) -> bool:
        """Return whether the robot reports that the goal is being canceled."""

    @abstractmethod
    def _end(self, goal: _Goal) -> None:
        """Report the end of a goal to the controller if the robot sends none."""

    # Interface to the layer

    def cancel(self) -> None:
        """Cancel the present goal, as soon as the robot has accepted it."""
        goal = self._goal
        if goal is not None:
            goal.canceled = True
            if goal.accepted and not goal.over:
                self._requests.ask()

    @property
    def trouble(self) -> str:
        """Why the goal has not ended though it should have; empty if nothing is wrong."""
        waiting = self._goal is not None and self._goal.late and not self._goal.accepted
        return self._not_accepted if waiting else self._requests.trouble

    @property
    def waits(self) -> bool:
        """Whether the stopping layer waits: for the acceptance of a goal that it cancels, the answer, or the end."""
        goal = self._goal
        if goal is None or not goal.canceled or goal.over:
            return False
        return self._requests.waits or (not goal.accepted and not goal.late)

    def leave(self) -> None:
        """Report a goal that the layer has canceled and that has not ended when the layer ends."""
        goal = self._goal
        if goal is not None and goal.canceled and not goal.over:
            running = "the goal has not ended" if goal.accepted else "the goal may still begin"
            why = CANCELING if self._requests.accepted else self.trouble or "the server has not answered"
            self._warn(f"{running} when this layer ends: {why}")

    @property
    def _not_accepted(self) -> str:
        return f"not accepted {self._times.within}"

    def _receive_goal(self, goal: _Goal, data: Message) -> None:
        """Handle a goal of the controller with its data: forward it if the layer lets it pass."""
        if self._goal is not None:
            self._layer.reject(self._action.request)
            self._end(goal)
            return
        self._goal = goal
        self._requests = self._new_requests()
        if self._layer.forwarded(self._action.request, data) is not None:
            self._deadline = self._event_loop.clock() + self._times.timeout
            self._poll(goal)
        else:
            self._goal = None
            self._end(goal)

    def _at_hand(self, identifier: Any) -> _Goal | None:
        """Return the present goal if it has this identifier, else None."""
        return self._goal if self._goal is not None and self._goal.identifier == identifier else None

    def _accept(self, goal: _Goal) -> None:
        """Record that the robot has accepted the goal."""
        if not goal.accepted:
            goal.accepted = True
            self._deadline = self._event_loop.clock() + self._times.timeout
            if goal.canceled:
                self._requests.ask()

    def _cancel_answered(self, goal: _Goal, answer: CancelAnswer) -> None:
        """Handle the robot's answer to a request of the layer to cancel a goal."""
        if self._goal is not goal:
            return
        if answer is CancelAnswer.ACCEPTED:
            self._requests.accept()
        elif goal.accepted and not goal.over and not self._requests.accepted:
            match answer:
                case CancelAnswer.REFUSED:
                    self._requests.refuse()
                case CancelAnswer.TERMINATED:
                    self._await_result(goal)
                case CancelAnswer.UNKNOWN:
                    self._give_up(goal, Failure.LOST, UNKNOWN_GOAL)

    def _await_result(self, goal: _Goal) -> None:
        """Wait for the result of a goal that has ended."""
        if not goal.over:
            goal.over = True
            self._requests.stop()
            self._deadline = self._event_loop.clock() + self._times.timeout

    def _resume(self, goal: _Goal) -> None:
        """Record that the goal has not ended after all."""
        goal.over = False
        self._requests = self._new_requests()

    def _receive_feedback(self, identifier: Any, feedback: Message) -> bool:
        """Handle feedback of the robot; return whether it is forwarded."""
        goal = self._at_hand(identifier)
        if goal is not None:
            self._layer.feed_back(self._action, feedback)
        return goal is not None

    def _receive_end(self, goal: _Goal, outcome: GoalOutcome, result: Message) -> None:
        """Handle the end of the present goal by the robot."""
        self._forget()
        late = Failure.TIMEOUT if goal.late else None
        match outcome:
            case GoalOutcome.SUCCEEDED:
                self._layer.respond(self._action, result)
            case GoalOutcome.CANCELED:
                self._layer.end_canceled(self._action, late or Failure.CANCELED, "canceled", result)
            case GoalOutcome.ABORTED:
                self._layer.fail(self._action, late or Failure.ABORTED, "aborted", result)
            case GoalOutcome.LOST:
                self._layer.fail(self._action, Failure.LOST, LOST_GOAL)

    def _give_up(self, goal: _Goal, reason: Failure, why: str) -> None:
        """End a goal without a result, or with an unknown fate."""
        self._forget()
        if reason is Failure.CANCELED:
            self._layer.end_canceled(self._action, reason, why)
        else:
            self._layer.fail(self._action, reason, why)
        self._end(goal)

    def _forget(self) -> None:
        self._goal = None
        self._requests.stop()

    def _poll(self, goal: _Goal) -> None:
        """Send the goal as soon as there is a server; then watch that it is accepted and that the server stays."""
        if self._goal is not goal:
            return
        now = self._event_loop.clock()
        if goal.canceled and not goal.sent:
            self._give_up(goal, Failure.CANCELED, "canceled before it was sent")
            return
        served = self._is_served(goal)
        if served and not goal.sent and self._send(goal):
            goal.sent = True
        elif served and goal.accepted and not goal.over:
            self._deadline = now + self._times.timeout
        elif now >= self._deadline:
            self._expire(goal, now)
        self._event_loop.call_later(POLL, lambda: self._poll(goal))

    def _expire(self, goal: _Goal, now: float) -> None:
        if goal.over and self._is_canceling(goal):
            # Another client canceled it before: a server calls that terminated, too.
            self._resume(goal)
            self._requests.accept()
        elif goal.over:
            self._give_up(goal, Failure.LOST, f"{LOST_RESULT} {self._times.within}")
        elif goal.accepted:
            self._give_up(goal, Failure.LOST, "the server is gone")
        elif goal.late:
            self._give_up(goal, Failure.LOST, "neither accepted nor rejected")
        elif goal.sent:
            # The robot might still accept it: then it is canceled.
            self._warn(self._not_accepted)
            goal.late = goal.canceled = True
            self._deadline = now + LOST
            self._send_cancel(goal)  # the robot may have accepted it already
        else:
            self._give_up(goal, Failure.UNAVAILABLE, f"no server {self._times.within}")

    def _warn(self, why: str) -> None:
        self._port.warn(f"{self._action.identifier}: {why}")
