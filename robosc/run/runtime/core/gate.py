"""Layer whose controller is in the same process: it learns the outcome of each of its commands."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robosc.model.semantics.roles import assumption_text, event_name
from robosc.run.runtime.core.cancel_requests import GoalTimes
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.node_data import UNSENDABLE, why_unsendable
from robosc.run.runtime.core.port import Failure, GoalHandlers, GoalOutcome
from robosc.run.runtime.core.proxies import ActionProxy, ProxiedGoal, ServiceProxy

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.model import rosgraph, sct
    from robosc.run.runtime.core.event_loop import EventLoop
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.port import Client, ControllerPort, Goal, Message
    from robosc.run.runtime.core.settings import SafeMessages, Settings


@dataclass(frozen=True)
class Outcome:
    """Outcome of a command.

    `verdict`: `sent` and `limited` for messages, `answered` for calls, `accepted` for goals; `refused` by the layer,
    `failed` on the robot's side. `message` is the data that was sent, or the response. `reason` and `because` are those
    of `~/blocked`; of a failure, the reason and its text. `receivers` counts the nodes that a command could reach.
    """

    verdict: str
    message: Message = None
    reason: str = ""
    because: Sequence[str] = ()
    receivers: int = 1


class GatedLayer(Layer):
    """Layer that a program calls in place of a controller. Call all functions in the event loop's thread.

    Precondition: the graph has no servers, and no two of its communications share a topic.
    """

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        settings: Settings,
        port: ControllerPort,
        event_loop: EventLoop,
        safe: SafeMessages | None = None,
    ) -> None:
        super().__init__(graph, settings, port, event_loop, safe)
        #: Refusal or failure of the present command.
        self._obstacle = Outcome("failed")
        self._has_stopped = False
        self._services = {
            service: ServiceProxy(port, event_loop, service, self, settings.seconds("service_timeout_ms"))
            for service in graph.serviceClients
        }
        #: The actions of the robot, as the program uses them.
        self.actions = {action: self._action(action, port) for action in graph.actionClients}
        self.goals.update({action.cancel: proxy for action, proxy in self.actions.items()})
        self._topics = {sending: publisher for publisher in graph.publishers for sending in publisher.sendings}

    def _action(self, action: rosgraph.ActionClient, port: ControllerPort) -> GatedAction:
        timeout = self._settings.seconds("action_timeout_ms")
        return GatedAction(port, self._event_loop, action, self, GoalTimes(timeout, timeout))

    # Commands

    def send(self, sending: rosgraph.Sending, message: Message) -> Outcome:
        """Send a message if the layer lets it pass."""
        forwarded = self.forwarded(sending, message)
        if forwarded is None:
            return self._obstacle
        self._composer.port.publish(self._topics[sending], forwarded)
        return Outcome("sent" if forwarded is message or forwarded == message else "limited", forwarded)

    def call(self, service: rosgraph.ServiceClient, request: Message, done: Callable[[Outcome], None]) -> None:
        """Call a service if the layer lets the call pass; `done` is called once, in bounded time."""
        self._services[service].call(request, _Caller(self, done))

    def start_goal(self, action: rosgraph.ActionClient, goal: Message, decided: Callable[[Outcome], None]) -> None:
        """Start a goal if the layer lets it pass; `decided` is called once it is accepted, refused or has failed."""
        self.actions[action].start(goal, decided)

    def verdict(self, sending: rosgraph.Sending, message: Message = None) -> Outcome | None:
        """Return why a command would be refused now, None if it would pass. Nothing happens.

        Without data, the result is about the state only.
        """
        engine, name = self._control.engine, event_name(sending.event)
        if self._violations.stopped:
            return Outcome("refused", None, "assumption", list(map(assumption_text, self._violations.assumptions)))
        before = engine.saved
        try:
            if message is not None:
                engine.set_inputs(name, self._composer.inputs(sending, self._composer.limited(sending, message)))
            passes = engine.enabled(name) and (message is None or engine.permits_inputs(name))
            reason = None if passes else self._blocking.reason(sending.event)
        except UNSENDABLE as fault:
            return Outcome("refused", None, "data", [why_unsendable(fault)])
        finally:
            engine.restore(before)
        return None if reason is None else Outcome("refused", None, reason.kind, reason.because)

    def release(self) -> None:
        """Stop what the program has started: cancel its goals, and send the messages of `on_blocked` after commands."""
        self._cancel_goals()
        for sending in [known for known in self._publishers if known in self._forwarded]:
            self._forwarded.remove(sending)
            self._send_instead(sending)

    def stop(self) -> None:
        """Stop what the program has started before the node ends. Later commands fail: nothing would stop them."""
        self._has_stopped = True
        self.release()

    def forwarded(self, sending: rosgraph.Sending, message: Message) -> Message | None:
        """Return a command with its limits if the layer lets it pass and has not stopped, else None."""
        if self._has_stopped:
            self._obstacle = Outcome("failed", None, str(Failure.UNAVAILABLE), ("the gate is ending",))
            return None
        return super().forwarded(sending, message)

    @property
    def obstacle(self) -> Outcome:
        """The last refusal or failure."""
        return self._obstacle

    # Knowledge of the layer

    @property
    def codes(self) -> Mapping[sct.Plant | sct.DiscreteVariable, int]:
        """The state of the supervisor, as `robosc.analysis.explain` takes it."""
        return self._control.engine.codes

    def components(self) -> dict[str, Json]:
        """Return the state and the variables of each component, as on `~/state`."""
        return self._reports.components()

    def violated(self) -> list[str]:
        """Return the assumptions that the robot has violated."""
        return list(map(assumption_text, self._violations.assumptions))

    def graph_faults(self) -> list[str]:
        """Return the faults of the robot's connections, such as nodes that go around the layer."""
        graph = self._graph
        elements: list[rosgraph.Subscription | rosgraph.Publisher | Client] = [*graph.subscriptions, *graph.publishers]
        elements += [*graph.serviceClients, *graph.actionClients]
        return [fault for element in elements for fault in self._monitor.faults(element)]

    # Refusals and failures

    def _report_blocked(self, event: sct.Event, reason: str, because: Sequence[str]) -> None:
        self._obstacle = Outcome("refused", None, reason, tuple(because))
        super()._report_blocked(event, reason, because)

    def fail(self, client: Client, reason: Failure, why: str, result: Message = None) -> None:
        """Handle a failed call or goal, and note why it has failed."""
        super().fail(client, reason, why, result)
        self._obstacle = Outcome("failed", None, str(reason), (why,))

    def end_canceled(self, client: rosgraph.ActionClient, reason: Failure, why: str, result: Message = None) -> None:
        """Handle the end of a canceled goal, and note why it has ended."""
        super().end_canceled(client, reason, why, result)
        self._obstacle = Outcome("failed", None, str(reason), (why,))


@dataclass(frozen=True)
class _Caller:
    """Caller of a service, which waits for its answer."""

    layer: GatedLayer
    done: Callable[[Outcome], None]

    def give(self, response: Message = None) -> None:
        """Pass on the response; without one, why there is none."""
        self.done(self.layer.obstacle if response is None else Outcome("answered", response))


@dataclass(eq=False)
class GatedGoal(ProxiedGoal):
    """Goal of the program.

    `outcome`: its end as a `GoalOutcome` or a `Failure`, empty as long as it runs. `why` explains an end without a
    result.
    """

    decided: Callable[[Outcome], None] | None = None
    handle: Goal | None = None
    feedback: Message = None
    outcome: str = ""
    result: Message = None
    why: str = ""
    waiting: list[Callable[[], None]] = field(default_factory=list)

    @property
    def status(self) -> str:
        """The status in a word."""
        if self.outcome:
            return self.outcome
        return "waiting" if not self.accepted else "canceling" if self.canceled else "executing"

    def decide(self, outcome: Outcome) -> None:
        """Report once whether the goal runs."""
        decided, self.decided = self.decided, None
        if decided is not None:
            decided(outcome)

    def finish(self, outcome: str, result: Message = None, why: str = "") -> None:
        """Record the end, and report it to all that wait for it."""
        self.outcome, self.result, self.why = outcome, result, why
        for waiter in self.waiting:
            waiter()
        self.waiting.clear()


class GatedAction(ActionProxy[GatedGoal]):
    """Action of the robot for a program in the same process. `latest` is the last goal that the layer let pass."""

    def __init__(
        self,
        port: ControllerPort,
        event_loop: EventLoop,
        action: rosgraph.ActionClient,
        layer: GatedLayer,
        times: GoalTimes,
    ) -> None:
        super().__init__(port, event_loop, action, layer, times)
        self._sender = port
        self._gate = layer
        self.latest: GatedGoal | None = None

    def start(self, data: Message, decided: Callable[[Outcome], None]) -> None:
        """Start a goal if the layer lets it pass."""
        self._receive_goal(GatedGoal(object(), data, decided=decided), data)

    @property
    def runs(self) -> bool:
        """Whether there is a goal that has not ended."""
        return self._goal is not None

    def _receive_goal(self, goal: GatedGoal, data: Message) -> None:
        before = self._goal
        super()._receive_goal(goal, data)
        if before is None and (self._goal is goal or goal.outcome):
            self.latest = goal

    # Interface to the robot

    def _is_served(self, goal: GatedGoal) -> bool:
        if goal.accepted and goal.handle is not None:
            return not goal.handle.is_gone()
        return self._port.is_served(self._action)

    def _send(self, goal: GatedGoal) -> bool:
        def later(action: Callable[[], None]) -> None:
            self._event_loop.post(action)

        handlers = GoalHandlers(
            accepted=lambda: later(lambda: self._on_accepted(goal)),
            rejected=lambda: later(lambda: self._on_rejected(goal)),
            feedback=lambda feedback: later(lambda: self._on_feedback(goal, feedback)),
            ended=lambda outcome, result, _: later(lambda: self._on_end(goal, outcome, result)),
            cancel_answered=lambda answer: later(lambda: self._cancel_answered(goal, answer)),
        )
        try:
            goal.handle = self._sender.send_goal(self._action, goal.request, handlers)
        except Exception:  # any exception of the middleware means that the goal was not sent
            return False
        return True

    def _send_cancel(self, goal: GatedGoal) -> None:
        if goal.handle is not None:
            goal.handle.cancel()

    def _is_canceling(self, goal: GatedGoal) -> bool:
        return goal.handle is not None and goal.handle.is_canceling()

    def _end(self, goal: GatedGoal) -> None:
        obstacle = self._gate.obstacle
        if obstacle.verdict == "failed":
            goal.finish(obstacle.reason, None, "; ".join(obstacle.because))
        goal.decide(obstacle)

    # From the robot

    def _on_accepted(self, goal: GatedGoal) -> None:
        if self._goal is not goal:
            self._send_cancel(goal)  # it counted as lost
            return
        self._accept(goal)
        goal.decide(Outcome("accepted"))

    def _on_rejected(self, goal: GatedGoal) -> None:
        if self._goal is goal:
            self._give_up(goal, Failure.REJECTED, "rejected")

    def _on_feedback(self, goal: GatedGoal, feedback: Message) -> None:
        if self._goal is goal:
            self._on_accepted(goal)  # feedback may arrive before the acceptance
            goal.feedback = feedback
            self._receive_feedback(goal.identifier, feedback)

    def _on_end(self, goal: GatedGoal, outcome: GoalOutcome, result: Message) -> None:
        if self._goal is goal:
            self._on_accepted(goal)
            self._receive_end(goal, outcome, result)
            goal.finish(str(outcome), result)
