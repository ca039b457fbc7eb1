"""Clients of services and actions: every call and goal comes to exactly one end, in time."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from robosc.runtime.core.port import CallHandlers, GoalHandlers, Outcome

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.metamodel import rosgraph
    from robosc.runtime.core.event_loop import EventLoop, Timer
    from robosc.runtime.core.port import ControllerPort, Goal, Message, Port

#: Seconds from one look for a server to the next.
POLL = 0.05
#: Seconds after its time for acceptance is over in which a goal may still begin; then it counts as lost.
LOST = 30.0
REFUSED = "the server refuses to cancel the goal"
LOST_RESULT = "the goal has ended, but its result did not come"


@dataclass(frozen=True)
class Answers:
    """What a client calls, never before what was asked of it returns. `error` gets the reason.

    Of an action: any number of `feedback`, then one of the others; `ended`: the goal that was cancelled is over.
    """

    response: Callable[[Message], None]
    error: Callable[[str], None]
    feedback: Callable[[Message], None] = lambda _: None
    ended: Callable[[], None] = lambda: None


class ServiceClient:
    """A client of one service: no server, a failed call, no answer in time are errors; what comes late is dropped.

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
        self._unanswered = ""

    @property
    def waiting(self) -> bool:
        """Whether an answer is still to come."""
        return self._deadline is not None

    def call(self, request: Message) -> None:
        """Calls the service; a call that is still under way is given up."""
        self.give_up()
        number = self._number
        self._unanswered = "no server"
        within = f"within {round(self._timeout * 1000)} ms"
        self._deadline = self._event_loop.call_later(
            self._timeout, lambda: self._fail(number, f"{self._unanswered} {within}")
        )
        self._poll(number, request)

    def _poll(self, number: int, request: Message) -> None:
        """Sends the request as soon as there is a server."""
        if number != self._number:
            return
        if not self._port.is_served(self._client):
            self._event_loop.call_later(POLL, lambda: self._poll(number, request))
            return
        self._unanswered = "no answer"
        handlers = CallHandlers(
            lambda response: self._event_loop.post(lambda: self._succeed(number, response)),
            lambda why: self._event_loop.post(
                lambda: self._fail(number, f"the call failed: {why}" if why else "the call failed")
            ),
        )
        try:
            self._port.call(self._client, request, handlers)
        except Exception as error:  # whatever the middleware raises is a failed call
            handlers.failed(str(error))

    def give_up(self) -> None:
        """Abandons the call that is under way: whatever comes of it is dropped."""
        self._number += 1
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _succeed(self, number: int, response: Message) -> None:
        if number == self._number and self.waiting:
            self.give_up()
            self._answers.response(response)

    def _fail(self, number: int, why: str) -> None:
        if number == self._number and self.waiting:
            self.give_up()
            self._answers.error(why)


class _Phase(Enum):
    IDLE = 0
    LOOKING = 1
    SENT = 2
    ACCEPTED = 3
    OVER = 4


class ActionClient:
    """A client of one action, with one goal at a time.

    `timeout`, in seconds, bounds the search for a server together with the wait for acceptance, never the goal's work.
    """

    def __init__(
        self,
        port: ControllerPort,
        event_loop: EventLoop,
        client: rosgraph.ActionClient,
        timeout: float,
        answers: Answers,
    ) -> None:
        self._port = port
        self._event_loop = event_loop
        self._client = client
        self._timeout = timeout
        self._answers = answers
        self._number = 0
        self._phase = _Phase.IDLE
        self._goal: Goal | None = None
        self._lost: dict[int, Goal] = {}
        self._cancelling = False
        self._asked = False
        self._deadline: Timer | None = None
        self._until = 0.0

    @property
    def busy(self) -> bool:
        """Whether there is a goal that has not ended yet; until then no other may start."""
        return self._phase is not _Phase.IDLE

    @property
    def unanswered(self) -> float:
        """Seconds that are left for the goal to be accepted or rejected; 0 where none was sent."""
        left = self._until - self._event_loop.clock() if self._phase is _Phase.SENT else 0.0
        return min(max(0.0, left), self._timeout)

    def start(self, goal: Message) -> None:
        """Sends a goal as soon as there is a server. A goal that has not ended is given up."""
        self.give_up()
        self._phase = _Phase.LOOKING
        self._until = self._event_loop.clock() + self._timeout
        self._set_deadline(self._expire)
        self._poll(self._number, goal)

    def cancel(self, *, expected: bool = True) -> None:
        """Cancels the goal, where it was not accepted yet as soon as it is.

        `expected`: the model knows of it, and `ended` follows; else the end of the goal is an error to the model.
        """
        if not self.busy or self._asked:
            return
        self._asked, self._cancelling = True, expected
        number = self._number
        if self._phase is _Phase.LOOKING:
            self._event_loop.post(lambda: self._if_current(number, lambda: self._end(_OWN)))
        elif self._phase is _Phase.ACCEPTED:
            self._ask_to_cancel()

    def give_up(self) -> None:
        """Abandons the goal: what comes of it is dropped; a server that has it, or may have it, is asked to cancel."""
        unasked = self._phase is _Phase.ACCEPTED and not self._asked
        if (unasked or self._phase is _Phase.SENT) and self._goal is not None:
            self._goal.cancel()
        self._reset()

    def _reset(self) -> None:
        if self._phase is _Phase.SENT and self._goal is not None:
            self._lost[self._number] = self._goal  # should it be accepted after all, it is cancelled
        self._number += 1
        self._phase = _Phase.IDLE
        self._goal = None
        self._cancelling = self._asked = False
        self._set_deadline(None)

    def _set_deadline(self, action: Callable[[], None] | None, seconds: float | None = None) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None
        if action is not None:
            self._deadline = self._event_loop.call_later(self._timeout if seconds is None else seconds, action)

    def _is_current(self, number: int) -> bool:
        return number == self._number and self.busy

    def _poll(self, number: int, goal: Message) -> None:
        """Sends the goal as soon as there is a server; then watches that it stays."""
        if not self._is_current(number):
            return
        served = self._port.is_served(self._client)
        if self._phase is _Phase.LOOKING and served and not self._asked:
            self._phase = _Phase.SENT
            try:
                self._goal = self._port.send_goal(self._client, goal, self._handlers(number))
            except Exception as error:  # whatever the middleware raises is a goal that was not sent
                why = f"the goal can't be sent: {error}"
                self._event_loop.post(lambda: self._if_current(number, lambda: self._end(why)))
        elif self._phase is not _Phase.LOOKING and not served:
            self._end("the server is gone")
            return
        self._event_loop.call_later(POLL, lambda: self._poll(number, goal))

    def _handlers(self, number: int) -> GoalHandlers:
        def later(action: Callable[[], None]) -> None:
            self._event_loop.post(lambda: self._if_current(number, action))

        return GoalHandlers(
            accepted=lambda: self._event_loop.post(lambda: self._accepted(number)),
            rejected=lambda: later(lambda: self._end("rejected")),
            feedback=lambda feedback: later(lambda: self._feedback(feedback)),
            over=lambda: later(self._await_result),
            ended=lambda outcome, result, text: later(lambda: self._finish(outcome, result, text)),
            refused=lambda: later(self._refused),
        )

    def _if_current(self, number: int, action: Callable[[], None]) -> None:
        if self._is_current(number):
            action()

    def _accepted(self, number: int) -> None:
        if self._is_current(number):
            self._accept()
        elif number in self._lost:
            self._lost.pop(number).cancel()

    def _accept(self) -> None:
        if self._phase is _Phase.SENT:
            self._phase = _Phase.ACCEPTED
            self._set_deadline(None)
            if self._asked:
                self._ask_to_cancel()

    def _ask_to_cancel(self) -> None:
        assert self._goal is not None
        self._set_deadline(self._refused)
        self._goal.cancel()

    def _feedback(self, feedback: Message) -> None:
        self._accept()  # feedback may overtake the acceptance
        self._answers.feedback(feedback)

    def _await_result(self) -> None:
        self._phase = _Phase.OVER
        self._set_deadline(lambda: self._end(f"{LOST_RESULT} within {round(self._timeout * 1000)} ms"))

    def _refused(self) -> None:
        if self._phase is _Phase.OVER:
            return
        self._set_deadline(None)
        self._port.warn(f"{self._client.identifier}: {REFUSED}")

    def _expire(self) -> None:
        within = f"within {round(self._timeout * 1000)} ms"
        if self._phase is _Phase.LOOKING:
            self._end(f"no server {within}")
            return
        # The server might still accept it: then it is cancelled. Until it is over, or lost, no other goal starts.
        self._set_deadline(lambda: self._end("lost"), LOST)
        if not self._cancelling:
            self._asked = self._cancelling = True
            self._answers.error(f"not accepted {within}")

    def _finish(self, outcome: Outcome, result: Message, text: str) -> None:
        said = f": {text}" if text else ""
        if outcome is Outcome.SUCCEEDED:
            self._reset()
            self._answers.response(result)
            return
        if self._cancelling and outcome is not Outcome.CANCELLED:
            self._cancelling = False
        own = outcome is Outcome.CANCELLED and self._asked
        self._end(f"{_OWN if own else _UNASKED[outcome]}{said}")

    def _end(self, why: str) -> None:
        cancelling = self._cancelling
        self._reset()
        if cancelling:
            self._answers.ended()
        else:
            self._answers.error(why)


#: What a goal comes to that the node has cancelled without a cancel of the model's: it has stopped the robot.
_OWN = "cancelled by the controller itself, an error to the model"
_UNASKED = {Outcome.SUCCEEDED: "succeeded", Outcome.CANCELLED: "cancelled by someone else", Outcome.ABORTED: "aborted"}
