"""The supervisory layer between a controller and its robot: what passes and what is blocked (thesis section 4.7)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.engine import ControlLoop, Hooks
from robosc.metamodel import rosgraph, sct
from robosc.runtime.core.happenings import Happenings
from robosc.runtime.core.json_text import Json, json_text
from robosc.runtime.core.node_data import NodeData
from robosc.runtime.core.reports import EventLog
from robosc.runtime.core.state import StateReporter
from robosc.runtime.core.throttle import Throttle
from robosc.semantics.definition import definition_text
from robosc.semantics.edges import edges_from, edges_of
from robosc.semantics.roles import Roles, event_name, plant_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.runtime.core.agenda import Agenda
    from robosc.runtime.core.port import Message, Reporting
    from robosc.runtime.core.settings import Settings

_Client = rosgraph.ServiceClient | rosgraph.ActionClient


class Layer:
    """The layer of a robot. All its functions belong to the thread that works on the agenda; others forward.

    What the robot tells moves the supervisor before it is forwarded (`hear`, `respond`, `fail`, `feed_back`); what the
    controller sends is forwarded where `passes` allows it. `cancels`: what cancels the goal of an action, by event; set
    by whoever forwards. Raises OSError where the event log can't be written.
    """

    def __init__(self, graph: rosgraph.RosGraph, settings: Settings, port: Reporting, agenda: Agenda) -> None:
        self._graph = graph
        self._port = port
        self._agenda = agenda
        self._period = settings.seconds("period_ms")
        self._log = EventLog(str(settings.parameters["event_log"]))
        self._loop = ControlLoop(
            graph.model, hooks=Hooks(before=self._before, after=self._after, livelock=self._livelock)
        )
        self._data = NodeData(graph, self._loop.engine)
        self._reports = StateReporter(graph, self._loop.engine, self._data, port, settings.configuration)
        self._happenings = Happenings(graph, self._data, self._loop)
        self._warn = Throttle(port.warn, agenda.clock)
        roles = Roles(graph.model)
        self._events = {event_name(each): each for each in roles.events}
        self._incoming = set(roles.incoming)
        self._sent = {*roles.triggers, *roles.cancels}
        self._ignored = {each for events in roles.data for each in events}
        assert graph.model.supervisor is not None
        self._explained = {each.event: [each.explanation] for each in graph.model.supervisor.guards if each.explanation}
        self.cancels: dict[sct.Event, Callable[[], None]] = {}

    def flush_log(self) -> None:
        """Waits until all events so far are in the log."""
        self._log.flush()

    def start(self) -> None:
        """Tells what it is, and reports its state from now on."""
        self._reports.define(definition_text(self._graph))
        self._loop.settle()
        self._report()

    def _report(self) -> None:
        self._reports.publish(self._port.now())
        self._agenda.after(self._period, self._report)

    @property
    def busy(self) -> bool:
        """Whether the end has to wait for anything: a layer leaves goals to the controller."""
        return False

    def stop(self) -> None:
        """Before the node ends. The robot is the controller's to stop."""

    def close(self) -> None:
        """Nothing more will happen."""
        self._log.close()

    # From the robot

    def hear(self, subscription: rosgraph.Subscription, message: Message) -> None:
        """A message on a topic, before it is forwarded. One that can't be read counts as not received."""
        for each in subscription.receptions:
            self._hear(each, subscription.topic, message)

    def respond(self, client: _Client, message: Message) -> None:
        """The answer of a service, or the result of a goal that succeeded, before it is forwarded.

        One that can't be read counts as an error.
        """
        unread = self._happenings.perform(client.response.event, client.response.inputs, message)
        if unread is not None:
            self._port.warn(f"{client.identifier}: {unread}")
            self._happenings.reject(client, message)
        self._loop.settle()

    def feed_back(self, client: rosgraph.ActionClient, message: Message) -> None:
        """Feedback of the goal at hand, before it is forwarded."""
        self._hear(client.feedback, client.identifier, message)

    def fail(self, client: _Client, why: str) -> None:
        """A call or goal has come to nothing."""
        self._port.warn(f"{client.identifier}: {why}")
        self._happenings.perform(client.error)
        self._loop.settle()

    def _hear(self, reception: rosgraph.Reception, name: str, message: Message) -> None:
        unread = self._happenings.perform(reception.event, reception.inputs, message)
        if unread is not None:
            self._warn(reception.event, f"{name}: {unread}")
        self._loop.settle()

    # From the controller

    def passes(self, sending: rosgraph.Sending) -> bool:
        """Whether what the controller sends may go on; it has then happened to the supervisor. Else it is reported."""
        if self._loop.perform(event_name(sending.event)):
            self._loop.settle()
            return True
        reason, because = self._reason(sending.event)
        self._block(sending.event, reason, because)
        return False

    def turn_away(self, sending: rosgraph.Sending) -> None:
        """A call or goal is turned away because another one has not ended."""
        self._block(sending.event, "busy", [])

    def _reason(self, event: sct.Event) -> tuple[str, list[str]]:
        failing = self._loop.engine.failing(event_name(event))
        if failing:
            return "requirement", [each.text or "a requirement" for each in failing]
        missing = [place for plant in self._graph.model.plants for place in self._missing(plant, event)]
        return ("state", missing) if missing else ("synthesis", self._explained.get(event, []))

    def _missing(self, plant: sct.Plant, event: sct.Event) -> list[str]:
        """The location of a plant that takes part in the event, where it has no transition for it."""
        if not any(edge.event == event for edge in edges_of(plant)):
            return []
        here = next(each for each in plant.locations if self._data.is_in(each))
        possible = any(
            edge.event == event and (edge.guard is None or self._data.value(edge.guard)) for edge in edges_from(here)
        )
        return [] if possible else [f"{plant.origin or plant.name}.{here.name}"]

    def _block(self, event: sct.Event, reason: str, because: list[str]) -> None:
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
        self._port.tell("blocked", json_text(report))
        self._log.write(self._port.now(), "blocked", event_name(event))
        self._port.warn(f"{name} is blocked: {reason} {json_text(because)}")

    # What happens

    def _before(self, name: str) -> bool:
        event = self._events[name]
        if event not in self._incoming:
            self._happenings.change(event)
        return True

    def _after(self, name: str) -> None:
        event = self._events[name]
        noted = self._happenings.noted(event) if self._log.active else None
        if event in self._ignored:
            return
        if event in self.cancels:
            self.cancels[event]()
        direction = "out" if event in self._sent else "in" if event in self._incoming else "internal"
        self._log.write(self._port.now(), direction, name, noted)
        if lost := self._log.lost():
            self._port.warn(f"the event log lost {lost} events")
        self._reports.note(name)

    def _livelock(self) -> None:
        self._port.error("internal transitions follow each other without end")


def hearing(layer: Layer, topic: rosgraph.Subscription) -> Callable[[Message], bool]:
    """What is done with a message of the robot's on a topic; whether it is forwarded: always."""

    def hear(message: Message) -> bool:
        layer.hear(topic, message)
        return True

    return hear


def passing(layer: Layer, sending: rosgraph.Sending) -> Callable[[Message], bool]:
    """What is done with a message of the controller's; whether it is forwarded."""
    return lambda _: layer.passes(sending)
