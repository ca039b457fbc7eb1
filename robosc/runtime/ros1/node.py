"""A node of ROS 1 on rospy."""

from __future__ import annotations

import signal
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robosc.metamodel import rosgraph
from robosc.ros_types import Section
from robosc.runtime.core.agenda import Agenda
from robosc.runtime.core.port import CallHandlers, Endpoint, GoalHandlers
from robosc.runtime.core.settings import check
from robosc.runtime.core.starting import StartError, ending_signals, interface_class

#: Where Debian has the Python of ROS 1; appended, so that nothing of this Python's own is hidden.
_DEBIAN = "/usr/lib/python3/dist-packages"

if (Path(_DEBIAN) / "rospy").is_dir() and _DEBIAN not in sys.path:
    sys.path.append(_DEBIAN)
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
    from collections.abc import Mapping, Sequence

    from robosc.configuration import Configuration
    from robosc.runtime.core.controller import Controller
    from robosc.runtime.core.port import Acting, Goal, Message
    from robosc.runtime.core.settings import Parameter, Value

_HINT = (
    "on Debian: apt install python3-PACKAGE, its name with - for _; else build it with catkin and source devel/setup"
)
_DEPTH = 10
_LONGEST_WAIT = 0.1
_FAREWELL = 0.5
#: Nothing tells when a message has left the node.
_DELIVERY = 0.2


class Ros1Node:
    """A node named `name`, as far as the core needs ROS. Raises StartError for a type that is not there."""

    def __init__(
        self, name: str, graph: rosgraph.RosGraph, configuration: Configuration, arguments: Sequence[str]
    ) -> None:
        self._graph = graph
        del configuration  # quality of service is ROS 2's
        self._types = {each: self._type(each) for each in graph.interfaces}
        try:
            rospy.init_node(name, argv=["robosc", *arguments], disable_signals=True)
        except rospy.exceptions.ROSInitException as error:
            raise StartError(str(error), "start roscore, or name its ROS_MASTER_URI") from None
        self.simulated = bool(rospy.get_param("/use_sim_time", default=False))
        self.agenda = Agenda(rospy.get_time if self.simulated else time.monotonic, starts_late=self.simulated)
        if self.simulated:
            # rospy's own subscription came first: the time is the new one already.
            rospy.Subscriber("/clock", Clock, lambda _: self.agenda.poke(), queue_size=1)
        self._reports: dict[str, Any] = {}
        self._publishers: dict[rosgraph.Publisher, Any] = {}
        self._clients: dict[rosgraph.ServiceClient | rosgraph.ActionClient, Any] = {}
        self._master = Master(rospy.get_name())

    @staticmethod
    def _type(interface: rosgraph.Interface) -> Any:
        if interface.kind == rosgraph.InterfaceKind.action:
            return {
                suffix: interface_class(interface, suffix, _HINT) for suffix in ("Action", "Goal", "Result", "Feedback")
            }
        return interface_class(interface, "", _HINT)

    def parameters(self, declared: Sequence[Parameter]) -> dict[str, Value]:
        """The values of parameters. Raises StartError for one that does not fit."""
        values = {}
        for each in declared:
            try:
                values[each.name] = check(each, rospy.get_param("~" + each.name.replace(".", "/"), each.default))
            except ValueError as error:
                raise StartError(f"parameter {error}") from None
        return values

    def open_reports(self, names: Sequence[str]) -> None:
        """Makes what `tell` publishes on; the definition is kept for those who come later."""
        for name in names:
            latched = name == "definition"
            depth = 1 if latched else _DEPTH
            self._reports[name] = rospy.Publisher(f"~{name}", String, queue_size=depth, latch=latched)

    def is_served(self, client: rosgraph.ServiceClient | rosgraph.ActionClient) -> bool:
        if isinstance(client, rosgraph.ActionClient):
            return bool(self._clients[client].is_served())
        try:
            return bool(self._master.lookupService(rospy.resolve_name(client.identifier)))
        except (OSError, MasterException):
            return False

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: CallHandlers) -> None:
        def ask() -> None:
            try:
                answer = self._clients[client].call(request)
            except Exception as error:  # whatever rospy raises on this thread is a failed call
                handlers.failed(str(error))
            else:
                handlers.answered(answer)

        threading.Thread(target=ask, daemon=True).start()

    @property
    def full_name(self) -> str:
        return str(rospy.get_name())

    def now(self) -> float:
        return float(rospy.get_time())

    def tell(self, what: str, text: str) -> None:
        self._reports[what].publish(String(data=text))

    def listeners(self, what: str) -> int:
        return int(self._reports[what].get_num_connections())

    def info(self, text: str) -> None:
        rospy.loginfo("%s", text)

    def warn(self, text: str) -> None:
        rospy.logwarn("%s", text)

    def error(self, text: str) -> None:
        rospy.logerr("%s", text)

    # The node's life

    def spin(self, acting: Acting) -> None:
        """Lets somebody act until the user interrupts it; it stops before the node ends."""
        interrupted: list[int] = []

        def interrupt(number: int, _: object = None) -> None:
            interrupted.append(number)
            self.agenda.post(lambda: None)

        for number in ending_signals():
            signal.signal(number, interrupt)
        acting.start()
        while not interrupted and not rospy.is_shutdown():
            self._spin_once()
        acting.stop()
        until = time.monotonic() + _FAREWELL
        while acting.busy and time.monotonic() < until:
            self._spin_once()
        acting.close()
        time.sleep(_DELIVERY)
        self.close()

    def _spin_once(self) -> None:
        left = self.agenda.work()
        self.agenda.wait(_LONGEST_WAIT if left is None or (self.simulated and left) else min(left, _LONGEST_WAIT))

    def close(self) -> None:
        """Nothing more is sent or received."""
        rospy.signal_shutdown("the controller has ended")


class Ros1Port(Ros1Node):
    """The node of a controller."""

    def connect(self, controller: Controller) -> None:
        """Makes what the controller sends with, then what it listens to. Raises StartError where ROS refuses a name."""
        try:
            self._connect(controller)
        except (ValueError, rospy.exceptions.ROSException) as error:
            raise StartError(str(error)) from None

    def _connect(self, controller: Controller) -> None:
        for publisher in self._graph.publishers:
            kind = self._types[publisher.interface]
            self._publishers[publisher] = rospy.Publisher(publisher.topic, kind, queue_size=_DEPTH, tcp_nodelay=True)
        for service in self._graph.serviceClients:
            self._clients[service] = rospy.ServiceProxy(service.identifier, self._types[service.interface])
        if self._graph.actionClients:
            from robosc.runtime.ros1.actions import ActionConnection  # noqa: PLC0415  # needs python3-actionlib

            for action in self._graph.actionClients:
                self._clients[action] = ActionConnection(action.identifier, self._types[action.interface]["Action"])
        for subscription in self._graph.subscriptions:
            self._listen(subscription, controller)

    def _listen(self, subscription: rosgraph.Subscription, controller: Controller) -> None:
        def hear(message: Message) -> None:
            self.agenda.post(lambda: controller.receive(subscription, message), subscription.topic, _DEPTH)

        kind = self._types[subscription.interface]
        rospy.Subscriber(subscription.topic, kind, hear, queue_size=_DEPTH, tcp_nodelay=True)

    # What the core asks

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        kind = self._types[interface]
        if section is Section.GOAL:
            made = kind["Goal"]()
        elif section is Section.REQUEST:
            made = kind._request_class()  # noqa: SLF001  # there is no other way to it
        else:
            made = kind()
        _unit_quaternions(made)
        return made

    def stamp(self, message: Message, frame: str) -> None:
        header: Any = getattr(message, "header", None)
        if hasattr(header, "stamp"):
            header.stamp = rospy.Time.now()
            header.frame_id = frame

    def type_name(self, interface: rosgraph.Interface) -> str:
        return f"{interface.package}/{interface.type}"

    def wire_types(self, message: Message) -> Mapping[str, str]:
        return dict(zip(message.__slots__, message._slot_types, strict=True))  # noqa: SLF001  # as genpy has it

    def publish(self, publisher: rosgraph.Publisher, message: Message) -> None:
        self._publishers[publisher].publish(message)

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> Goal:
        sent: Goal = self._clients[client].send(goal, handlers)
        return sent

    def wiring(self) -> dict[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        elements: list[rosgraph.Subscription | rosgraph.Publisher] = [
            *self._graph.subscriptions,
            *self._graph.publishers,
        ]
        with suppress(OSError, MasterException):
            topics = dict(self._master.getSystemState()[0])
            types = dict(self._master.getTopicTypes())
            return {each: self._endpoints(rospy.resolve_name(each.topic), topics, types) for each in elements}
        return {}

    @staticmethod
    def _endpoints(topic: str, topics: Mapping[str, list[str]], types: Mapping[str, str]) -> list[Endpoint]:
        others = [each for each in topics.get(topic, ()) if each != rospy.get_name()]
        return [Endpoint(each, types.get(topic, "*")) for each in others]


def _unit_quaternions(message: Message) -> None:
    """Makes each quaternion in a message one of length 1."""
    if message._type == "geometry_msgs/Quaternion":  # noqa: SLF001
        message.w = 1.0
    for name in message.__slots__:
        part = getattr(message, name)
        if isinstance(part, genpy.Message):
            _unit_quaternions(part)
