"""The controller of a robot, as a node of some ROS: what comes in becomes events, and what happens goes out."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING

from robosc.configuration import NO_STOP, NO_STOP_ON_SILENCE
from robosc.engine import ControlLoop, Hooks
from robosc.engine import Settings as LoopSettings
from robosc.metamodel import expression as ex
from robosc.metamodel import rosgraph, sct
from robosc.ros_types import Section
from robosc.runtime.core.clients import ActionClient, Answers, ServiceClient
from robosc.runtime.core.fields import NotFiniteError, fill
from robosc.runtime.core.happenings import Happenings
from robosc.runtime.core.node_data import NodeData, bounded
from robosc.runtime.core.reports import EventLog, nested
from robosc.runtime.core.settings import SafeMessages, watchdog
from robosc.runtime.core.state import StateReporter
from robosc.runtime.core.throttle import Throttle
from robosc.runtime.core.watchdog import Watchdog
from robosc.runtime.core.wiring import Wiring
from robosc.semantics.definition import definition_text
from robosc.semantics.headers import parts_with_headers
from robosc.semantics.roles import Roles, event_name

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.runtime.core.agenda import Agenda, Appointment
    from robosc.runtime.core.json_text import Json
    from robosc.runtime.core.port import Message, Port
    from robosc.runtime.core.reports import LineWriter
    from robosc.runtime.core.settings import Settings

_Client = rosgraph.ServiceClient | rosgraph.ActionClient
#: Seconds that the end of the node waits for goals which it has cancelled.
_FAREWELL = 0.5


@dataclass
class _Sender:
    """How one trigger's data goes out."""

    sending: rosgraph.Sending
    interface: rosgraph.Interface
    section: Section
    frame: str
    send: Callable[[Message], None]
    client: ActionClient | None = None
    message: Message = None
    noted: Mapping[str, Json] | None = None


@dataclass
class _Connected:
    """A service or action, and what is known of its last failure."""

    client: ServiceClient | ActionClient
    fault: str = ""
    retry: Appointment | None = None


class Controller:
    """A robot's controller. All its functions belong to the thread that works on the agenda.

    Raises OSError where the event log can't be written.
    """

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        settings: Settings,
        port: Port,
        agenda: Agenda,
        safe: SafeMessages | None = None,
    ) -> None:
        self._graph = graph
        self._settings = settings
        self._port = port
        self._agenda = agenda
        self._safe = safe or SafeMessages()
        self._withheld: set[str] = set()
        self._log = EventLog(str(settings.parameters["event_log"]))
        loop = LoopSettings(
            settings.number("events_per_tick"),
            settings.number("reactions_per_tick"),
            bool(settings.parameters["react_immediately"]),
        )
        self._loop = ControlLoop(graph.model, loop, Hooks(self._before, self._after, self._livelock))
        self._data = NodeData(graph, self._loop.engine)
        self._reports = StateReporter(graph, self._loop.engine, self._data, port, settings.configuration)
        self._warn = Throttle(port.warn, agenda.clock)
        self._happenings = Happenings(graph, self._data, self._loop)
        self._wiring = Wiring(port, agenda)
        self._watchdogs: dict[rosgraph.Subscription, Watchdog] = {}
        self._stopping = False
        self._patience = self._farewell = 0.0
        roles = Roles(graph.model)
        self._events = {event_name(each): each for each in roles.events}
        self._incoming = set(roles.incoming)
        self._senders: dict[sct.Event, _Sender] = {}
        self._connected: dict[_Client, _Connected] = {}
        self._resets: dict[sct.Event, _Connected] = {}
        self._cancels: dict[sct.Event, ActionClient] = {}
        self._connect()

    def _connect(self) -> None:
        for publisher in self._graph.publishers:
            for sending in publisher.sendings:
                self._add_sender(publisher, publisher.topic, sending, Section.MESSAGE, self._publishing(publisher))
        for service in self._graph.serviceClients:
            answers = Answers(self._response(service), self._error(service))
            timeout = self._settings.seconds("service_timeout_ms")
            caller = ServiceClient(self._port, self._agenda, service, timeout, answers)
            self._add_client(service, caller)
            self._add_sender(service, service.identifier, service.request, Section.REQUEST, caller.call)
        for action in self._graph.actionClients:
            answers = Answers(self._response(action), self._error(action), self._feedback(action), self._wake)
            timeout = self._settings.seconds("action_timeout_ms")
            starter = ActionClient(self._port, self._agenda, action, timeout, answers)
            self._add_client(action, starter)
            self._add_sender(action, action.identifier, action.request, Section.GOAL, starter.start)
            self._senders[action.request.event].client = starter
            self._cancels[action.cancel] = starter

    def _add_client(self, client: _Client, connected: ServiceClient | ActionClient) -> None:
        self._connected[client] = self._resets[client.reset] = _Connected(connected)

    def _add_sender(
        self,
        owner: rosgraph.Publisher | _Client,
        name: str,
        sending: rosgraph.Sending,
        section: Section,
        send: Callable[[Message], None],
    ) -> None:
        frame = self._settings.configuration.frame_id.get(name.removeprefix("/"), "")
        self._senders[sending.event] = _Sender(sending, owner.interface, section, frame, send)

    def _publishing(self, publisher: rosgraph.Publisher) -> Callable[[Message], None]:
        return lambda message: self._port.publish(publisher, message)

    # The node's life

    def log_to(self, writer: LineWriter) -> None:
        """Has the event log written there; before the start."""
        self._log = EventLog("", writer)

    def flush_log(self) -> None:
        """Waits until all events so far are in the log."""
        self._log.flush()

    def start(self) -> None:
        """Tells what it is and begins to act: the first tick comes after one period."""
        self._reports.define(definition_text(self._graph))
        self._wiring.start()
        stops = bool(self._settings.parameters["watchdog_stops"])
        self._warn_of_no_stop(stops=stops)
        for subscription in self._graph.subscriptions:
            seconds = self._settings.seconds(watchdog(subscription))
            if seconds:
                self._watchdogs[subscription] = self._watch(subscription.topic, seconds, stops=stops)
        period = self._settings.seconds("period_ms")
        self._plan(self._agenda.clock() + period, period)

    def _warn_of_no_stop(self, *, stops: bool) -> None:
        if self._graph.publishers and not self._safe.on_shutdown:
            if stops:
                self._port.warn(NO_STOP_ON_SILENCE)
            elif not self._settings.configuration.says_how_to_stop:
                self._port.warn(NO_STOP)

    def _plan(self, time: float, period: float) -> None:
        def tick() -> None:
            late = self._agenda.clock() - time
            self.tick()
            self._plan(time + period * (1 + late // period), period)

        self._agenda.after(time - self._agenda.clock(), tick)

    def tick(self) -> None:
        """One period of the control loop is over."""
        self._loop.tick()
        self._reports.publish(self._port.now())

    def stop(self) -> None:
        """Stops the robot, before the node ends and while it can still send. Nothing more starts."""
        if not self._stopping:
            self._stopping = True
            self._halt()
            self._patience = time.monotonic() + max((each.unanswered for each in self._cancels.values()), default=0.0)
            self._farewell = time.monotonic() + _FAREWELL

    @property
    def busy(self) -> bool:
        """Whether the end has to wait: until a goal that was sent is accepted and cancelled, then a little for its end.

        What is left of the timeout bounds it, on the steady clock: simulated time may stand still.
        """
        now = time.monotonic()
        if now < self._patience and any(each.unanswered for each in self._cancels.values()):
            self._farewell = now + _FAREWELL
        return now < self._farewell and any(each.busy for each in self._cancels.values())

    def close(self) -> None:
        """Nothing more will happen."""
        for client in self._cancels.values():
            client.give_up()
        self._log.close()

    def _watch(self, topic: str, seconds: float, *, stops: bool) -> Watchdog:
        def fall_silent() -> None:
            self._port.warn(f"{topic}: silent for {round(seconds * 1000)} ms")
            if stops:
                self._halt()

        return Watchdog(self._agenda, seconds, fall_silent, lambda: self._port.info(f"{topic}: speaks again"))

    @property
    def _held(self) -> bool:
        stops = self._settings.parameters["watchdog_stops"]
        return self._stopping or bool(stops and any(each.tripped for each in self._watchdogs.values()))

    def _halt(self) -> None:
        """Cancels running actions, then sends the last messages, whatever the requirements on them say."""
        self._loop.begin()
        for event, client in self._cancels.items():
            if client.busy and not self._loop.perform(event_name(event)):
                client.cancel(expected=False)
        self._loop.end()
        self._send_outside(self._safe.on_shutdown)

    def _send_outside(self, messages: Sequence[rosgraph.Sending]) -> None:
        """Sends messages whatever the requirements on them say."""
        for sending in messages:
            sender = self._senders[sending.event]
            if self._prepare(sender):
                sender.send(sender.message)
                self._log.write(self._port.now(), "outside", event_name(sending.event), sender.noted)

    # What comes in

    def receive(self, subscription: rosgraph.Subscription, message: Message) -> None:
        """A message on a topic: one batch of events. One that can't be read counts as not received."""
        self._loop.begin()
        read = [self._hear(each, subscription.topic, message) for each in subscription.receptions]
        if subscription in self._watchdogs and all(read):
            self._watchdogs[subscription].hear()
        self._loop.end()

    def _response(self, client: _Client) -> Callable[[Message], None]:
        def respond(message: Message) -> None:
            self._loop.begin()
            unread = self._happenings.perform(client.response.event, client.response.inputs, message)
            if unread is None:
                self._connected[client].fault = ""
            else:
                self._note_failure(client, str(unread))
                self._happenings.reject(client, message)
            self._loop.end()

        return respond

    def _feedback(self, client: rosgraph.ActionClient) -> Callable[[Message], None]:
        def feed_back(message: Message) -> None:
            self._loop.begin()
            self._hear(client.feedback, client.identifier, message)
            self._loop.end()

        return feed_back

    def _error(self, client: _Client) -> Callable[[str], None]:
        def fail(why: str) -> None:
            self._note_failure(client, why)
            self._loop.begin()
            self._happenings.perform(client.error)
            self._loop.end()

        return fail

    def _note_failure(self, client: _Client, why: str) -> None:
        connected = self._connected[client]
        if connected.fault != why:
            self._port.warn(f"{client.identifier}: {why}")
        connected.fault = why
        connected.retry = self._agenda.after(self._settings.seconds("retry_ms"), self._try_again(connected))

    def _try_again(self, connected: _Connected) -> Callable[[], None]:
        def wake() -> None:
            connected.retry = None
            self._wake()

        return wake

    def _wake(self) -> None:
        """What was withheld for some time may happen now."""
        self._loop.begin()
        self._loop.end()

    def _hear(self, reception: rosgraph.Reception, name: str, message: Message) -> bool:
        """A message or feedback, as an event; False where it can't be read, which is reported."""
        unread = self._happenings.perform(reception.event, reception.inputs, message)
        if unread is not None:
            self._warn(reception.event, f"{name}: {unread}")
        return unread is None

    # What goes out

    def _before(self, name: str) -> bool:
        event = self._events[name]
        sender = self._senders.get(event)
        if sender is not None:
            busy = sender.client is not None and sender.client.busy
            if self._held or busy:
                return False
            if not self._prepare(sender):
                if name not in self._withheld:
                    self._withheld.add(name)
                    self._send_outside(self._safe.on_withheld)
                return False
            self._withheld.discard(name)
        elif event in self._resets and self._resets[event].retry is not None:
            return False
        if event not in self._incoming:
            self._happenings.change(event)
        return True

    def _prepare(self, sender: _Sender) -> bool:
        """Makes the data of a trigger; False where it can't be sent."""
        message = self._port.create(sender.interface, sender.section)
        for part in parts_with_headers(sender.sending):
            self._port.stamp(reduce(getattr, part, message), sender.frame)
        fields: dict[tuple[str, ...], Json] = {}
        alternatives = sender.sending.alternatives
        chosen = next((each for each in alternatives if self._data.is_in(each.location)), None)
        try:
            for field in chosen.fields if chosen is not None else ():
                value = self._data.value(field.value)
                if isinstance(field.type, ex.IntegerType):
                    value = bounded(value, field.type)
                fields[tuple(field.path)] = fill(self._port, message, field.path, value)
        except NotFiniteError as fault:
            name = event_name(sender.sending.event)
            self._warn((name, str(fault)), f"{_word(sender.sending)} is withheld: its {fault} would not be finite")
            return False
        sender.message = message
        sender.noted = None
        if alternatives:
            sender.noted = {"value": fields["data",] if list(fields) == [("data",)] else nested(fields)}
        return True

    def _after(self, name: str) -> None:
        # What may no longer be sent is no longer withheld.
        self._withheld = {command for command in self._withheld if self._loop.engine.enabled(command)}
        event = self._events[name]
        direction = "in" if event in self._incoming else "internal"
        noted = self._happenings.noted(event) if self._log.active else None
        sender = self._senders.get(event)
        if sender is not None:
            direction, noted = "out", sender.noted
            sender.send(sender.message)
        elif event in self._cancels:
            direction = "out"
            self._cancels[event].cancel()
        self._log.write(self._port.now(), direction, name, noted)
        if lost := self._log.lost():
            self._port.warn(f"the event log lost {lost} events")
        self._reports.note(name)

    def _livelock(self) -> None:
        self._port.error("internal transitions follow each other without end")


def _word(sending: rosgraph.Sending) -> str:
    plant: sct.Plant = sending.event.eContainer()
    return plant.name.partition("_")[2]
