"""What the core asks of the middleware."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from robosc.metamodel import rosgraph
    from robosc.ros_types import Section

#: Data of ROS: an object with fields as attributes; arrays can be indexed and have a length.
Message: TypeAlias = Any


class Outcome(StrEnum):
    """How a goal has ended."""

    SUCCEEDED = "succeeded"
    CANCELLED = "cancelled"
    ABORTED = "aborted"


@dataclass(frozen=True)
class CallHandlers:
    """What a call comes to: one of them is called, from any thread."""

    answered: Callable[[Message], None]
    failed: Callable[[str], None]


@dataclass(frozen=True)
class GoalHandlers:
    """What becomes of a goal, called from any thread. `refused`: the server does not cancel it."""

    accepted: Callable[[], None]
    rejected: Callable[[], None]
    feedback: Callable[[Message], None]
    ended: Callable[[Outcome, Message, str], None]
    refused: Callable[[], None]


class Goal(Protocol):
    """A goal that was sent."""

    def cancel(self) -> None:
        """Asks the server to cancel it; a server that does not know it yet may take no notice (ROS 2)."""


class Acting(Protocol):
    """What a node does: a controller, a layer."""

    @property
    def busy(self) -> bool:
        """Whether something is under way that the node's end should wait for."""

    def start(self) -> None:
        """Begins."""

    def stop(self) -> None:
        """Ends, while the node can still send."""

    def close(self) -> None:
        """Lets go of its files."""


class Reporting(Protocol):
    """A node of some ROS, as far as it tells something about itself."""

    def now(self) -> float:
        """The node's time, in seconds."""

    def tell(self, what: str, text: str) -> None:
        """Publishes a text on `~/state`, `~/definition` or `~/blocked`."""

    def listeners(self, what: str) -> int:
        """How many listen to one of these."""

    def info(self, text: str) -> None:
        """Tells the user."""

    def warn(self, text: str) -> None:
        """Warns the user."""

    def error(self, text: str) -> None:
        """Tells the user of a fault."""


class Calling(Protocol):
    """A node of some ROS, as far as it calls services and finds servers."""

    def is_served(self, client: rosgraph.ServiceClient | rosgraph.ActionClient) -> bool:
        """Whether there is a server."""

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: CallHandlers) -> None:
        """Calls a service; the handlers are not called from inside."""


class Port(Reporting, Calling, Protocol):
    """A node of some ROS. Elements of the graph name what is meant; their names are resolved as the node's are."""

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        """Data with every field at its ROS default; a ROS 1 quaternion is one of length 1."""

    def stamp(self, message: Message, frame: str) -> None:
        """Gives the header of a message or a part of one, where it has one, the node's time and a frame."""

    def type_name(self, interface: rosgraph.Interface) -> str:
        """A type as this ROS writes it."""

    def wire_types(self, message: Message) -> Mapping[str, str]:
        """The types of the fields, in ROS's words: `float64`, `double`, `string`, `geometry_msgs/Point`."""

    def publish(self, publisher: rosgraph.Publisher, message: Message) -> None:
        """Sends a message."""

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> Goal:
        """Sends a goal; the handlers are not called from inside."""

    def wiring(self) -> Mapping[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        """Who else publishes on the node's topics; in ROS 2 who listens to what it publishes, too."""


@dataclass(frozen=True)
class Endpoint:
    """Who publishes on a topic, or listens: its node, its type as its ROS writes it, what keeps it and us apart."""

    node: str
    type: str
    incompatible: str | None = None
    listens: bool = False
