"""Common base of controller and layer: incoming data becomes events, which are logged."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol

from robosc.base.ros_types import Section
from robosc.engine import ControlLoop, Hooks
from robosc.language.configuration import REPORTS_VIOLATIONS
from robosc.language.configuration.parameters import model_parameters
from robosc.model import engine, rosgraph, sct
from robosc.model.semantics.durations import set_milliseconds
from robosc.model.semantics.messages import received_messages, receptions
from robosc.model.semantics.operators import UnreadableError
from robosc.model.semantics.roles import event_name, plant_of
from robosc.run.runtime.core.blocking import Blocking
from robosc.run.runtime.core.component_status import Own, StatusReporter
from robosc.run.runtime.core.event_log import EventLog, ReceivedData
from robosc.run.runtime.core.json_text import Json, json_text
from robosc.run.runtime.core.node_data import NodeData
from robosc.run.runtime.core.port import Failure
from robosc.run.runtime.core.reports import StateReporter, Throttle
from robosc.run.runtime.core.times import Times
from robosc.run.runtime.core.violations import ViolationError, Violations

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.engine import Settings as LoopSettings
    from robosc.language.configuration.parameters import Value
    from robosc.model import expression as ex
    from robosc.model.semantics.component_parts import Parts
    from robosc.run.runtime.core.event_loop import EventLoop
    from robosc.run.runtime.core.port import Client, Message, Port
    from robosc.run.runtime.core.settings import Settings


def _unset_objects(graph: rosgraph.RosGraph, port: Port) -> dict[rosgraph.NodeVariable, Message]:
    """Return the initial objects of a node's variables, each new data of its ROS type."""
    sources = {
        reception: (interface, section)
        for interface, section, several in received_messages(graph)
        for reception in several
    }
    return {
        variable: port.unset(*sources[variable.reception], variable.path)
        for variable in graph.variables
        if isinstance(variable.type, rosgraph.ObjectType) and variable.reception is not None
    }


class Goals(Protocol):
    """Goals of one action, one at a time."""

    def cancel(self) -> object:
        """Cancel the present goal."""

    @property
    def trouble(self) -> str:
        """Why the goal has not ended though it should have; empty if nothing is wrong."""

    @property
    def waits(self) -> bool:
        """Whether the stopping node waits: for the goal's acceptance, the answer to a cancel request, or the end."""

    def leave(self) -> None:
        """Report a goal that was to be canceled and has not ended when the node ends."""


class EventHandler:
    """Perform the events of one graph with their data. An event whose data can't be read does not happen.

    Call all functions in the event loop's thread. Raises OSError if the event log can't be written.
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
        stop = settings.configuration.stops_on_violation(graph.model)
        self._violations = Violations(self._control.engine, stop=stop)
        configuration, controlled = settings.configuration, self._control.engine
        self._reports = StateReporter(graph, controlled, self._data, port, configuration, self._violations)
        self._blocking = Blocking(self._control.engine)
        own = Own(self._violations.of, self._held_back, self._faults)
        self._statuses = StatusReporter(graph, port, self._data, self._blocking, own)
        if "diagnostics_ms" in settings.parameters:
            self._statuses.report_every(settings.number("diagnostics_ms"), settings.number("period_ms"))
        self._warn = Throttle(port.warn, event_loop.clock)
        self._err = Throttle(port.error, event_loop.clock)
        self._events = {event_name(event): event for plant in graph.model.plants for event in plant.events}
        self._names = {event: name for name, event in self._events.items()}
        self._incoming = self._of_role(engine.Role.incoming)
        #: Goals of the actions, by the event that cancels them.
        self.goals: dict[sct.Event, Goals] = {}
        #: Data of the command that is about to happen.
        self._sent: Message = None
        #: Message of the present event, and the event that it was received as.
        self._received: tuple[sct.Event, Message] | None = None
        self._logged = {reception.event: self._read(reception) for reception in receptions(graph)}
        clients: list[Client] = [*graph.serviceClients, *graph.actionClients]
        #: Logged data of answers that can't be read and so are errors.
        self._unread = {
            client.response.event: ReceivedData([*self._values(client.response), *self._values(client.error)])
            for client in clients
        }

    def _of_role(self, *roles: engine.Role) -> set[sct.Event]:
        """Return the events with one of these roles in the control loop."""
        executed = self._control.engine.executed
        return {self._events[event.name] for event in executed.events if event.role in roles}

    def _read(self, reception: rosgraph.Reception) -> ReceivedData:
        return ReceivedData(self._values(reception), has_reason=reception.event.kind == sct.EventKind.error)

    def _values(self, reception: rosgraph.Reception) -> list[ex.Expression]:
        return [assignment.value for assignment in reception.inputs] + self._data.values_read(reception.event)

    # The node's life

    def set_parameters(self, values: Mapping[str, Value]) -> None:
        """Set parameters of the model, by their names on the robot. Do not call this within a batch."""
        for name, value in values.items():
            if name in self._parameters:
                parameter = self._parameters[name]
                self._data.variables[parameter] = value
                for duration in parameter.durations:
                    self._control.timers.set_duration(duration, set_milliseconds(float(value), duration.unit))

    def log_to(self, log: EventLog) -> None:
        """Replace the event log; only before the start."""
        self._log = log

    def flush_log(self) -> None:
        """Wait until all events so far are in the log."""
        self._log.flush()

    def start(self) -> None:
        """Begin to act."""
        raise NotImplementedError

    def stop(self) -> None:
        """Prepare the end of the node, while it can still send."""

    @property
    def busy(self) -> bool:
        """Whether the stopping node waits for the fate of a goal."""
        return any(goals.waits for goals in self.goals.values())

    def close(self) -> None:
        """Abandon all goals and close the log; no event may happen after that."""
        for goals in self.goals.values():
            goals.leave()
        self._log.close()

    # Incoming data

    @contextmanager
    def _batch(self) -> Iterator[None]:
        """Group events that happen without others in between; the events that they enable follow."""
        with self._times:
            yield
            self._control.settle()
        self._stop_if_violated()

    def _stop_if_violated(self) -> None:
        """Stop the robot after the first violation, unless the node only reports violations."""
        if self._violations.take_halt():
            self._port.error(
                "commands are held back: the robot violated an assumption, and is no longer as the model describes"
            )
            self._halt()

    def _halt(self) -> None:
        """Stop the robot."""
        raise NotImplementedError

    def _cancel_goals(self) -> None:
        """Cancel all goals, in the model, too."""
        with self._batch():
            for event, goals in self.goals.items():
                self._control.perform(event_name(event))
                goals.cancel()

    def _warn_of_report(self) -> None:
        """Warn at the start if the node goes on after a violation."""
        if self._violations.exist and self._settings.configuration.on_violation == "report":
            self._port.warn(REPORTS_VIOLATIONS)

    def _expire(self) -> None:
        """Handle expired timers, after the messages that arrived before."""
        self._port.hear()
        with self._times:
            while self._control.expire() is not None:
                self._follow_up()

    def _follow_up(self) -> None:
        """Perform the events that an expired timer enabled, unless the control loop does that."""

    def receive(self, subscription: rosgraph.Subscription, message: Message) -> None:
        """Handle a message on a topic as a batch of events. A message that can't be read counts as not received."""
        with self._batch():
            results = [self._receive(reception, subscription.topic, message) for reception in subscription.receptions]
            if all(results):
                self._note_received(subscription)

    def _note_received(self, subscription: rosgraph.Subscription) -> None:
        """Note that all of a message was read."""

    def feed_back(self, client: rosgraph.ActionClient, message: Message) -> None:
        """Handle feedback of the present goal."""
        with self._batch():
            self._receive(client.feedback, client.identifier, message)

    def _receive(self, reception: rosgraph.Reception, name: str, message: Message) -> bool:
        """Handle a message or feedback as an event; report data that can't be read and return False.

        An event against an assumption counts as one whose data can't be read.
        """
        fault = self._perform(reception.event, reception.inputs, message)
        if fault is not None and not isinstance(fault, ViolationError):
            self._warn(reception.event, f"{name}: {fault}")
        return fault is None

    def respond(self, client: Client, message: Message) -> None:
        """Handle the response of a service or the result of a goal that succeeded. Unreadable data is an error."""
        with self._batch():
            response = client.response.event
            fault = self._perform(response, client.response.inputs, message)
            if fault is not None:
                self._note_failure(client, str(fault), logged=isinstance(fault, ViolationError))
                self._end(client.error, Failure.UNREADABLE, message, response)
            else:
                self._note_success(client)

    def fail(self, client: Client, reason: Failure, why: str, result: Message = None) -> None:
        """Handle a failed call or goal. `result` came with the end of the goal; None if there is none."""
        self._note_failure(client, why)
        with self._batch():
            self._end(client.error, reason, result)

    def end_canceled(self, client: rosgraph.ActionClient, reason: Failure, why: str, result: Message = None) -> None:
        """Handle the end of a canceled goal: an error with this reason unless the model canceled the goal."""
        if not self._control.enabled(event_name(client.canceled.event)):
            self.fail(client, reason, why, result)
            return
        self._note_success(client)
        with self._batch():
            self._end(client.canceled, reason, result)

    def _end(
        self, reception: rosgraph.Reception, reason: Failure, result: Message, source: sct.Event | None = None
    ) -> None:
        """Perform an end of a call or goal whose data can always be read; a missing result has the defaults of ROS.

        `source` is the response whose data could not be read.
        """
        if result is None and self._logged[reception.event].parts:
            result = self._port.create(reception.eContainer().interface, Section.RESULT)
        self._data.reason = reason
        self._perform(reception.event, reception.inputs, result, source)
        self._data.reason = None

    def _note_success(self, client: Client) -> None:
        """Note a response of a call or goal that can be read."""

    def _note_failure(self, client: Client, why: str, *, logged: bool = False) -> None:
        """Note that a call or goal has failed, and warn about it unless the reason is `logged` already."""
        if not logged:
            self._port.warn(f"{client.identifier}: {why}")

    def _perform(
        self,
        event: sct.Event,
        inputs: Sequence[rosgraph.InputAssignment] = (),
        message: Message = None,
        source: sct.Event | None = None,
    ) -> UnreadableError | None:
        """Perform an event of the robot if it is enabled; return why its data can't be read, else None.

        The reason is a ViolationError if an assumption excludes the event. `source` is the event that the message came
        with; None means the event itself.
        """
        if not self._control.enabled(self._names[event]):
            violation = self._violations.check(event)
            if violation is not None:
                logged = self._logged[event].read(self._data, message) if self._log.active else None
                self._log.write(self._port.now(), "violated", event_name(event), logged)
                self._err((event, str(violation)), f"{event_name(event)} {violation}")
            return violation
        try:
            received = self._data.receive(event, inputs, message)
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
        self._control.perform(self._names[event], inputs)
        self._received = None

    def _changes(self, event: sct.Event) -> bool:
        """Change the node's variables for an event of its own; if they can't be read, report it and return False."""
        try:
            self._data.variables.update(self._data.receive(event, data=self._sent).variables)
        except UnreadableError as fault:
            self._warn(event, f"{event_name(event)}: {fault}")
            return False
        return True

    # Events

    def _before(self, name: str) -> bool:
        event = self._events[name]
        if not self._may_happen(event):
            return False
        return event in self._incoming or self._changes(event) or not self._may_wait(event)

    def _may_wait(self, event: sct.Event) -> bool:  # noqa: ARG002  # internal events of a controller may wait
        """Return whether an enabled event that the robot did not cause may be postponed."""
        return False

    def _may_happen(self, event: sct.Event) -> bool:  # noqa: ARG002  # a controller withholds some
        """Return whether an enabled event may happen now, so that it is not withheld."""
        return True

    def _after(self, name: str) -> None:
        event = self._events[name]
        data = self._logged_data(event) if self._log.active else None
        direction, data = self._act(event) or ("in" if event in self._incoming else "internal", data)
        if self._log.active:
            self._log.write(self._port.now(), direction, name, data)
            if lost := self._log.lost():
                self._port.warn(f"the event log lost {lost} events")
        self._reports.add_transition(name)

    def _act(self, event: sct.Event) -> tuple[str, Mapping[str, Json] | None] | None:
        """Send the data of an event that has happened; if any, return the direction and data of its log line."""
        raise NotImplementedError

    def _logged_data(self, event: sct.Event) -> Mapping[str, Json] | None:
        """Return the data of the present event for the event log."""
        if self._received is None:
            return None
        source, message = self._received
        if source is not event:
            # A response without data that the node reads may still violate an assumption.
            logged = self._unread[source].read(self._data, message) or (
                {"value": {}} if self._unread[source].parts else {}
            )
            return {**logged, **self._logged[event].reason(self._data)} or None
        return self._logged[event].read(self._data, message) if event in self._logged else None

    def _publish_blocked(self, event: sct.Event, reason: str, because: Sequence[str]) -> None:
        """Publish on `~/blocked` that a command is blocked, and warn."""
        plant = plant_of(event)
        name = plant.origin or plant.name
        report: dict[str, Json] = {
            "robot": self._graph.name,
            "time": self._port.now(),
            "name": name,
            "event": event_name(event),
            "reason": reason,
            "because": because,
            "components": self._reports.components(),
        }
        self._port.publish_report("blocked", json_text(report))
        self._warn(event, f"{name} is blocked: {reason} {json_text(because)}")

    # Contents of `/diagnostics`

    def _held_back(self, event: sct.Event) -> str | None:  # noqa: ARG002  # a violation holds back all commands
        """Return why a command that the supervisor allows is not sent; None if it can be sent."""
        return "an assumption is violated" if self._violations.stopped else None

    def _faults(self, parts: Parts) -> list[str]:
        """Return the faults of a component."""
        raise NotImplementedError

    def _report_livelock(self) -> None:
        self._port.error("internal transitions follow each other without end")
