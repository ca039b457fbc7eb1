"""Port of an audit: its clock is the time of the recording, and it sends nothing."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from robosc.base.ros_types import DefinitionError, Section
from robosc.base.ros_types.wire import Basic, NestedType, Sequence
from robosc.run.runtime.core.node_data import BLANK
from robosc.run.runtime.core.port import ControllerPort

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from collections.abc import Sequence as Several

    from robosc.base.ros_types import RosDistribution
    from robosc.base.ros_types.wire import WireType
    from robosc.model import rosgraph
    from robosc.run.runtime.core.port import Client, ComponentStatus, Endpoint, Goal, GoalHandlers, Message, Server


class _New(SimpleNamespace):
    """Data with the defaults of ROS."""


class RecordingPort(ControllerPort):
    """Port of a node that only judges. `types` are those of its ROS; `time` is in seconds."""

    def __init__(self, types: RosDistribution) -> None:
        self.time = 0.0
        self._types = types
        #: Types of the fields of a message that was read.
        self.recorded_types: Callable[[Message], Mapping[str, str]] = lambda _: {}

    def now(self) -> float:
        """Return the time of the recording in seconds."""
        return self.time

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        """Return data with every field at its ROS default; blank data for an unknown type."""
        return self._new(interface.package, interface.type, section)

    def _new(self, package: str, name: str, section: Section) -> Message:
        try:
            fields = self._types.fields(package, name, section)
        except DefinitionError:
            fields = None
        if fields is None:
            return BLANK
        return _New(**{field: self._initial(kind) for field, kind in fields.items()})

    def _initial(self, kind: WireType) -> Any:
        match kind:
            case Basic():
                return kind.initial
            case NestedType():
                return self._new(kind.package, kind.name, Section.MESSAGE)
        assert isinstance(kind, Sequence)
        return [self._initial(kind.at(index)) for index in range(kind.initial_length)]

    def unset(self, interface: rosgraph.Interface, section: Section, path: Several[str]) -> Message:
        """Return the object at a path in new data of a type; a step `0` is an element of an array."""
        if not path:
            return self.create(interface, section)
        known = self._types.type_at(interface.package, interface.type, section, path)
        return BLANK if known is None else self._initial(known[0])

    def wire_types(self, message: Message) -> Mapping[str, str]:
        """Return the types of the fields of recorded data."""
        return self.recorded_types(message)

    def type_name(self, interface: rosgraph.Interface) -> str:
        """Return the name of a type."""
        return f"{interface.package}/{interface.type}"

    def stamp(self, message: Message, frame: str) -> None:
        """Leave the header as it is: nothing is sent."""

    def publish(self, publisher: rosgraph.Publisher, message: Message) -> None:
        """Send nothing."""

    def publish_report(self, name: str, text: str) -> None:
        """Publish nothing."""

    def report_listeners(self, name: str) -> int:  # noqa: ARG002
        """Return that nobody listens."""
        return 0

    def publish_statuses(self, statuses: Several[ComponentStatus]) -> None:
        """Publish nothing."""

    def status_listeners(self) -> int:
        """Return that nobody listens."""
        return 0

    def info(self, text: str) -> None:
        """Log nothing: the findings are the result."""

    warn = error = info

    def hear(self) -> None:
        """Do nothing: messages come in the order of the recording."""

    def is_served(self, client: Client) -> bool:  # noqa: ARG002
        """Return that no call is possible."""
        return False

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: Any) -> None:
        """Call nothing."""

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> Goal:
        """Send nothing."""
        raise NotImplementedError

    def serving_nodes(self, element: Client | Server) -> Several[tuple[str, str]]:  # noqa: ARG002
        """Return no nodes."""
        return ()

    def calling_nodes(self, client: Client) -> Several[str]:  # noqa: ARG002
        """Return no nodes."""
        return ()

    def endpoints(self) -> Mapping[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        """Return no endpoints."""
        return {}
