"""A node of ROS 1 on rospy."""

from __future__ import annotations

import sys
import threading
import time
from concurrent.futures import Future
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robosc.metamodel import rosgraph
from robosc.ros_types import Section
from robosc.runtime.core.event_loop import EventLoop
from robosc.runtime.core.node import DIAGNOSTICS, FAREWELL, LONGEST_WAIT, Node, StartError
from robosc.runtime.core.port import CallHandlers, Endpoint, GoalHandlers
from robosc.runtime.ros1 import DEBIAN
from robosc.semantics.communication import QUEUE_DEPTH
from robosc.semantics.naming import below_layer

if (Path(DEBIAN) / "rospy").is_dir() and DEBIAN not in sys.path:
    sys.path.append(DEBIAN)
try:
    import genpy
    import rospy
    from rosgraph import Master, MasterException
    from rosgraph_msgs.msg import Clock
    from std_msgs.msg import String
except ImportError as error:
    raise StartError(
        f"ROS 1 is not there for this Python: {error}",
        "on Debian 12: apt install python3-rospy python3-actionlib and the python3-...-msgs of the model;"
        " elsewhere source the setup of the ROS installation",
    ) from error

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.configuration.parameters import Parameter
    from robosc.runtime.core.layer import Layer
    from robosc.runtime.core.port import Client, Goal, Message
    from robosc.runtime.core.proxies import ActionProxy, Answer

#: Nothing tells when a message has left the node.
_DELIVERY = 0.2


class Ros1Node(Node):
    """A node of ROS 1 named `name`; `arguments` are those of ROS, such as remappings."""

    type_hint = (
        "on Debian: apt install python3-PACKAGE, its name with - for _; else build it with catkin and source"
        " devel/setup"
    )
    refusals = (ValueError, rospy.exceptions.ROSException)
    longest_end = FAREWELL

    def __init__(self, name: str, graph: rosgraph.RosGraph, arguments: Sequence[str]) -> None:
        super().__init__(graph)
        start(name, arguments)
        self.simulated = bool(rospy.get_param("/use_sim_time", default=False))
        clock = rospy.get_time if self.simulated else time.monotonic
        self.event_loop = EventLoop(clock, starts_late=self.simulated)
        if self.simulated:
            # rospy's own subscription came first: the time is the new one already.
            rospy.Subscriber("/clock", Clock, lambda _: self.event_loop.notify_time(), queue_size=1)
        self._master = Master(rospy.get_name())

    def _load_type(self, interface: rosgraph.Interface, suffix: str = "") -> Any:
        if interface.kind == rosgraph.InterfaceKind.action and not suffix:
            return {part: self._load_type(interface, part) for part in ("Action", "Goal", "Result", "Feedback")}
        return super()._load_type(interface, suffix)

    # The node's life

    @property
    def full_name(self) -> str:
        return str(rospy.get_name())

    def open_reports(self, names: Sequence[str]) -> None:
        for name in names:
            kept = name == "definition"
            self._reports[name] = rospy.Publisher(f"~{name}", String, queue_size=1 if kept else QUEUE_DEPTH, latch=kept)

    def _diagnostics_publisher(self, kind: Any) -> Any:
        return rospy.Publisher(DIAGNOSTICS, kind, queue_size=QUEUE_DEPTH)

    def close(self) -> None:
        rospy.signal_shutdown("the controller has ended")

    def inside(self, name: str) -> str:
        return f"~{below_layer(name)}"

    def _parameter(self, parameter: Parameter) -> object:
        value: object = rospy.get_param("~" + parameter.name.replace(".", "/"), parameter.default)
        return value

    def _is_up(self) -> bool:
        return not rospy.is_shutdown()

    def _spin_once(self) -> None:
        left = self.event_loop.run_pending()
        self.event_loop.wait(LONGEST_WAIT if left is None or (self.simulated and left) else min(left, LONGEST_WAIT))

    def _take_leave(self) -> None:
        time.sleep(_DELIVERY)

    # Reports

    def now(self) -> float:
        return float(rospy.get_time())

    def publish_report(self, name: str, text: str) -> None:
        self._reports[name].publish(String(data=text))

    def report_listeners(self, name: str) -> int:
        return int(self._reports[name].get_num_connections())

    def info(self, text: str) -> None:
        rospy.loginfo("%s", text)

    def warn(self, text: str) -> None:
        rospy.logwarn("%s", text)

    def error(self, text: str) -> None:
        rospy.logerr("%s", text)

    # Topics

    def _publisher(self, publisher: rosgraph.Publisher) -> Any:
        return self.advertise(publisher.topic, self._types[publisher.interface])

    @staticmethod
    def advertise(name: str, kind: Any, *, latch: bool = False) -> Any:
        """A publisher on a topic."""
        return rospy.Publisher(name, kind, queue_size=QUEUE_DEPTH, latch=latch, tcp_nodelay=True)

    def _subscribe(self, subscription: rosgraph.Subscription, receive: Callable[[Message], None]) -> None:
        self.subscribe(subscription.topic, self._types[subscription.interface], receive)

    def subscribe(
        self, name: str, kind: Any, receive: Callable[[Message], None], depth: int | None = QUEUE_DEPTH
    ) -> Any:
        """Calls `receive` in the event loop's thread; of more than `depth` messages that wait, the oldest gives way."""

        def post(message: Message) -> None:
            self.event_loop.post(lambda: receive(message), None if depth is None else name, depth or 0)

        return rospy.Subscriber(name, kind, post, queue_size=depth, tcp_nodelay=True)

    def _relay(
        self,
        element: rosgraph.Subscription | rosgraph.Publisher,
        source: str,
        target: str,
        passes: Callable[[Message], bool],
    ) -> _Relay:
        relay = _Relay(self, target, self._types[element.interface], passes)
        self.subscribe(source, self._types[element.interface], relay.forward)
        return relay

    def type_name(self, interface: rosgraph.Interface) -> str:
        return f"{interface.package}/{interface.type}"

    def serving_nodes(self, client: Client) -> list[tuple[str, str]]:  # noqa: ARG002  # nobody looks at them
        return []

    def endpoints(self) -> dict[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        with suppress(OSError, MasterException):
            publishers = dict(self._master.getSystemState()[0])
            types = dict(self._master.getTopicTypes())
            return {
                element: [
                    Endpoint(node, types.get(name, "*"))
                    for name in [rospy.resolve_name(element.topic)]
                    for node in publishers.get(name, ())
                    if node != rospy.get_name()
                ]
                for element in self._topics
            }
        return {}

    # Data

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        kind = self._types[interface]
        match section:
            case Section.MESSAGE:
                made = kind()
            case Section.REQUEST:
                made = kind._request_class()  # noqa: SLF001  # there is no other way to it
            case Section.RESPONSE:
                made = kind._response_class()  # noqa: SLF001
            case _:
                made = kind[section.name.capitalize()]()
        _unit_quaternions(made)
        return made

    def wire_types(self, message: Message) -> Mapping[str, str]:
        if isinstance(message, genpy.TVal):
            return {}  # a time tells no types
        return dict(zip(message.__slots__, message._slot_types, strict=True))  # noqa: SLF001  # as genpy has it

    def _stamp_now(self) -> Any:
        return rospy.Time.now()

    # Services and actions

    def is_served(self, client: Client) -> bool:
        if isinstance(client, rosgraph.ActionClient):
            return bool(self._clients[client].is_served())
        try:
            return bool(self._master.lookupService(rospy.resolve_name(client.identifier)))
        except (OSError, MasterException):
            return False

    def _service_client(self, service: rosgraph.ServiceClient) -> Any:
        return rospy.ServiceProxy(service.identifier, self._types[service.interface])

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: CallHandlers) -> None:
        def ask() -> None:
            try:
                answer = self._clients[client].call(request)
            except Exception as error:  # whatever rospy raises on this thread is a failed call
                handlers.failed(str(error))
            else:
                handlers.answered(answer)

        threading.Thread(target=ask, daemon=True).start()

    def _serve(self, kind: Any, name: str, called: Callable[[Message, Answer], None]) -> None:
        def serve(request: Message) -> Message:  # on a thread of rospy's, which waits
            answer = _Answer()
            self.event_loop.post(lambda: called(request, answer))
            return answer.response.result()

        rospy.Service(name, kind, serve)

    def _action_client(self, action: rosgraph.ActionClient) -> Any:
        from robosc.runtime.ros1.action_client import ActionClient  # noqa: PLC0415  # needs python3-actionlib

        return ActionClient(action.identifier, self._types[action.interface]["Action"])

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> Goal:
        sent: Goal = self._clients[client].send(goal, handlers)
        return sent

    def _proxy(self, action: rosgraph.ActionClient, layer: Layer, timeout: float) -> ActionProxy[Any]:
        from robosc.runtime.ros1.action_proxy import Ros1ActionProxy  # noqa: PLC0415  # needs python3-actionlib-msgs

        return Ros1ActionProxy(self, self._types[action.interface]["Action"], action, layer, timeout)


def start(name: str, arguments: Sequence[str], *, anonymous: bool = False) -> None:
    """Makes this process the node of a name, or of one like it; `arguments` are those of ROS. Raises StartError."""
    try:
        rospy.init_node(name, argv=["robosc", *arguments], anonymous=anonymous, disable_signals=True)
    except rospy.exceptions.ROSInitException as error:
        raise StartError(str(error), "start roscore, or name its ROS_MASTER_URI") from None


class _Relay:
    """Sends messages on to a topic where `passes` says so; latched from the first latched one on."""

    def __init__(self, node: Ros1Node, topic: str, kind: Any, passes: Callable[[Message], bool]) -> None:
        self._node = node
        self._topic = topic
        self._kind = kind
        self._passes = passes
        self._latched = False
        # Advertised before the first message, so that those who listen are connected when it comes.
        self._publisher = node.advertise(topic, kind)

    def forward(self, message: Message) -> None:
        """Sends a message on, if it passes."""
        if not self._passes(message):
            return
        if not self._latched and message._connection_header.get("latching") == "1":  # noqa: SLF001  # as genpy has it
            self._latched = True
            self._publisher = self._node.advertise(self._topic, self._kind, latch=True)
        self.publish(message)

    def publish(self, message: Message) -> None:
        """Sends a message."""
        self._publisher.publish(message)


class _Answer:
    """The answer to a call of a service of the layer's; its end without a response is the service's error."""

    def __init__(self) -> None:
        self.response: Future[Message] = Future()

    def give(self, response: Message) -> None:
        self.response.set_result(response)

    def fail(self, why: str) -> None:
        self.response.set_exception(rospy.ServiceException(why))


def _unit_quaternions(message: Message) -> None:
    """Makes each quaternion in a message one of length 1."""
    if message._type == "geometry_msgs/Quaternion":  # noqa: SLF001
        message.w = 1.0
    for name in message.__slots__:
        part = getattr(message, name)
        if isinstance(part, genpy.Message):
            _unit_quaternions(part)
