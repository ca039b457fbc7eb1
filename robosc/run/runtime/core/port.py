"""Interface of the middleware to controller and layer, and callbacks for answers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.base.ros_types import Section
    from robosc.model import rosgraph

#: Data of ROS: an object with fields as attributes; arrays can be indexed and have a length.
Message: TypeAlias = Any
#: Server that the node calls: its client in the ROS graph.
Client: TypeAlias = "rosgraph.ServiceClient | rosgraph.ActionClient"
#: Server of the node.
Server: TypeAlias = "rosgraph.ServiceServer | rosgraph.ActionServer"


class GoalOutcome(StrEnum):
    """End of a goal. `LOST`: its server no longer knows it or its end; the robot may still move."""

    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"
    LOST = "lost"


class Failure(StrEnum):
    """Failure reason of a service or action: the values of the predefined enum `Failure`."""

    UNAVAILABLE = "unavailable"
    REJECTED = "rejected"
    TIMEOUT = "timeout"
    LOST = "lost"
    ABORTED = "aborted"
    CANCELED = "canceled"
    FAILED = "failed"
    UNREADABLE = "unreadable"


class CancelAnswer(StrEnum):
    """Answer of a server to a request to cancel a goal.

    `TERMINATED`: the goal has ended or is being canceled; `UNKNOWN`: the server does not know it.
    """

    ACCEPTED = "accepted"
    REFUSED = "refused"
    TERMINATED = "terminated"
    UNKNOWN = "unknown"


@dataclass(frozen=True)
class CallHandlers:
    """End of a call: one handler is called, from any thread. `failed` gets the reason."""

    answered: Callable[[Message], None]
    failed: Callable[[str], None]


@dataclass(frozen=True)
class GoalHandlers:
    """Callbacks for the fate of a goal, called from any thread.

    `ended` gets the result, None if there is none, and the server's own text.
    """

    accepted: Callable[[], None]
    rejected: Callable[[], None]
    feedback: Callable[[Message], None]
    ended: Callable[[GoalOutcome, Message, str], None]
    cancel_answered: Callable[[CancelAnswer], None]


class Goal(Protocol):
    """Goal that was sent."""

    def cancel(self) -> None:
        """Request that the server cancel the goal.

        A server that does not know the goal yet may ignore the request.
        """

    def is_canceling(self) -> bool:
        """Return whether the server reports that the goal is being canceled."""

    def is_gone(self) -> bool:
        """Return whether the server that has the goal is gone; called repeatedly."""


class Answer(Protocol):
    """Answer that a caller of a service waits for."""

    def give(self, response: Message = None) -> None:
        """Answer, once; without a response, with an unset one: services of ROS 2 have no errors."""


class ServedGoal(Protocol):
    """Goal of a client that the node has accepted."""

    @property
    def is_answered(self) -> bool:
        """Whether the middleware has sent the result to the clients that wait for it."""

    def feed_back(self, feedback: Message) -> None:
        """Publish feedback."""

    def end(self, outcome: GoalOutcome, result: Message) -> None:
        """End the goal as succeeded, canceled or aborted, once."""


@dataclass(frozen=True)
class ComponentStatus:
    """Status of a component: its level, its state and faults in words, and further values."""

    component: str
    level: Literal["OK", "WARN", "ERROR"]
    message: str
    values: Sequence[tuple[str, str]]


class Port(Protocol):
    """ROS node as a supervisory layer needs it: it publishes reports, logs, and calls services."""

    def now(self) -> float:
        """Return the node's time in seconds."""

    def publish_report(self, name: str, text: str) -> None:
        """Publish a text on `~/state`, `~/definition` or `~/blocked`; `name` is the last part."""

    def report_listeners(self, name: str) -> int:
        """Return the number of subscriptions to one of these."""

    def publish_statuses(self, statuses: Sequence[ComponentStatus]) -> None:
        """Publish statuses on `/diagnostics`."""

    def status_listeners(self) -> int:
        """Return the number of subscriptions to `/diagnostics`."""

    def info(self, text: str) -> None:
        """Log a text."""

    def warn(self, text: str) -> None:
        """Log a warning."""

    def error(self, text: str) -> None:
        """Log an error."""

    def hear(self) -> None:
        """Handle the messages that have arrived, so that they come before an expired timer."""

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        """Return data with every field at its ROS default."""

    def unset(self, interface: rosgraph.Interface, section: Section, path: Sequence[str]) -> Message:
        """Return the object at a path in such data, as `create` makes it.

        A step `0` is an element of an array.
        """

    def is_served(self, client: Client) -> bool:
        """Return whether there is a server."""

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: CallHandlers) -> None:
        """Call a service; the handlers are not called before this returns."""


class ControllerPort(Port, Protocol):
    """ROS node as a controller needs it. Names of topics and servers are resolved as the node's are."""

    def stamp(self, message: Message, frame: str) -> None:
        """Set the time and frame of the header of a message or message part, if it has one."""

    def type_name(self, interface: rosgraph.Interface) -> str:
        """Return the name of a type as this ROS writes it."""

    def wire_types(self, message: Message) -> Mapping[str, str]:
        """Return the types of the fields as ROS writes them: `float64`, `double`, `string`, `geometry_msgs/Point`."""

    def publish(self, publisher: rosgraph.Publisher, message: Message) -> None:
        """Send a message."""

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> Goal:
        """Send a goal; the handlers are not called before this returns."""

    def serving_nodes(self, element: Client | Server) -> Sequence[tuple[str, str]]:
        """Return the nodes that serve the name of a service or action, each with its type.

        A single server of the right type may be left out. The types are as old as the last call of `endpoints`.
        """

    def calling_nodes(self, client: Client) -> Sequence[str]:
        """Return the other nodes that call a service or send goals to an action."""

    def endpoints(self) -> Mapping[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        """Return the other publishers on the node's topics, and the subscriptions to its own publishers."""


@dataclass(frozen=True)
class Endpoint:
    """Publisher on a topic, or subscription to it (`listens`), of another node.

    `node` is empty if its name is unknown. `type` is as its ROS writes it. `incompatible` describes why its quality of
    service prevents a connection.
    """

    node: str
    type: str
    incompatible: str | None = None
    listens: bool = False
