"""Clients of services and actions: every call and goal has exactly one end, in bounded time."""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from robosc.run.runtime.core.cancel_requests import CANCELING, FAREWELL, CancelRequests, GoalTimes
from robosc.run.runtime.core.port import CallHandlers, CancelAnswer, Failure, GoalHandlers, GoalOutcome

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.model import rosgraph
    from robosc.run.runtime.core.event_loop import EventLoop, Timer
    from robosc.run.runtime.core.port import ControllerPort, Goal, Message, Port

#: Seconds between two looks for a server.
POLL = 0.05
#: Seconds without a message of a goal that was not accepted in time, after which it counts as lost.
LOST = 30.0
LOST_RESULT = "the goal has ended, but its result did not come"
LOST_GOAL = "the server has lost the goal"
UNKNOWN_GOAL = "the server does not know the goal"


@dataclass(frozen=True)
class Answers:
    """Callbacks of a client, after the request has returned: any number of `feedback`, then one of the others.

    `error` gets the reason, a text, and the result of the goal, None if there is none. `canceled` gets the same; its
    reason applies if the model did not cancel the goal.
    """

    response: Callable[[Message], None]
    error: Callable[[Failure, str, Message], None]
    feedback: Callable[[Message], None] = lambda _: None
    canceled: Callable[[Failure, str, Message], None] = lambda *_: None


class ServiceClient:
    """Client of one service. No server, a failed call and no answer in time are errors; late answers are dropped.

    `timeout`, in seconds, bounds the search for a server together with the wait for the answer.
    """

    def __init__(
        self, port: Port, event_loop: EventLoop, client: rosgraph.ServiceClient, timeout: float, answers: Answers
    ) -> None:
        self._port = port
        self._event_loop = event_loop
        self._client = client
        self._timeout = timeout
        self._answers = answers
        self._number = 0
        self._deadline: Timer | None = None
        self._missing = (Failure.UNAVAILABLE, "no server")

    @property
    def waiting(self) -> bool:
        """Whether an answer is pending."""
        return self._deadline is not None

    def call(self, request: Message) -> None:
        """Call the service; abandon a call that is still under way."""
        self.give_up()
        number = self._number
        self._missing = (Failure.UNAVAILABLE, "no server")
        self._deadline = self._event_loop.call_later(self._timeout, lambda: self._expire(number))
        self._poll(number, request)

    def _poll(self, number: int, request: Message) -> None:
        """Send the request as soon as there is a server."""
        if number != self._number:
            return
        if not self._port.is_served(self._client):
            self._event_loop.call_later(POLL, lambda: self._poll(number, request))
            return
        self._missing = (Failure.TIMEOUT, "no answer")
        handlers = CallHandlers(
            lambda response: self._event_loop.post(lambda: self._succeed(number, response)),
            lambda why: self._event_loop.post(
                lambda: self._fail(number, Failure.FAILED, f"the call failed: {why}" if why else "the call failed")
            ),
        )
        try:
            self._port.call(self._client, request, handlers)
        except Exception as error:  # any exception of the middleware is a failed call
            handlers.failed(str(error))

    def give_up(self) -> None:
        """Abandon the call under way: its answer is dropped."""
        self._number += 1
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def fail(self, reason: Failure, why: str) -> None:
        """Fail the call under way for a reason other than an answer of a server."""
        number = self._number
        self._event_loop.post(lambda: self._fail(number, reason, why))

    def _succeed(self, number: int, response: Message) -> None:
        if number == self._number and self.waiting:
            self.give_up()
            self._answers.response(response)

    def _expire(self, number: int) -> None:
        reason, missing = self._missing
        self._fail(number, reason, f"{missing} within {round(self._timeout * 1000)} ms")

    def _fail(self, number: int, reason: Failure, why: str) -> None:
        if number == self._number and self.waiting:
            self.give_up()
            self._answers.error(reason, why, None)


class _Phase(Enum):
    IDLE = 0
    LOOKING = 1
    SENT = 2
    ACCEPTED = 3
    OVER = 4


class ActionClient:
    """Client of one action, with one goal at a time. Each goal has exactly one end, reported when it is known."""

    def __init__(
        self,
        port: ControllerPort,
        event_loop: EventLoop,
        client: rosgraph.ActionClient,
        times: GoalTimes,
        answers: Answers,
    ) -> None:
        self._port = port
        self._event_loop = event_loop
        self._client = client
        self._times = times
        self._answers = answers
        self._number = 0
        self._phase = _Phase.IDLE
        self._goal: Goal | None = None
        self._lost: dict[int, Goal] = {}
        self._canceling = self._late = False
        self._requests = self._new_requests()
        self._deadline: Timer | None = None
        self._until = 0.0

    def _new_requests(self) -> CancelRequests:
        return CancelRequests(self._event_loop, self._times, self._send_cancel, self._warn)

    def _send_cancel(self) -> None:
        assert self._goal is not None
        self._goal.cancel()

    def _warn(self, text: str) -> None:
        self._port.warn(f"{self._client.identifier}: {text}")

    @property
    def busy(self) -> bool:
        """Whether there is a goal whose end is not known."""
        return self._phase is not _Phase.IDLE

    @property
    def trouble(self) -> str:
        """Why the goal has not ended though it should have; empty if nothing is wrong."""
        return self._not_accepted if self._late and self._phase is _Phase.SENT else self._requests.trouble

    @property
    def waits(self) -> bool:
        """Whether the stopping node waits: for the goal's acceptance, the answer to a cancel request, or the end."""
        if self._phase is _Phase.ACCEPTED:
            return self._requests.waits
        return self.busy and time.monotonic() < self._until

    @property
    def _not_accepted(self) -> str:
        return f"not accepted {self._times.within}"

    def start(self, goal: Message) -> None:
        """Send a goal as soon as there is a server. Precondition: no other goal is under way."""
        assert not self.busy
        self._phase = _Phase.LOOKING
        self._until = time.monotonic() + self._times.timeout
        self._set_deadline(self._expire)
        self._poll(self._number, goal)

    def cancel(self) -> None:
        """Cancel the goal, as soon as it is accepted."""
        if not self.busy:
            return
        self._canceling = True
        if self._phase is _Phase.LOOKING:
            number, why = self._number, "canceled before it was sent"
            end = lambda: self._end_canceled(why, None)  # noqa: E731
            self._event_loop.post(lambda: self._if_current(number, end))
        elif self._phase is _Phase.ACCEPTED:
            self._requests.ask()
            self._requests.extend()

    def fail(self, reason: Failure, why: str, result: Message = None) -> None:
        """Fail the present goal for a reason other than an answer of a server."""
        number = self._number
        self._event_loop.post(lambda: self._if_current(number, lambda: self._fail(reason, why, result), over=True))

    def leave(self) -> None:
        """Abandon the goal as the node stops, and report its state."""
        if self._phase in (_Phase.SENT, _Phase.ACCEPTED):
            running = "the goal may still begin" if self._phase is _Phase.SENT else "the goal has not ended"
            why = CANCELING if self._requests.accepted else self.trouble or "the server has not answered"
            self._warn(f"{running} when this node ends: {why}")
        if self._goal is not None and not self._requests.sent and self._phase is not _Phase.OVER:
            self._goal.cancel()
        self._reset()

    def _reset(self) -> None:
        self._number += 1
        self._phase = _Phase.IDLE
        self._goal = None
        self._canceling = self._late = False
        self._requests.stop()
        self._requests = self._new_requests()
        self._set_deadline(None)

    def _set_deadline(self, action: Callable[[], None] | None, seconds: float | None = None) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None
        if action is not None:
            self._deadline = self._event_loop.call_later(self._times.timeout if seconds is None else seconds, action)

    def _is_current(self, number: int) -> bool:
        return number == self._number and self.busy

    def _poll(self, number: int, goal: Message) -> None:
        """Send the goal as soon as there is a server; then watch that the server stays."""
        if not self._is_current(number):
            return
        if self._phase is _Phase.LOOKING:
            if not self._canceling and self._port.is_served(self._client):
                self._send(number, goal)
        elif self._goal is not None and self._goal.is_gone():
            self._lose("the server is gone")
            return
        self._event_loop.call_later(POLL, lambda: self._poll(number, goal))

    def _send(self, number: int, goal: Message) -> None:
        self._phase = _Phase.SENT
        try:
            self._goal = self._port.send_goal(self._client, goal, self._handlers(number))
        except Exception as error:  # any exception of the middleware means that the goal was not sent
            why = f"the goal cannot be sent: {error}"
            fail = lambda: self._fail(Failure.UNAVAILABLE, why)  # noqa: E731
            self._event_loop.post(lambda: self._if_current(number, fail))

    def _handlers(self, number: int) -> GoalHandlers:
        def later(action: Callable[[], None]) -> None:
            self._event_loop.post(lambda: self._if_current(number, action))

        def last(action: Callable[[], None]) -> None:
            self._event_loop.post(lambda: self._if_current(number, action, over=True))

        return GoalHandlers(
            accepted=lambda: later(self._accept),
            rejected=lambda: last(lambda: self._fail(Failure.REJECTED, "rejected")),
            feedback=lambda feedback: later(lambda: self._feedback(feedback)),
            ended=lambda outcome, result, text: last(lambda: self._finish(outcome, result, text)),
            cancel_answered=lambda answer: later(lambda: self._cancel_answered(answer)),
        )

    def _if_current(self, number: int, action: Callable[[], None], *, over: bool = False) -> None:
        """Run an action for the present goal. Cancel a goal that counted as lost, unless it is `over`."""
        if self._is_current(number):
            action()
            return
        lost = self._lost.pop(number, None)
        if lost is not None and not over:
            lost.cancel()

    def _accept(self) -> None:
        if self._phase is _Phase.SENT:
            self._phase = _Phase.ACCEPTED
            self._set_deadline(None)
            if self._canceling:
                self._requests.ask()

    def _feedback(self, feedback: Message) -> None:
        self._accept()  # feedback may arrive before the acceptance
        self._answers.feedback(feedback)

    def _cancel_answered(self, answer: CancelAnswer) -> None:
        if answer is CancelAnswer.ACCEPTED:
            self._requests.accept()
            self._accept()
        elif self._phase is _Phase.ACCEPTED and not self._requests.accepted:
            match answer:
                case CancelAnswer.REFUSED:
                    self._requests.refuse()
                case CancelAnswer.TERMINATED:
                    self._await_result()
                case CancelAnswer.UNKNOWN:
                    self._lose(UNKNOWN_GOAL)

    def _await_result(self) -> None:
        self._phase = _Phase.OVER
        self._until = time.monotonic() + FAREWELL
        self._requests.stop()
        self._set_deadline(self._result_missing)

    def _result_missing(self) -> None:
        if self._goal is not None and self._goal.is_canceling():
            # Another client canceled it before: a server calls that terminated, too.
            self._phase = _Phase.ACCEPTED
            self._requests = self._new_requests()
            self._requests.accept()
        else:
            self._lose(f"{LOST_RESULT} {self._times.within}")

    def _expire(self) -> None:
        if self._phase is _Phase.LOOKING:
            self._fail(Failure.UNAVAILABLE, f"no server {self._times.within}")
            return
        # The server might still accept it: then it is canceled.
        self._warn(self._not_accepted)
        self._late = self._canceling = True
        if self._goal is not None:
            self._goal.cancel()  # the server may have accepted it already
        self._set_deadline(lambda: self._lose("neither accepted nor rejected"), LOST)

    def _finish(self, outcome: GoalOutcome, result: Message, text: str) -> None:
        suffix = f": {text}" if text else ""
        match outcome:
            case GoalOutcome.SUCCEEDED:
                self._reset()
                self._answers.response(result)
            case GoalOutcome.CANCELED:
                own = "canceled by the controller itself, an error to the model"
                self._end_canceled(f"{own if self._canceling else 'canceled by someone else'}{suffix}", result)
            case GoalOutcome.ABORTED:
                self._fail(Failure.ABORTED, f"aborted{suffix}", result)
            case GoalOutcome.LOST:
                self._lose(f"{LOST_GOAL}{suffix}")

    def _end_canceled(self, why: str, result: Message) -> None:
        late = self._late
        self._reset()
        if late:
            self._answers.canceled(Failure.TIMEOUT, "accepted too late, then canceled", result)
        else:
            self._answers.canceled(Failure.CANCELED, why, result)

    def _fail(self, reason: Failure, why: str, result: Message = None) -> None:
        if self._late and reason is Failure.ABORTED:
            reason, why = Failure.TIMEOUT, f"accepted too late, then {why}"
        self._reset()
        self._answers.error(reason, why, result)

    def _lose(self, why: str) -> None:
        """End with `lost`: the fate of the goal is unknown. If the goal appears again, it is canceled."""
        if self._goal is not None:
            self._lost[self._number] = self._goal
        self._fail(Failure.LOST, why)
