"""The interface of the middleware to controller and layer, and the callbacks for answers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.metamodel import rosgraph
    from robosc.ros_types import Section

#: Data of ROS: an object with fields as attributes; arrays can be indexed and have a length.
Message: TypeAlias = Any
#: A server that the node calls: its client in the ROS graph.
Client: TypeAlias = "rosgraph.ServiceClient | rosgraph.ActionClient"


class Outcome(StrEnum):
    """How a goal has ended. `LOST`: its server does not know it any more, or its end; the robot may still move."""

    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"
    LOST = "lost"


class Failure(StrEnum):
    """Why a service or an action has failed: the values of the predefined enum `Failure`."""

    UNAVAILABLE = "unavailable"
    REJECTED = "rejected"
    TIMEOUT = "timeout"
    LOST = "lost"
    ABORTED = "aborted"
    CANCELED = "canceled"
    FAILED = "failed"
    UNREADABLE = "unreadable"


class CancelAnswer(StrEnum):
    """A server's answer to a request to cancel a goal.

    `TERMINATED`: the goal has ended or is being canceled; `UNKNOWN`: the server does not know it.
    """

    ACCEPTED = "accepted"
    REFUSED = "refused"
    TERMINATED = "terminated"
    UNKNOWN = "unknown"


@dataclass(frozen=True)
class CallHandlers:
    """The end of a call: one of them is called, from any thread. `failed` gets the reason."""

    answered: Callable[[Message], None]
    failed: Callable[[str], None]


@dataclass(frozen=True)
class GoalHandlers:
    """Callbacks for the fate of a goal, called from any thread.

    `ended` gets the result, None where none came, and the server's own text.
    """

    accepted: Callable[[], None]
    rejected: Callable[[], None]
    feedback: Callable[[Message], None]
    ended: Callable[[Outcome, Message, str], None]
    cancel_answered: Callable[[CancelAnswer], None]


class Goal(Protocol):
    """A goal that was sent."""

    def cancel(self) -> None:
        """Asks the server to cancel it; a server that does not know it yet may take no notice."""

    def is_canceling(self) -> bool:
        """Whether the server says that the goal is being canceled."""

    def is_gone(self) -> bool:
        """Whether the server that has the goal is gone; asked again and again."""


@dataclass(frozen=True)
class ComponentStatus:
    """A status: of which component, whether something is wrong, its state and what is wrong, and further values."""

    component: str
    warns: bool
    message: str
    values: Sequence[tuple[str, str]]


class Port(Protocol):
    """A ROS node, as far as a supervisory layer needs one: it publishes reports, logs, and calls services."""

    def now(self) -> float:
        """The node's time, in seconds."""

    def publish_report(self, name: str, text: str) -> None:
        """Publishes a text on `~/state`, `~/definition` or `~/blocked`; `name` is the last part."""

    def report_listeners(self, name: str) -> int:
        """How many subscriptions there are to one of these."""

    def publish_statuses(self, statuses: Sequence[ComponentStatus]) -> None:
        """Publishes statuses on `/diagnostics`."""

    def status_listeners(self) -> int:
        """How many subscriptions there are to it."""

    def info(self, text: str) -> None:
        """Logs a text."""

    def warn(self, text: str) -> None:
        """Logs a warning."""

    def error(self, text: str) -> None:
        """Logs an error."""

    def hear(self) -> None:
        """Handles what has arrived already: it is not to wait behind a time that is up."""

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        """Data with every field at its ROS default."""

    def unset(self, interface: rosgraph.Interface, section: Section, path: Sequence[str]) -> Message:
        """The object at a path in such data, as `create` makes it; a step `0` is an element of an array."""

    def is_served(self, client: Client) -> bool:
        """Whether there is a server."""

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: CallHandlers) -> None:
        """Calls a service; the handlers are not called before this returns."""


class ControllerPort(Port, Protocol):
    """A ROS node, as far as a controller needs one. Names of topics and servers are resolved as the node's are."""

    def stamp(self, message: Message, frame: str) -> None:
        """Gives the header of a message or a part of one, where it has one, the node's time and a frame."""

    def type_name(self, interface: rosgraph.Interface) -> str:
        """A type as this ROS writes it."""

    def wire_types(self, message: Message) -> Mapping[str, str]:
        """The types of the fields, in ROS's words: `float64`, `double`, `string`, `geometry_msgs/Point`."""

    def publish(self, publisher: rosgraph.Publisher, message: Message) -> None:
        """Sends a message."""

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> Goal:
        """Sends a goal; the handlers are not called before this returns."""

    def serving_nodes(self, client: Client) -> Sequence[tuple[str, str]]:
        """Return the nodes that serve the name of a service or action, each with its type.

        Where there is at most one server, of the right type, it may be left out.
        """

    def endpoints(self) -> Mapping[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        """The other publishers on the node's topics, and the subscriptions to what it publishes."""


@dataclass(frozen=True)
class Endpoint:
    """A publisher on a topic, or a subscription to it (`listens`), of another node.

    `node` is empty where its name is not known. `type` is as its ROS writes it; `incompatible` says why its quality of
    service keeps it and the node apart.
    """

    node: str
    type: str
    incompatible: str | None = None
    listens: bool = False
