"""A node of ROS 2 on rclpy."""

from __future__ import annotations

import signal
import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from robosc.metamodel import rosgraph
from robosc.ros_types import Section
from robosc.runtime.core.agenda import Agenda
from robosc.runtime.core.port import CallHandlers, Endpoint, GoalHandlers, Outcome
from robosc.runtime.core.settings import check
from robosc.runtime.core.starting import StartError, ending_signals, interface_class

try:
    import rclpy
    import rclpy.action
    import rclpy.action.client
    import rclpy.exceptions
    from action_msgs.msg import GoalInfo, GoalStatus
    from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.qos import (
        DurabilityPolicy,
        QoSCompatibility,
        QoSProfile,
        ReliabilityPolicy,
        qos_check_compatible,
        qos_profile_sensor_data,
        qos_profile_services_default,
    )
    from rclpy.qos_overriding_options import QoSOverridingOptions
    from rclpy.signals import SignalHandlerOptions
    from rclpy.type_support import NoTypeSupportImportedException, check_for_type_support
    from std_msgs.msg import String

    try:
        from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
    except ImportError:  # before Iron
        from rclpy.qos_event import PublisherEventCallbacks, SubscriptionEventCallbacks
except ImportError as error:
    raise StartError(
        f"ROS 2 is not there for this Python: {error}",
        "pip install 'robosc[ros2]' brings it; or start robosc with the Python of a ROS 2 installation, with its setup",
    ) from error

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.configuration import Configuration
    from robosc.runtime.core.controller import Controller
    from robosc.runtime.core.port import Acting, Goal, Message
    from robosc.runtime.core.settings import Parameter, Value

_HINT = (
    "build the package with colcon and source its install/setup, with this same Python; or, without colcon, build its"
    " modules with `python -m robosc.runtime.ros2.interfaces OUT PACKAGE` and put OUT on PYTHONPATH"
)
_DEPTH = 10
_LONGEST_WAIT = 0.1
_FAREWELL = 0.5
_OUTCOMES = {GoalStatus.STATUS_SUCCEEDED: Outcome.SUCCEEDED, GoalStatus.STATUS_CANCELED: Outcome.CANCELLED}


class Ros2Node:
    """A node named `name`, as far as the core needs ROS. Raises StartError for a type that is not there."""

    def __init__(
        self, name: str, graph: rosgraph.RosGraph, configuration: Configuration, arguments: Sequence[str]
    ) -> None:
        self._graph = graph
        self._configuration = configuration
        self._types = {each: self._type(each) for each in graph.interfaces}
        try:
            rclpy.init(args=["robosc", *arguments], signal_handler_options=SignalHandlerOptions.NO)
            self.node = rclpy.create_node(name)
        except (RuntimeError, rclpy.exceptions.ParameterException) as error:
            # Of an argument, a file or a folder, the log's too; where in rcl it was found helps nobody.
            raise StartError(f"ROS 2 does not start: {str(error).partition(', at /')[0]}") from None
        self.executor = _executor()
        self.executor.add_node(self.node)
        self._clock = self.node.get_clock()
        self.simulated = bool(self.node.get_parameter("use_sim_time").value)
        self.agenda = Agenda(self._simulated_time if self.simulated else time.monotonic, starts_late=self.simulated)
        self._reports: dict[str, Any] = {}
        self._publishers: dict[rosgraph.Publisher, Any] = {}
        self._clients: dict[rosgraph.ServiceClient | rosgraph.ActionClient, Any] = {}
        self._pending: dict[rosgraph.ServiceClient, Any] = {}

    @staticmethod
    def _type(interface: rosgraph.Interface) -> Any:
        found = interface_class(interface, "", _HINT)
        try:
            check_for_type_support(found)
        except (NoTypeSupportImportedException, ImportError) as error:
            what = f"{interface.package}/{interface.type}"
            raise StartError(f"{what} is there, but not built for this Python: {error}", _HINT) from None
        return found

    def _simulated_time(self) -> float:
        return float(self._clock.now().nanoseconds) / 1e9

    def parameters(self, declared: Sequence[Parameter]) -> dict[str, Value]:
        """Declares parameters, and gives their values. Raises StartError for one that does not fit."""
        values = {}
        for each in declared:
            descriptor = ParameterDescriptor(description=each.meaning, read_only=True)
            if each.bounds is not None:
                low, high = each.bounds
                descriptor.integer_range = [IntegerRange(from_value=low, to_value=high, step=1)]
            try:
                values[each.name] = check(each, self.node.declare_parameter(each.name, each.default, descriptor).value)
            except (ValueError, rclpy.exceptions.ParameterException) as error:
                raise StartError(f"parameter {each.name}: {error}") from None
        return values

    def open_reports(self, names: Sequence[str]) -> None:
        """Makes what `tell` publishes on; the definition is kept for those who come later."""
        for name in names:
            latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            quality = latched if name == "definition" else QoSProfile(depth=_DEPTH)
            self._reports[name] = self.node.create_publisher(String, f"~/{name}", quality)

    def feedback_quality(self, action: rosgraph.ActionClient) -> Any:
        """How the robot's feedback is received."""
        return self._quality(action.identifier, QoSProfile(depth=_DEPTH))

    def _service_client(self, service: rosgraph.ServiceClient) -> Any:
        quality = self._quality(service.identifier, qos_profile_services_default)
        return self.node.create_client(self._types[service.interface], service.identifier, qos_profile=quality)

    def _quality(self, name: str, usual: Any) -> Any:
        """What the configuration says of a topic, service or action goes first."""
        chosen = self._configuration.qos.get(name.removeprefix("/"))
        if chosen is None:
            return usual
        made = QoSProfile(depth=chosen.depth or usual.depth, reliability=usual.reliability, durability=usual.durability)
        if chosen.reliability:
            made.reliability = ReliabilityPolicy[chosen.reliability.upper()]
        if chosen.durability:
            made.durability = DurabilityPolicy[chosen.durability.upper()]
        return made

    def is_served(self, client: rosgraph.ServiceClient | rosgraph.ActionClient) -> bool:
        connected = self._clients[client]
        action = isinstance(client, rosgraph.ActionClient)
        return bool(connected.server_is_ready() if action else connected.service_is_ready())

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: CallHandlers) -> None:
        connected = self._clients[client]
        if client in self._pending:
            connected.remove_pending_request(self._pending[client])
        self._pending[client] = connected.call_async(request)
        self._pending[client].add_done_callback(lambda future: _answer(future, handlers.answered, handlers.failed))

    @property
    def full_name(self) -> str:
        return str(self.node.get_fully_qualified_name())

    def now(self) -> float:
        return self._simulated_time()

    def tell(self, what: str, text: str) -> None:
        self._reports[what].publish(String(data=text))

    def listeners(self, what: str) -> int:
        return int(self._reports[what].get_subscription_count())

    def info(self, text: str) -> None:
        self.node.get_logger().info(text)

    def warn(self, text: str) -> None:
        self.node.get_logger().warning(text)

    def error(self, text: str) -> None:
        self.node.get_logger().error(text)

    # The node's life

    def spin(self, acting: Acting) -> None:
        """Lets somebody act until the user interrupts it; it stops before the node ends."""
        interrupted: list[int] = []
        for number in ending_signals():
            signal.signal(number, lambda number, _: interrupted.append(number))
        acting.start()
        while not interrupted and rclpy.ok():
            self._spin_once()
        acting.stop()
        while acting.busy:
            self._spin_once()
        acting.close()
        self._take_leave()
        self.close()

    def _spin_once(self) -> None:
        left = self.agenda.work()
        wait = _LONGEST_WAIT if left is None or self.simulated else min(left, _LONGEST_WAIT)
        self.executor.spin_once(timeout_sec=wait)

    def _take_leave(self) -> None:
        """Lets what was sent last arrive, as far as that is soon."""
        until = time.monotonic() + _FAREWELL
        for each in self._publishers.values():
            each.wait_for_all_acked(rclpy.duration.Duration(seconds=max(0.0, until - time.monotonic())))

    def close(self) -> None:
        """Nothing more is sent or received."""
        self.executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown()


class Ros2Port(Ros2Node):
    """The node of a controller."""

    def __init__(
        self, name: str, graph: rosgraph.RosGraph, configuration: Configuration, arguments: Sequence[str]
    ) -> None:
        super().__init__(name, graph, configuration, arguments)
        self._qualities: dict[rosgraph.Subscription | rosgraph.Publisher, Any] = {}

    def connect(self, controller: Controller) -> None:
        """Makes what the controller sends with, then what it listens to. Raises StartError where ROS refuses a name."""
        try:
            self._connect(controller)
        except (
            ValueError,
            rclpy.exceptions.InvalidTopicNameException,
            rclpy.exceptions.InvalidServiceNameException,
        ) as error:
            raise StartError(str(error)) from None

    def _connect(self, controller: Controller) -> None:
        overriding = QoSOverridingOptions.with_default_policies()
        for publisher in self._graph.publishers:
            self._qualities[publisher] = self._quality(publisher.topic, QoSProfile(depth=_DEPTH))
            self._publishers[publisher] = self.node.create_publisher(
                self._types[publisher.interface],
                publisher.topic,
                self._qualities[publisher],
                qos_overriding_options=overriding,
                # The wiring says what does not fit.
                event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
            )
        for service in self._graph.serviceClients:
            self._clients[service] = self._service_client(service)
        for action in self._graph.actionClients:
            self._clients[action] = rclpy.action.ActionClient(
                self.node,
                self._types[action.interface],
                action.identifier,
                feedback_sub_qos_profile=self.feedback_quality(action),
            )
        for subscription in self._graph.subscriptions:
            self._listen(subscription, controller, overriding)

    def _listen(self, subscription: rosgraph.Subscription, controller: Controller, overriding: Any) -> None:
        sensor = subscription.interface.package == "sensor_msgs"
        usual = qos_profile_sensor_data if sensor else QoSProfile(depth=_DEPTH)
        quality = self._quality(subscription.topic, usual)
        self._qualities[subscription] = quality
        self.node.create_subscription(
            self._types[subscription.interface],
            subscription.topic,
            lambda message: controller.receive(subscription, message),
            quality,
            qos_overriding_options=overriding,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
        )

    # What the core asks

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        kind = self._types[interface]
        made = {Section.REQUEST: "Request", Section.GOAL: "Goal"}.get(section)
        return (getattr(kind, made) if made else kind)()

    def stamp(self, message: Message, frame: str) -> None:
        header: Any = getattr(message, "header", None)
        if hasattr(header, "stamp"):
            header.stamp = self._clock.now().to_msg()
            header.frame_id = frame

    def type_name(self, interface: rosgraph.Interface) -> str:
        return f"{interface.package}/msg/{interface.type}"

    def wire_types(self, message: Message) -> Mapping[str, str]:
        types: Mapping[str, str] = message.get_fields_and_field_types()
        return types

    def publish(self, publisher: rosgraph.Publisher, message: Message) -> None:
        self._publishers[publisher].publish(message)

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> Goal:
        return _Goal(self._clients[client], goal, handlers)

    def wiring(self) -> dict[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        elements: list[rosgraph.Subscription | rosgraph.Publisher] = [
            *self._graph.subscriptions,
            *self._graph.publishers,
        ]
        return {each: self._endpoints(each) for each in elements}

    def _endpoints(self, element: rosgraph.Subscription | rosgraph.Publisher) -> list[Endpoint]:
        myself = _full_name(self.node.get_namespace(), self.node.get_name())
        publishers = self.node.get_publishers_info_by_topic(element.topic)
        found = [self._endpoint(each, each.qos_profile, self._qualities[element]) for each in publishers]
        if isinstance(element, rosgraph.Publisher):
            # What the graph says of the node itself: what it asked for leaves deadlines and leases open.
            own = [each.qos_profile for each in publishers if _full_name(each.node_namespace, each.node_name) == myself]
            found += [
                replace(self._endpoint(each, own[0], each.qos_profile), listens=True)
                for each in self.node.get_subscriptions_info_by_topic(element.topic)
                if own
            ]
        return [each for each in found if each.node != myself and "UNKNOWN" not in each.node]

    @staticmethod
    def _endpoint(other: Any, offered: Any, asked: Any) -> Endpoint:
        compatibility, reason = qos_check_compatible(offered, asked)
        fault = reason.strip(";: ") if compatibility == QoSCompatibility.ERROR else None
        return Endpoint(_full_name(other.node_namespace, other.node_name), other.topic_type, fault)


def _executor() -> Any:
    """What waits for ROS: by events where rclpy can, which takes a fiftieth of the time for a message."""
    try:
        from rclpy.experimental import EventsExecutor  # noqa: PLC0415  # not in every rclpy
    except ImportError:
        return SingleThreadedExecutor()
    return EventsExecutor()


class _Goal:
    """A goal on its way through an action server."""

    def __init__(self, client: Any, goal: Message, handlers: GoalHandlers) -> None:
        self._handlers = handlers
        identifier = GoalInfo().goal_id
        identifier.uuid = list(uuid4().bytes)
        self._handle = rclpy.action.client.ClientGoalHandle(client, identifier, None)
        sent = client.send_goal_async(goal, lambda message: handlers.feedback(message.feedback), identifier)
        sent.add_done_callback(lambda future: _answer(future, self._decided, self._failed))

    def cancel(self) -> None:
        answer = self._handle.cancel_goal_async()
        answer.add_done_callback(lambda future: _answer(future, self._cancelling, lambda _: self._handlers.refused()))

    def _decided(self, handle: Any) -> None:
        if not handle.accepted:
            self._handlers.rejected()
            return
        self._handle = handle
        self._handlers.accepted()
        handle.get_result_async().add_done_callback(lambda future: _answer(future, self._ended, self._failed))

    def _ended(self, answer: Any) -> None:
        self._handlers.ended(_OUTCOMES.get(answer.status, Outcome.ABORTED), answer.result, "")

    def _failed(self, why: str) -> None:
        self._handlers.ended(Outcome.ABORTED, None, why)

    def _cancelling(self, answer: Any) -> None:
        if not answer.goals_canceling:
            self._handlers.refused()


def _answer(future: Any, answered: Callable[[Any], None], failed: Callable[[str], None]) -> None:
    if future.cancelled():
        return
    if future.exception() is not None:
        failed(str(future.exception()))
    elif future.result() is not None:
        answered(future.result())


def _full_name(namespace: str, name: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"
