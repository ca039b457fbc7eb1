"""Supervisory layer between a controller and its robot: passes or blocks messages (thesis section 4.7)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.base.ros_types import Section
from robosc.engine import Settings as LoopSettings
from robosc.model import engine, rosgraph
from robosc.model.semantics.messages import sent_messages
from robosc.model.semantics.roles import assumption_text, event_name
from robosc.run.runtime.core.composer import Composer
from robosc.run.runtime.core.event_handler import EventHandler
from robosc.run.runtime.core.event_log import ReceivedData
from robosc.run.runtime.core.monitors import GraphMonitor
from robosc.run.runtime.core.node_data import UNSENDABLE, why_unsendable
from robosc.run.runtime.core.settings import SafeMessages
from robosc.run.runtime.core.times import RESOLUTION_MS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.model import sct
    from robosc.model.semantics.component_parts import Parts
    from robosc.run.runtime.core.event_loop import EventLoop
    from robosc.run.runtime.core.json_text import Json
    from robosc.run.runtime.core.port import Client, ControllerPort, Message
    from robosc.run.runtime.core.settings import Settings


class Layer(EventHandler):
    """Layer of a robot. It decides; others forward. It sends `on_blocked` of `safe`.

    Messages of the robot move the supervisor before they are forwarded (`receive`, `respond`, `fail`, `feed_back`).
    Messages of the controller are forwarded if `forwarded` allows it. The proxies of actions add their `goals`.
    """

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        settings: Settings,
        port: ControllerPort,
        event_loop: EventLoop,
        safe: SafeMessages | None = None,
    ) -> None:
        super().__init__(graph, settings, port, event_loop, LoopSettings(resolution_ms=RESOLUTION_MS))
        self._period = settings.seconds("period_ms")
        self._outgoing = self._of_role(engine.Role.trigger, engine.Role.cancel)
        self._data_events = self._of_role(engine.Role.data)
        #: Events blocked since the last report on `/diagnostics`.
        self._blocked: set[sct.Event] = set()
        self._composer = Composer(port, self._data)
        publishers = {sending: publisher for publisher in graph.publishers for sending in publisher.sendings}
        #: Publishers of the messages of `on_blocked`, in the order of the configuration.
        self._publishers = {sending: publishers[sending] for sending in (safe or SafeMessages()).on_blocked}
        #: The data of commands that the supervisor decides with, for the event log.
        self._decisive = {
            sending.event: ReceivedData(assigned.value for assigned in sending.inputs)
            for _, _, sending in sent_messages(graph)
            if sending.inputs
        }
        called: list[Client] = [*graph.serviceClients, *graph.actionClients]
        self._monitor = GraphMonitor(port, event_loop, called, layer=True)
        #: Messages of `on_blocked` that were forwarded last: the layer sends one when it blocks the next.
        self._forwarded: set[rosgraph.Sending] = set()

    def start(self) -> None:
        """Publish the definition, and the state from now on."""
        self._reports.publish_definition()
        self._warn_of_report()
        self._times.start()
        self._monitor.start()
        with self._times:
            self._control.settle()
        self._publish_state()

    def _publish_state(self) -> None:
        self._reports.publish_state(self._port.now())
        if self._statuses.publish():
            self._blocked.clear()
        self._event_loop.call_later(self._period, self._publish_state)

    # From the controller

    def _passes(self, sending: rosgraph.Sending, inputs: Mapping[str, Any]) -> bool:
        """Perform the event of a controller's command and return True; report it as blocked if it is not allowed."""
        name, engine = self._names[sending.event], self._control.engine
        engine.set_inputs(name, inputs)
        with self._times:
            # The node's own data change only if the command happens.
            if not self._violations.stopped and engine.permits_inputs(name) and self._control.perform(name):
                self._control.settle()
                if sending in self._publishers:
                    self._forwarded.add(sending)
                return True
        if self._violations.stopped:
            self._block(sending, "assumption", list(map(assumption_text, self._violations.assumptions)))
        else:
            reason = self._blocking.reason(sending.event)
            self._block(sending, reason.kind, reason.because)
        return False

    def forwarded(self, sending: rosgraph.Sending, message: Message) -> Message | None:
        """Return a controller's command with its limits if it passes; report it as blocked and return None if not."""
        inputs, fault = dict[str, Any](), ""
        self._sent = message
        try:
            self._sent = self._composer.limited(sending, message)
            inputs = self._composer.inputs(sending, self._sent)
        except UNSENDABLE as error:
            fault = why_unsendable(error)
        if fault and not self._violations.stopped:
            self._block(sending, "data", [fault])
            passes = False
        else:
            passes = self._passes(sending, inputs)
        forwarded, self._sent = self._sent, None
        return forwarded if passes else None

    def _block(self, sending: rosgraph.Sending, reason: str, because: Sequence[str]) -> None:
        """Report a blocked command, and send the message of `on_blocked` in its place."""
        self._report_blocked(sending.event, reason, because)
        if sending in self._forwarded:
            self._forwarded.remove(sending)
            self._send_instead(sending)

    def _halt(self) -> None:
        """Cancel running goals, and send the messages of `on_blocked`."""
        self._cancel_goals()
        self._forwarded.clear()
        for sending in self._publishers:
            self._send_instead(sending)

    def _send_instead(self, sending: rosgraph.Sending) -> None:
        """Send a message in place of blocked ones, with default data if its own can't be sent."""
        publisher = self._publishers[sending]
        frame = self._settings.configuration.frame_id.get(publisher.topic.removeprefix("/"), "")
        target = sending, publisher.interface, Section.MESSAGE, frame
        try:
            message, logged = self._composer.compose(*target)
        except UNSENDABLE as fault:
            why = why_unsendable(fault)
            self._warn((sending, why), f"{sending.name} is sent with default data: {why}")
            message, logged = self._composer.default(*target), None
        self._composer.port.publish(publisher, message)
        self._log.write(self._port.now(), "outside", event_name(sending.event), logged)

    def reject(self, sending: rosgraph.Sending) -> None:
        """Reject a call or goal because another one has not ended."""
        self._report_blocked(sending.event, "busy", [])

    def _report_blocked(self, event: sct.Event, reason: str, because: Sequence[str]) -> None:
        self._blocked.add(event)
        self._publish_blocked(event, reason, because)
        self._log.write(self._port.now(), "blocked", event_name(event), self._data_of_command(event))

    def _faults(self, parts: Parts) -> list[str]:
        blocked = [f"{sending.name} was blocked" for sending in parts.commands if sending.event in self._blocked]
        troubles = [
            (client.identifier, self.goals[client.cancel].trouble)
            for client in parts.clients
            if isinstance(client, rosgraph.ActionClient) and client.cancel in self.goals
        ]
        unfit = [fault for element in parts.connections for fault in self._monitor.faults(element)]
        return [*blocked, *unfit, *(f"{name}: {trouble}" for name, trouble in troubles if trouble)]

    # Events

    def _follow_up(self) -> None:
        self._control.settle()

    def _after(self, name: str) -> None:
        if self._events[name] not in self._data_events:  # the controller chooses the data
            super()._after(name)

    def _act(self, event: sct.Event) -> tuple[str, Mapping[str, Json] | None] | None:
        if event in self.goals:
            self.goals[event].cancel()
        return ("out", self._data_of_command(event)) if event in self._outgoing else None

    def _data_of_command(self, event: sct.Event) -> Mapping[str, Json] | None:
        """Return the data of the present command that the supervisor decides with, for the event log."""
        if event not in self._decisive or self._sent is None or not self._log.active:
            return None
        return self._decisive[event].read(self._data, self._sent)
