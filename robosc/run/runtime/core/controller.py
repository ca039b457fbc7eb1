"""Controller of a robot as a ROS node: incoming data becomes events, and events become outgoing data."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial, reduce
from typing import TYPE_CHECKING, Any

from robosc.base.ros_types import Section
from robosc.engine import Settings as LoopSettings
from robosc.language.configuration import NO_STOP, NO_STOP_ON_SILENCE, NO_STOP_ON_VIOLATION
from robosc.language.configuration.parameters import topic_words, watchdog
from robosc.model import sct
from robosc.model.semantics.component_parts import answers
from robosc.model.semantics.messages import paths_set
from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.roles import event_name, plant_of
from robosc.run.runtime.core.cancel_requests import GoalTimes
from robosc.run.runtime.core.clients import ActionClient, Answers, ServiceClient
from robosc.run.runtime.core.composer import Composer
from robosc.run.runtime.core.event_handler import EventHandler
from robosc.run.runtime.core.monitors import OTHER_TYPE, GraphMonitor, Watchdog
from robosc.run.runtime.core.node_data import UNSENDABLE, NotFiniteError, why_unsendable
from robosc.run.runtime.core.port import GoalOutcome
from robosc.run.runtime.core.servers import ActionServer, GoalEvents, ServiceServer
from robosc.run.runtime.core.settings import SafeMessages
from robosc.run.runtime.core.times import RESOLUTION_MS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from robosc.model import rosgraph
    from robosc.model.semantics.component_parts import Parts
    from robosc.run.runtime.core.event_loop import EventLoop, Timer
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.port import Client, ControllerPort, Failure, Message, Server
    from robosc.run.runtime.core.settings import Settings


#: Message sent last, if nothing was sent.
_NOT_SENT: Message = object()
#: Ends of the goals of clients, by the answers to them.
_OUTCOMES = {"response": GoalOutcome.SUCCEEDED, "error": GoalOutcome.ABORTED, "canceled": GoalOutcome.CANCELED}


@dataclass
class _Sender:
    """Sender of the data of one trigger. `message` and `logged` hold the data prepared last."""

    sending: rosgraph.Sending
    owner: rosgraph.Publisher | Client | Server
    interface: rosgraph.Interface
    section: Section
    frame: str
    send: Callable[[Message], None]
    message: Message = None
    logged: Mapping[str, Json] | None = None
    #: Message sent last, as long as it could be repeated; only for data sent on change. A message may be None.
    handed: Message = _NOT_SENT

    @property
    def unchanged(self) -> bool:
        """Whether the data prepared last equals the data sent last."""
        return self.handed is not _NOT_SENT and all(
            _plain(reduce(getattr, path, self.handed)) == _plain(reduce(getattr, path, self.message))
            for path in paths_set(self.sending)
        )


@dataclass
class _Failure:
    """Last failure of a service or action, until it responds, and the timer of the pause after it."""

    why: str = ""
    pause: Timer | None = None


class Controller(EventHandler):
    """Controller of a robot. `safe`: the messages that are sent regardless of requirements."""

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        settings: Settings,
        port: ControllerPort,
        event_loop: EventLoop,
        safe: SafeMessages | None = None,
    ) -> None:
        loop = LoopSettings(
            settings.number("events_per_tick"),
            settings.number("reactions_per_tick"),
            bool(settings.parameters["react_immediately"]),
            RESOLUTION_MS,
        )
        super().__init__(graph, settings, port, event_loop, loop)
        self._composer = Composer(port, self._data)
        self._safe = safe or SafeMessages()
        self._withheld: set[str] = set()
        #: Enabled commands whose data the supervisor forbids.
        self._forbidden: set[str] = set()
        called: list[Client | Server] = [*graph.serviceClients, *graph.actionClients]
        called += [*graph.serviceServers, *graph.actionServers]
        self._monitor = GraphMonitor(port, event_loop, called)
        awaited = {topic.removeprefix("/") for topic in settings.configuration.wait_for}
        #: Topics that commands wait for and that have not been received yet.
        self._unheard = [topic for topic in graph.subscriptions if topic.topic.removeprefix("/") in awaited]
        self._watchdogs: dict[rosgraph.Subscription, Watchdog] = {}
        self._watchdog_stops = bool(settings.parameters["watchdog_stops"])
        self._stopping = False
        self._senders: dict[sct.Event, _Sender] = {}
        self._on_change: list[_Sender] = []
        self._failures: dict[Client, _Failure] = {}
        self._resets: dict[sct.Event, _Failure] = {}
        self._starters: dict[Client, ActionClient] = {}
        self._callers: dict[Client, ServiceClient] = {}
        self._publishers = {sending: publisher for publisher in graph.publishers for sending in publisher.sendings}
        for publisher in graph.publishers:
            for sending in publisher.sendings:
                self._add_sender(publisher, publisher.topic, sending, Section.MESSAGE, partial(port.publish, publisher))
        for service in graph.serviceClients:
            answers, timeout = Answers(*self._ends(service)), settings.seconds("service_timeout_ms")
            caller = self._callers[service] = ServiceClient(port, event_loop, service, timeout, answers)
            self._add_sender(service, service.identifier, service.request, Section.REQUEST, caller.call)
        for action in graph.actionClients:
            answers = Answers(*self._ends(action), partial(self.feed_back, action), partial(self.end_canceled, action))
            times = GoalTimes(settings.seconds("action_timeout_ms"), settings.seconds("retry_ms"))
            starter = ActionClient(port, event_loop, action, times, answers)
            self._add_sender(action, action.identifier, action.request, Section.GOAL, starter.start)
            self._starters[action] = self.goals[action.cancel] = starter
        #: Servers of the controller, by their elements in the graph.
        self.services = {served: self._service_server(served) for served in graph.serviceServers}
        self.actions = {served: self._action_server(served) for served in graph.actionServers}

    def _service_server(self, service: rosgraph.ServiceServer) -> ServiceServer:
        server = ServiceServer(self._event_loop, partial(self.take, service), self._warner(service))
        for sending in answers(service).values():
            self._add_sender(service, service.identifier, sending, Section.RESPONSE, server.respond)
        return server

    def _action_server(self, action: rosgraph.ActionServer) -> ActionServer:
        events = GoalEvents(
            permits=partial(self.permits, action),
            take=partial(self.take, action),
            may_cancel=lambda: action.cancel is not None and self._control.enabled(event_name(action.cancel)),
            cancel=partial(self.cancel_served, action),
            default=lambda: self._port.create(action.interface, Section.RESULT),
        )
        server = ActionServer(self._event_loop, events, self._warner(action))
        for word, sending in answers(action).items():
            section = Section.FEEDBACK if word == "feedback" else Section.RESULT
            send = partial(server.end, _OUTCOMES[word]) if word in _OUTCOMES else server.feed_back
            self._add_sender(action, action.identifier, sending, section, send)
        return server

    def _warner(self, server: Server) -> Callable[[str], None]:
        return lambda text: self._warn((server, text), f"{server.identifier}: {text}")

    def _ends(self, client: Client) -> tuple[Callable[[Message], None], Callable[[Failure, str, Message], None]]:
        """Return the handlers of a response and of a failure of a service or action."""
        self._failures[client] = self._resets[client.reset] = _Failure()
        return partial(self.respond, client), partial(self.fail, client)

    def _add_sender(
        self,
        owner: rosgraph.Publisher | Client | Server,
        name: str,
        sending: rosgraph.Sending,
        section: Section,
        send: Callable[[Message], None],
    ) -> None:
        frame = self._settings.configuration.frame_id.get(name.removeprefix("/"), "")
        sender = self._senders[sending.event] = _Sender(sending, owner, owner.interface, section, frame, send)
        if sending.onChange:
            self._on_change.append(sender)

    # The node's life

    def start(self) -> None:
        """Publish the definition and begin to act: the first tick comes after one period."""
        self._reports.publish_definition()
        self._times.start()
        self._monitor.start()
        if self._graph.publishers and not self._safe.on_shutdown:
            if self._watchdog_stops:
                self._port.warn(NO_STOP_ON_SILENCE)
            elif not self._settings.configuration.says_how_to_stop:
                self._port.warn(NO_STOP)
            if self._violations.stop:
                self._port.warn(NO_STOP_ON_VIOLATION)
        self._warn_of_report()
        if self._unheard:
            self._port.info(f"commands wait for {_topics(self._unheard)}")
        words = topic_words(self._graph)
        for subscription in self._graph.subscriptions:
            seconds = self._settings.seconds(watchdog(words, subscription))
            if seconds:
                self._watchdogs[subscription] = self._watch(subscription.topic, seconds)
        period = self._settings.seconds("period_ms")
        self._plan_tick(self._event_loop.clock() + period, period)

    def _plan_tick(self, due: float, period: float) -> None:
        def tick() -> None:
            late = self._event_loop.clock() - due
            self.tick()
            self._plan_tick(due + period * (1 + late // period), period)

        self._event_loop.call_later(due - self._event_loop.clock(), tick)

    def tick(self) -> None:
        """End a period of the control loop. Timers that have expired by now are handled first."""
        if self._times.due:
            self._expire()
        with self._times:
            self._control.tick()
        self._reports.publish_state(self._port.now())
        self._statuses.publish()

    def stop(self) -> None:
        """Stop the robot before the node ends, while it can still send. Nothing starts after that."""
        if not self._stopping:
            self._stopping = True
            self._halt()
            for service in self.services.values():
                service.leave()
            for action in self.actions.values():
                action.leave()

    @property
    def busy(self) -> bool:
        """Whether the stopping node waits for the fate of a goal, or for the client of one that it serves."""
        return super().busy or any(server.waits for server in self.actions.values())

    def _watch(self, topic: str, seconds: float) -> Watchdog:
        def silent() -> None:
            self._port.warn(f"{topic}: silent for {round(seconds * 1000)} ms")
            if self._watchdog_stops:
                self._halt()

        return Watchdog(self._event_loop, seconds, silent, lambda: self._port.info(f"{topic}: speaks again"))

    @property
    def _halted(self) -> bool:
        if self._stopping or self._violations.stopped:
            return True
        return self._watchdog_stops and any(dog.tripped for dog in self._watchdogs.values())

    def _halt(self) -> None:
        """Cancel running actions, then send the last messages regardless of their requirements."""
        self._cancel_goals()
        self._send_outside(self._safe.on_shutdown)

    def _send_outside(self, messages: Sequence[rosgraph.Sending]) -> None:
        """Send messages regardless of their requirements."""
        for sending in messages:
            sender = self._senders[sending.event]
            if self._prepare(sender):
                self._forget_handed(sender.owner)
                sender.send(sender.message)
                self._log.write(self._port.now(), "outside", event_name(sending.event), sender.logged)

    # Incoming data

    @contextmanager
    def _batch(self) -> Iterator[None]:
        with self._times:
            self._control.begin()
            yield
            self._control.end()
        self._stop_if_violated()

    def permits(self, action: rosgraph.ActionServer, goal: Message) -> bool:
        """Return whether a goal of a client can be accepted now: its event would happen. Report data of no use."""
        reception, engine = action.request, self._control.engine
        event = event_name(reception.event)
        if self._halted or self._unheard:
            return False
        try:
            engine.set_inputs(event, self._data.receive(reception.event, reception.inputs, goal).inputs)
        except UnreadableError as fault:
            self._warn(reception.event, f"{action.identifier}: {fault}")
            return False
        if not engine.permits_inputs(event):
            return False
        if not engine.enabled(event):
            with self._batch():
                self._receive(reception, action.identifier, goal)  # it may violate an assumption
            return False
        return True

    def take(self, server: Server, request: Message) -> bool:
        """Handle a request or an accepted goal of a client as a batch; return whether its event has happened."""
        with self._batch():
            is_possible = self._control.enabled(event_name(server.request.event))
            return self._receive(server.request, server.identifier, request) and is_possible

    def cancel_served(self, action: rosgraph.ActionServer) -> None:
        """Handle an accepted request of a client to cancel its goal."""
        assert action.cancel is not None
        with self._batch():
            self._perform(action.cancel)

    def _note_received(self, subscription: rosgraph.Subscription) -> None:
        if subscription in self._unheard:
            self._unheard.remove(subscription)
            if not self._unheard:
                self._port.info("commands wait no longer: each topic was heard")
        if subscription in self._watchdogs:
            self._watchdogs[subscription].reset()

    def _note_success(self, client: Client) -> None:
        self._failures[client].why = ""

    def _note_failure(self, client: Client, why: str, *, logged: bool = False) -> None:
        if self._monitor.has_other_type(client):
            why = OTHER_TYPE
        failure = self._failures[client]
        if failure.why != why:
            super()._note_failure(client, why, logged=logged)
        failure.why = why
        failure.pause = self._event_loop.call_later(self._settings.seconds("retry_ms"), partial(self._retry, failure))

    def _retry(self, failure: _Failure) -> None:
        failure.pause = None
        self._react()

    def _react(self) -> None:
        """Perform the events that were withheld until now."""
        with self._batch():
            pass

    # Outgoing data

    def _may_happen(self, event: sct.Event) -> bool:
        sender, name = self._senders.get(event), event_name(event)
        if sender is None:
            return event not in self._resets or self._resets[event].pause is None
        if self._halted or self._unheard:
            return False
        if not (self._prepare(sender) and self._permits(sender)):
            if name not in self._withheld:
                self._withheld.add(name)
                self._send_outside(self._safe.on_withheld)
            return False
        self._withheld.discard(name)
        self._sent = sender.message
        return not (sender.sending.onChange and sender.unchanged)

    def _permits(self, sender: _Sender) -> bool:
        """Set the inputs of a command; report once that the supervisor forbids them, and return whether it allows them.

        Inputs that cannot be read are not allowed.
        """
        engine, event = self._control.engine, sender.sending.event
        name = event_name(event)
        if not sender.sending.inputs:
            return True
        try:
            engine.set_inputs(name, self._composer.inputs(sender.sending, sender.message))
        except UnreadableError as fault:
            self._warn_withheld(sender, fault)
            return False
        if engine.permits_inputs(name):
            self._forbidden.discard(name)
            return True
        sender.handed = _NOT_SENT
        if name not in self._forbidden:
            self._forbidden.add(name)
            self._publish_blocked(event, "requirement", self._blocking.reason(event).because)
        return False

    def _may_wait(self, event: sct.Event) -> bool:
        return event not in self.goals

    def _held_back(self, event: sct.Event) -> str | None:
        if self._unheard and not self._stopping:
            return f"it waits for {_topics(self._unheard)}"
        if self._stopping:
            return "the node is not active"
        if violated := super()._held_back(event):
            return violated
        if self._halted:
            return "a topic is silent"
        if event_name(event) in self._forbidden:
            return "its data is forbidden"
        return "its data cannot be sent" if event_name(event) in self._withheld else None

    def _faults(self, parts: Parts) -> list[str]:
        silent = [topic for topic in parts.topics if topic in self._watchdogs and self._watchdogs[topic].tripped]
        unheard = [topic for topic in parts.topics if topic in self._unheard]
        failed = [(client.identifier, self._failures[client].why) for client in parts.clients]
        failed += [
            (client.identifier, self._starters[client].trouble) for client in parts.clients if client in self._starters
        ]
        unsendable = self._withheld - self._forbidden
        withheld = [sending.name for sending in parts.commands if event_name(sending.event) in unsendable]
        return [
            *(f"{topic.topic} is silent" for topic in silent),
            *(f"{topic.topic} was not heard yet" for topic in unheard),
            *(fault for element in parts.connections for fault in self._monitor.faults(element)),
            *(f"{name}: {why}" for name, why in failed if why),
            *(f"{name} is withheld" for name in withheld),
        ]

    def _prepare(self, sender: _Sender) -> bool:
        """Prepare the data of a trigger; return False if it can't be sent."""
        try:
            sender.message, sender.logged = self._composer.compose(
                sender.sending, sender.interface, sender.section, sender.frame
            )
        except UNSENDABLE as fault:
            self._warn_withheld(sender, fault)
            return False
        return True

    def _forget_handed(self, owner: rosgraph.Publisher | Client | Server) -> None:
        """Send each message of a topic again that is sent on change: another one has gone out there."""
        for sender in self._on_change:
            if sender.owner is owner:
                sender.handed = _NOT_SENT

    def _warn_withheld(self, sender: _Sender, fault: NotFiniteError | UnreadableError) -> None:
        event = sender.sending.event
        word = plant_of(event).name.partition("_")[2]
        if sender.sending.event.kind != sct.EventKind.trigger:
            word += f"_{event.name.removeprefix('c_')}"
        path = str(fault) if isinstance(fault, NotFiniteError) else ""
        self._warn((event_name(event), path), f"{word} is withheld: {why_unsendable(fault)}")

    def _after(self, name: str) -> None:
        # A command that is disabled is no longer withheld.
        self._withheld = {command for command in self._withheld if self._control.engine.enabled(command)}
        self._forbidden = {command for command in self._forbidden if self._control.engine.enabled(command)}
        super()._after(name)
        for sender in self._on_change:
            if not self._control.engine.enabled(event_name(sender.sending.event)):
                sender.handed = _NOT_SENT

    def _act(self, event: sct.Event) -> tuple[str, Mapping[str, Json] | None] | None:
        sender = self._senders.get(event)
        if sender is not None:
            sender.send(sender.message)
            self._forget_handed(sender.owner)
            if sender.sending.onChange:
                sender.handed = sender.message
            return "out", sender.logged
        if event in self.goals:
            self.goals[event].cancel()
            return "out", None
        return None


def _topics(subscriptions: Sequence[rosgraph.Subscription]) -> str:
    return ", ".join(subscription.topic for subscription in subscriptions)


def _plain(value: Any) -> Any:
    """Return a value for comparison: an array, also of numpy, as a list."""
    is_array = hasattr(value, "__len__") and not isinstance(value, (str, bytes))
    return list(value) if is_array else value
