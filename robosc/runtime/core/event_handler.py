"""The common part of controller and layer: data that come in become events, which are logged."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol

from robosc.configuration.parameters import model_parameters
from robosc.engine import ControlLoop, Hooks
from robosc.metamodel import engine, rosgraph, sct
from robosc.ros_types import Section
from robosc.runtime.core.blocking import Blocking
from robosc.runtime.core.component_status import Own, StatusReporter
from robosc.runtime.core.event_log import EventLog, ReceivedData
from robosc.runtime.core.node_data import NodeData
from robosc.runtime.core.port import Failure
from robosc.runtime.core.reports import StateReporter, Throttle
from robosc.runtime.core.times import Times
from robosc.semantics.durations import set_milliseconds
from robosc.semantics.messages import received, receptions
from robosc.semantics.operators import UnreadableError
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.configuration.parameters import Value
    from robosc.engine import Settings as LoopSettings
    from robosc.metamodel import expression as ex
    from robosc.runtime.core.event_loop import EventLoop
    from robosc.runtime.core.json_text import Json
    from robosc.runtime.core.port import Client, Message, Port
    from robosc.runtime.core.settings import Settings
    from robosc.semantics.component_parts import Parts


def _unset_objects(graph: rosgraph.RosGraph, port: Port) -> dict[rosgraph.NodeVariable, Message]:
    """The objects that a node keeps, before anything is stored in them: each is new data of its ROS type."""
    sources = {
        reception: (interface, section) for interface, section, several in received(graph) for reception in several
    }
    return {
        variable: port.unset(*sources[variable.reception], variable.path)
        for variable in graph.variables
        if isinstance(variable.type, rosgraph.ObjectType) and variable.reception is not None
    }


class Goals(Protocol):
    """The goals of one action, one at a time."""

    def cancel(self) -> object:
        """Cancel the goal at hand."""

    @property
    def trouble(self) -> str:
        """The reason why the goal has not ended though it should have; empty where nothing is wrong."""

    @property
    def waits(self) -> bool:
        """Whether the end of the node waits for the acceptance of the goal, the answer to its cancel, or its end."""

    def leave(self) -> None:
        """Report a goal that was to be canceled and has not ended when the node ends."""


class EventHandler:
    """Lets the events of one graph happen, with their data; one whose data can't be read does not.

    All its functions belong to the event loop's thread. Raises OSError where the event log can't be written.
    """

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        settings: Settings,
        port: Port,
        event_loop: EventLoop,
        loop: LoopSettings | None = None,
    ) -> None:
        self._graph = graph
        self._settings = settings
        self._port = port
        self._event_loop = event_loop
        self._log = EventLog(str(settings.parameters["event_log"]))
        hooks = Hooks(self._before, self._after, self._report_livelock)
        self._control = ControlLoop(graph.model, loop, hooks)
        self._data = NodeData(graph, self._control.engine)
        self._data.variables.update(_unset_objects(graph, port))
        self._parameters = {known.name: parameter for parameter, known in model_parameters(graph).items()}
        self.set_parameters(settings.parameters)
        self._times = Times(self._control.timers, event_loop, self._expire)
        self._reports = StateReporter(graph, self._control.engine, self._data, port, settings.configuration)
        self._blocking = Blocking(self._control.engine)
        own = Own(self._held_back, self._faults)
        self._statuses = StatusReporter(graph, port, self._data, self._blocking, own)
        if "diagnostics_ms" in settings.parameters:
            self._statuses.report_every(settings.number("diagnostics_ms"), settings.number("period_ms"))
        self._warn = Throttle(port.warn, event_loop.clock)
        self._events = {event_name(event): event for plant in graph.model.plants for event in plant.events}
        self._incoming = self._of_role(engine.Role.incoming)
        #: The goals of the actions, by the event that cancels them.
        self.goals: dict[sct.Event, Goals] = {}
        #: The message that the event at hand came with, and the event that would have been made of it.
        self._received: tuple[sct.Event, Message] | None = None
        self._logged = {reception.event: self._read(reception) for reception in receptions(graph)}
        clients: list[Client] = [*graph.serviceClients, *graph.actionClients]
        #: What the log has of an answer that can't be read, and so is an error.
        self._unread = {
            client.response.event: ReceivedData([*self._values(client.response), *self._values(client.error)])
            for client in clients
        }

    def _of_role(self, *roles: engine.Role) -> set[sct.Event]:
        """The events for which the control loop does one of these."""
        executed = self._control.engine.executed
        return {self._events[event.name] for event in executed.events if event.role in roles}

    def _read(self, reception: rosgraph.Reception) -> ReceivedData:
        return ReceivedData(self._values(reception), has_reason=reception.event.kind == sct.EventKind.error)

    def _values(self, reception: rosgraph.Reception) -> list[ex.Expression]:
        return [given.value for given in reception.inputs] + self._data.values_read(reception.event)

    # The node's life

    def set_parameters(self, values: Mapping[str, Value]) -> None:
        """Takes the values of parameters that the model declares, by their names on the robot; never within a batch."""
        for name, value in values.items():
            if name in self._parameters:
                parameter = self._parameters[name]
                self._data.variables[parameter] = value
                for duration in parameter.durations:
                    self._control.timers.set_duration(duration, set_milliseconds(float(value), duration.unit))

    def log_to(self, log: EventLog) -> None:
        """Has the event log written there; before the start."""
        self._log = log

    def flush_log(self) -> None:
        """Waits until all events so far are in the log."""
        self._log.flush()

    def start(self) -> None:
        """Begins to act."""
        raise NotImplementedError

    def stop(self) -> None:
        """Is called before the node ends, while it can still send."""

    @property
    def busy(self) -> bool:
        """Whether the node's end waits for the fate of a goal."""
        return any(goals.waits for goals in self.goals.values())

    def close(self) -> None:
        """Abandon all goals and close the log; nothing may happen any more."""
        for goals in self.goals.values():
            goals.leave()
        self._log.close()

    # What comes in

    @contextmanager
    def _batch(self) -> Iterator[None]:
        """A batch: its events happen with nothing in between; events that become possible follow."""
        with self._times:
            yield
            self._control.settle()

    def _expire(self) -> None:
        """Some time may be up. What arrived before is handled before it."""
        self._port.hear()
        with self._times:
            while self._control.expire() is not None:
                self._follow_up()

    def _follow_up(self) -> None:
        """Does what a time that was up made possible, if the control loop has not."""

    def receive(self, subscription: rosgraph.Subscription, message: Message) -> None:
        """A message on a topic: a batch of events. One that can't be read counts as not received."""
        with self._batch():
            read = [self._receive(reception, subscription.topic, message) for reception in subscription.receptions]
            if all(read):
                self._note_received(subscription)

    def _note_received(self, subscription: rosgraph.Subscription) -> None:
        """All of a message was read."""

    def feed_back(self, client: rosgraph.ActionClient, message: Message) -> None:
        """Feedback of the goal at hand."""
        with self._batch():
            self._receive(client.feedback, client.identifier, message)

    def _receive(self, reception: rosgraph.Reception, name: str, message: Message) -> bool:
        """A message or feedback, as an event; False where it can't be read, which is reported."""
        fault = self._perform(reception.event, reception.inputs, message)
        if fault is not None:
            self._warn(reception.event, f"{name}: {fault}")
        return fault is None

    def respond(self, client: Client, message: Message) -> None:
        """The response of a service, or the result of a goal that succeeded; one that can't be read is an error."""
        with self._batch():
            response = client.response.event
            fault = self._perform(response, client.response.inputs, message)
            if fault is not None:
                self._note_failure(client, str(fault))
                self._end(client.error, Failure.UNREADABLE, message, response)
            else:
                self._note_success(client)

    def fail(self, client: Client, reason: Failure, why: str, result: Message = None) -> None:
        """A call or goal has failed. `result` is what came with the end of a goal, None where nothing came."""
        self._note_failure(client, why)
        with self._batch():
            self._end(client.error, reason, result)

    def end_canceled(self, client: rosgraph.ActionClient, reason: Failure, why: str, result: Message = None) -> None:
        """A goal has ended because of a cancel: an error, for a reason, where the model has not canceled it."""
        if not self._control.enabled(event_name(client.canceled.event)):
            self.fail(client, reason, why, result)
            return
        self._note_success(client)
        with self._batch():
            self._end(client.canceled, reason, result)

    def _end(
        self, reception: rosgraph.Reception, reason: Failure, result: Message, source: sct.Event | None = None
    ) -> None:
        """Lets an end happen whose data can always be read; without a result it is one with ROS's defaults.

        `source` is the response whose data could not be read.
        """
        if result is None and self._logged[reception.event].parts:
            result = self._port.create(reception.eContainer().interface, Section.RESULT)
        self._data.reason = reason
        self._perform(reception.event, reception.inputs, result, source)
        self._data.reason = None

    def _note_success(self, client: Client) -> None:
        """A call or goal has come to a response that can be read."""

    def _note_failure(self, client: Client, why: str) -> None:
        """A call or goal has failed."""
        self._port.warn(f"{client.identifier}: {why}")

    def _perform(
        self,
        event: sct.Event,
        inputs: Sequence[rosgraph.InputAssignment] = (),
        message: Message = None,
        source: sct.Event | None = None,
    ) -> UnreadableError | None:
        """Lets an event of the robot happen, if it can now; returns what keeps its data from being read.

        `source` is the event that the message came with; None: it is the event itself.
        """
        if not self._control.enabled(event_name(event)):
            return None
        try:
            received = self._data.received(event, inputs, message)
        except UnreadableError as fault:
            return fault
        self._data.variables.update(received.variables)
        self._run(event, (source or event, message), received.inputs)
        return None

    def _run(
        self,
        event: sct.Event,
        received: tuple[sct.Event, Message],
        inputs: Mapping[str, Any] | None = None,
    ) -> None:
        self._received = received
        self._control.perform(event_name(event), inputs)
        self._received = None

    def _changes(self, event: sct.Event) -> bool:
        """Changes the node's variables as an event without data does; False where these can't be read: as reported."""
        try:
            self._data.variables.update(self._data.received(event).variables)
        except UnreadableError as fault:
            self._warn(event, f"{event_name(event)}: {fault}")
            return False
        return True

    # What happens

    def _before(self, name: str) -> bool:
        event = self._events[name]
        if not self._may_happen(event):
            return False
        return event in self._incoming or self._changes(event) or not self._may_wait(event)

    def _may_wait(self, event: sct.Event) -> bool:  # noqa: ARG002  # what a controller does by itself may
        """Whether an event that nobody in the robot has told of need not happen."""
        return False

    def _may_happen(self, event: sct.Event) -> bool:  # noqa: ARG002  # a controller withholds some
        """Whether an enabled event may happen now, so that it is not withheld."""
        return True

    def _after(self, name: str) -> None:
        event = self._events[name]
        data = self._logged_data(event) if self._log.active else None
        direction, data = self._act(event) or ("in" if event in self._incoming else "internal", data)
        self._log.write(self._port.now(), direction, name, data)
        if lost := self._log.lost():
            self._port.warn(f"the event log lost {lost} events")
        self._reports.add_transition(name)

    def _act(self, event: sct.Event) -> tuple[str, Mapping[str, Json] | None] | None:
        """Does what an event that has happened asks for; the direction and data of its line in the log, if it sends."""
        raise NotImplementedError

    def _logged_data(self, event: sct.Event) -> Mapping[str, Json] | None:
        """The data of an event that happens now, for the event log."""
        if self._received is None:
            return None
        source, message = self._received
        if source is not event:
            read = self._unread[source].read(self._data, message) or {"value": {}}
            return {**read, **self._logged[event].reason(self._data)}
        return self._logged[event].read(self._data, message) if event in self._logged else None

    # What `/diagnostics` tells

    def _held_back(self, event: sct.Event) -> str | None:  # noqa: ARG002  # a layer hands on what is allowed
        """Why a command is not sent that the supervisor allows; None where it can be."""
        return None

    def _faults(self, parts: Parts) -> list[str]:
        """Return the faults of a component."""
        raise NotImplementedError

    def _report_livelock(self) -> None:
        self._port.error("internal transitions follow each other without end")
