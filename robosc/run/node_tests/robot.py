"""Simulated robot of a test: everything that the controller is connected to, without ROS."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.base.ros_types import Section
from robosc.model.semantics.messages import fields_set, limit_expressions, reads, sent_messages
from robosc.run.node_tests.messages import Definition, Field, Path, data_read, fields_sent, message, new_object

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.base.ros_types import RosDistribution
    from robosc.model import rosgraph, sct
    from robosc.run.node_tests.samples import IncomingKind
    from robosc.run.runtime.core.port import (
        CallHandlers,
        Client,
        ComponentStatus,
        Endpoint,
        GoalHandlers,
        GoalOutcome,
        Message,
        Server,
    )


@dataclass
class RunningGoal:
    """Goal that the robot works on. After a cancel request it goes on until its end is played.

    `is_asked`: a request to cancel it waits for an answer. `sent`: its time in seconds. `accepted`: the time at which
    the robot first showed that it had accepted the goal, None before that.
    """

    handlers: GoalHandlers
    is_asked: bool = False
    sent: float = 0.0
    accepted: float | None = None

    def cancel(self) -> None:
        """Note a request to cancel; the goal has not ended."""
        self.is_asked = True

    def is_canceling(self) -> bool:
        """Return False: a played end is final."""
        return False

    def is_gone(self) -> bool:
        """Return False: the robot stays."""
        return False


class PlayedRequest:
    """Request or goal of a client of the controller. The log records the answers."""

    is_answered = True

    def give(self, response: Message = None) -> None:
        """Take the response."""

    def feed_back(self, feedback: Message) -> None:
        """Take feedback."""

    def end(self, outcome: GoalOutcome, result: Message) -> None:
        """Take the end of the goal."""


class Robot:
    """Port (`robosc.run.runtime.core.port.ControllerPort`) with available servers whose answers the test plays."""

    def __init__(
        self,
        graph: rosgraph.RosGraph,
        distribution: RosDistribution,
        clock: Callable[[], float],
        incoming: Mapping[sct.Event, IncomingKind],
    ) -> None:
        self.now = clock
        #: Pending calls, each with its start time.
        self.calls: dict[rosgraph.ServiceClient, tuple[float, CallHandlers]] = {}
        self.goals: dict[rosgraph.ActionClient, RunningGoal] = {}
        self._distribution = distribution
        self._fields: dict[tuple[rosgraph.Interface, Section], dict[Path, Field]] = {}
        for interface, section, sending in sent_messages(graph):
            self._note(interface, section, sending)
        for action in graph.actionClients:
            results = self._fields.setdefault((action.interface, Section.RESULT), {})
            for end in (action.error, action.canceled):
                results |= incoming[end.event].fields

    def _note(self, interface: rosgraph.Interface, section: Section, sending: rosgraph.Sending) -> None:
        fields = self._fields.setdefault((interface, section), {})
        definition = Definition(self._distribution, interface, section)
        sent = (known for field in fields_set(sending) for known in fields_sent(field))
        expressions = [*limit_expressions(sending), *(assigned.value for assigned in sending.inputs)]
        for path, kind in (*sent, *data_read(reads(expressions))):
            fields[path] = definition.field(path, kind)

    # Calls of the controller

    def hear(self) -> None:
        """Do nothing: the robot's messages are handled at once."""

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        """Return data with the fields that the model sets, or reads after a goal ended without a result."""
        fields = self._fields.get((interface, section))
        return message(fields, {}) if fields else None

    def unset(self, interface: rosgraph.Interface, section: Section, path: Sequence[str]) -> Message:
        """Return an object before anything is stored in it, with the known fields of its type."""
        return new_object(self._distribution, interface, section, path)

    def wire_types(self, owner: Message) -> Mapping[str, str]:
        """Return the types of the fields that the model sets."""
        types: Mapping[str, str] = owner.wire_types
        return types

    def stamp(self, message: Message, frame: str) -> None:
        """Do nothing: no test reads the header."""

    def type_name(self, interface: rosgraph.Interface) -> str:
        """Return the name of a type."""
        return f"{interface.package}/{interface.type}"

    def publish(self, publisher: rosgraph.Publisher, message: Message) -> None:
        """Do nothing: the log records the message."""

    def is_served(self, client: rosgraph.ServiceClient | rosgraph.ActionClient) -> bool:
        """Return True: all servers are available."""
        del client
        return True

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: CallHandlers) -> None:
        """Keep the call until its answer is played."""
        del request
        self.calls[client] = (self.now(), handlers)

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> RunningGoal:
        """Accept a goal and keep it until its end is played."""
        del goal
        self.goals[client] = RunningGoal(handlers, sent=self.now())
        handlers.accepted()
        return self.goals[client]

    def publish_report(self, name: str, text: str) -> None:
        """Do nothing: no test reads reports."""

    def report_listeners(self, name: str) -> int:
        """Return 0: no test reads reports."""
        del name
        return 0

    def publish_statuses(self, statuses: Sequence[ComponentStatus]) -> None:
        """Do nothing: no test reads statuses."""

    def status_listeners(self) -> int:
        """Return 0: no test reads statuses."""
        return 0

    def serving_nodes(self, element: Client | Server) -> list[tuple[str, str]]:  # noqa: ARG002  # a trace has no other nodes
        """Return nothing: there is no other node."""
        return []

    def calling_nodes(self, client: Client) -> list[str]:  # noqa: ARG002  # a trace has no other nodes
        """Return nothing: there is no other node."""
        return []

    def endpoints(self) -> dict[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        """Return nothing: there is no other node."""
        return {}

    def info(self, text: str) -> None:
        """Do nothing: no test reads the log."""

    warn = error = info
