"""Node of ROS 2 on rclpy."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from robosc.base.ros_types import Section
from robosc.base.ros_types.wire import FOLDERS
from robosc.language.configuration import quality
from robosc.language.configuration.names import absolute_names
from robosc.language.configuration.quality import Profile
from robosc.model import rosgraph
from robosc.model.semantics.communication import QUEUE_DEPTH
from robosc.model.semantics.naming import below_layer
from robosc.run.runtime.core.event_loop import EventLoop
from robosc.run.runtime.core.message_queues import MessageQueue, MessageQueues
from robosc.run.runtime.core.node import DIAGNOSTICS, FAREWELL, LONGEST_WAIT, RunningNode, StartError
from robosc.run.runtime.core.port import CallHandlers, Endpoint, GoalHandlers
from robosc.run.runtime.core.settings import check

try:
    import rclpy
    import rclpy.action
    import rclpy.exceptions
    from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult
    from rclpy.clock import Clock, ClockType
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import NodeNameNonExistentError
    from rclpy.qos import (
        DurabilityPolicy,
        QoSCompatibility,
        QoSPolicyKind,
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
        f"this Python has no ROS 2: {error}",
        "run pip install -e '.[ros2]' in robosc's repository, or start robosc with the Python of a ROS 2"
        " installation after its setup",
    ) from error

from robosc.run.runtime.ros2.actions import LateAnswer, Ros2ActionProxy, SentGoal, settle

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.language.configuration import Configuration
    from robosc.language.configuration.parameters import Parameter
    from robosc.language.configuration.quality import Quality
    from robosc.run.runtime.core.event_handler import EventHandler
    from robosc.run.runtime.core.layer import Layer
    from robosc.run.runtime.core.port import Client, Goal, Message, Server
    from robosc.run.runtime.core.proxies import ActionProxy
    from robosc.run.runtime.core.servers import ActionServer
    from robosc.run.runtime.ros2.servers import Ros2ActionServer

_PROFILES = {
    Profile.QUEUE: QoSProfile(depth=QUEUE_DEPTH),
    Profile.SENSOR_DATA: qos_profile_sensor_data,
    Profile.SERVICES: qos_profile_services_default,
}
#: QoS policies that parameters may set of a subscription that receives kept messages.
_KEPT_POLICIES = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH)
#: Service of an action that takes its goals, below the action's name.
_SENDING = "/_action/send_goal"
#: Requests of a service that the middleware keeps, so that a burst arrives whole.
RECEIVED_REQUESTS = 100
#: Seconds between two looks at the publishers of topics.
_LOOK = 0.05


class Ros2Node(RunningNode):
    """Node of ROS 2 named `name`; `arguments` are those of ROS, such as `--ros-args`."""

    type_hint = (
        "build the package with colcon and source its install/setup, with this same Python; or, without colcon, build"
        " its modules with `robosc interfaces build FOLDER -o OUT` and put OUT on PYTHONPATH"
    )
    refusals = (
        ValueError,
        rclpy.exceptions.InvalidServiceNameException,
        rclpy.exceptions.InvalidTopicNameException,
        rclpy.exceptions.ParameterException,
    )

    def __init__(
        self, name: str, graph: rosgraph.RosGraph, configuration: Configuration, arguments: Sequence[str]
    ) -> None:
        super().__init__(graph)
        self._configuration = configuration
        self.node = start(name, arguments)
        self._executor = executor()
        self._executor.add_node(self.node)
        post = None if isinstance(self._executor, SingleThreadedExecutor) else self._executor.create_task
        self._queues = MessageQueues(lambda wait: self._executor.spin_once(timeout_sec=wait), post)
        self._clock = self.node.get_clock()
        self.simulated = bool(self.node.get_parameter("use_sim_time").value)
        self.event_loop = EventLoop(self.now if self.simulated else time.monotonic, starts_late=self.simulated)
        self._pending: dict[rosgraph.ServiceClient, Any] = {}
        self._served: list[Ros2ActionServer] = []
        self._qualities: dict[rosgraph.Subscription | rosgraph.Publisher, Any] = {}
        self._durabilities = _Durabilities(self.node)
        #: Types by the names of services since the last look at the topics, None if unknown.
        self._services: Mapping[str, Sequence[str]] | None = None

    def _load_type(self, interface: rosgraph.Interface) -> Any:
        message_type = super()._load_type(interface)
        try:
            check_for_type_support(message_type)
        except (NoTypeSupportImportedException, ImportError) as error:
            what = f"{interface.package}/{interface.type}"
            raise StartError(f"{what} is not built for this Python: {error}", self.type_hint) from None
        return message_type

    # The node's life

    @property
    def full_name(self) -> str:
        return str(self.node.get_fully_qualified_name())

    def _absolute_names(self) -> list[tuple[str, str]]:
        topics, services, actions = absolute_names(self._graph)
        resolved = [(topic, self.node.resolve_topic_name(topic)) for topic in topics]
        resolved += [(service, self.node.resolve_service_name(service)) for service in services]
        return resolved + [(action, self.node.resolve_service_name(f"{action}{_SENDING}")) for action in actions]

    def open_reports(self, names: Sequence[str]) -> None:
        for name in names:
            latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            qos = latched if name == "definition" else QoSProfile(depth=QUEUE_DEPTH)
            self._reports[name] = self.node.create_publisher(String, f"~/{name}", qos)

    def _diagnostics_publisher(self, kind: Any) -> Any:
        return self.node.create_publisher(kind, DIAGNOSTICS, QoSProfile(depth=QUEUE_DEPTH))

    def close(self) -> None:
        self._executor.shutdown()
        for served in self._served:
            served.close()  # otherwise the ROS graph lists it for another 20 s
        self.node.destroy_node()
        rclpy.try_shutdown()

    def inside(self, name: str) -> str:
        return f"~/{below_layer(name)}"

    def _parameter(self, parameter: Parameter) -> object:
        descriptor = ParameterDescriptor(description=parameter.meaning, read_only=not parameter.changes)
        if parameter.bounds is not None:
            low, high = parameter.bounds
            if isinstance(parameter.default, float):
                descriptor.floating_point_range = [FloatingPointRange(from_value=float(low), to_value=float(high))]
            else:
                descriptor.integer_range = [IntegerRange(from_value=int(low), to_value=int(high), step=1)]
        value: object = self.node.declare_parameter(parameter.name, parameter.default, descriptor).value
        return value

    def _follow_parameters(self, handler: EventHandler) -> None:
        """Accept changed parameters between batches, in the thread of the event loop."""

        def accept(changes: Sequence[Any]) -> SetParametersResult:
            try:
                for parameter in changes:
                    if parameter.name in self._changing:
                        check(self._changing[parameter.name], parameter.value)
            except ValueError as error:
                return SetParametersResult(successful=False, reason=str(error))
            handler.set_parameters({parameter.name: parameter.value for parameter in changes})
            return SetParametersResult(successful=True)

        if self._changing:
            self.node.add_on_set_parameters_callback(accept)

    def _is_up(self) -> bool:
        return bool(rclpy.ok())

    def _spin_once(self) -> None:
        self._queues.run_once(self._run_pending)

    def _run_pending(self) -> float:
        """Make the calls that are due; return how many seconds the executor may wait."""
        left = self.event_loop.run_pending()
        return LONGEST_WAIT if left is None or self.simulated else min(left, LONGEST_WAIT)

    def wake(self) -> None:
        self._executor.create_task(lambda: None)

    def _take_leave(self) -> None:
        until = time.monotonic() + FAREWELL
        for publisher in self._publishers.values():
            publisher.wait_for_all_acked(rclpy.duration.Duration(seconds=max(0.0, until - time.monotonic())))

    # Reports

    def now(self) -> float:
        return float(self._clock.now().nanoseconds) / 1e9

    def publish_report(self, name: str, text: str) -> None:
        self._reports[name].publish(String(data=text))

    def report_listeners(self, name: str) -> int:
        return int(self._reports[name].get_subscription_count())

    def info(self, text: str) -> None:
        self.node.get_logger().info(text)

    def warn(self, text: str) -> None:
        self.node.get_logger().warning(text)

    def error(self, text: str) -> None:
        self.node.get_logger().error(text)

    # Topics

    def _reception(self, element: rosgraph.Subscription | rosgraph.Publisher) -> Quality:
        return quality.reception(element.interface, element.topic, self._configuration)

    def feedback_qos(self, action: rosgraph.ActionClient | rosgraph.ActionServer) -> Any:
        """Return the quality of service of an action's feedback."""
        return _qos(quality.feedback(action.identifier, self._configuration))

    def _publisher(self, publisher: rosgraph.Publisher) -> Any:
        on_change = all(sending.onChange for sending in publisher.sendings)
        self._qualities[publisher] = _qos(
            quality.transmission(publisher.topic, self._configuration, on_change=on_change)
        )
        return self.node.create_publisher(
            self._types[publisher.interface],
            publisher.topic,
            self._qualities[publisher],
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            # The graph monitor reports mismatches.
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
        )

    def _subscribe(self, subscription: rosgraph.Subscription, receive: Callable[[Message], None]) -> None:
        subscriptions: list[QueuedSubscription] = []
        reception = self._reception(subscription)

        def subscribe(lasting: bool) -> None:
            requested = _qos(reception.latched if lasting else reception)
            while subscriptions:
                subscriptions.pop().close()
            self._qualities[subscription] = requested
            subscriptions.append(
                self.listen(
                    self._types[subscription.interface],
                    subscription.topic,
                    receive,
                    requested,
                    # Their parameters have the reliability of the first subscription by default.
                    qos_overriding_options=QoSOverridingOptions(_KEPT_POLICIES)
                    if lasting
                    else QoSOverridingOptions.with_default_policies(),
                    event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
                )
            )

        subscribe(lasting=False)
        if reception.settings.durability is None:
            self._durabilities.watch(subscription.topic, subscribe, lasting=False)

    def listen(
        self, kind: Any, topic: str, receive: Callable[[Message], None], qos: Any, **options: Any
    ) -> QueuedSubscription:
        """Subscribe to a topic; its messages wait for the turn of their queue."""
        return QueuedSubscription(self.node, self._queues, receive, (kind, topic, qos), options)

    def _relay(
        self,
        element: rosgraph.Subscription | rosgraph.Publisher,
        source: str,
        target: str,
        forwarded: Callable[[Message], Message | None],
    ) -> _Relay:
        sent = quality.forwarding(element.topic, self._configuration)
        route = _Route(self._types[element.interface], source, target, self._reception(element), sent)

        def open_side(received: Any, sending: Any) -> None:
            self._qualities[element] = sending if isinstance(element, rosgraph.Publisher) else received

        return _Relay(self, self._durabilities, route, forwarded, open_side)

    def type_name(self, interface: rosgraph.Interface) -> str:
        return f"{interface.package}/{FOLDERS[interface.kind.name]}/{interface.type}"

    def serving_nodes(self, element: Client | Server) -> list[tuple[str, str]]:
        is_action = element.interface.kind == rosgraph.InterfaceKind.action
        part = (_SENDING, "_SendGoal") if is_action else ("", "")
        name = self.node.resolve_service_name(element.identifier + part[0])
        own = self.type_name(element.interface) + part[1]
        # The types of clients are among these; the exact list of servers takes longer.
        if self._services is None:
            self._services = dict(self.node.get_service_names_and_types())
        types = self._services.get(name, ())
        if set(types) <= {own} and self.node.count_services(name) <= 1:
            return []
        served = self._nodes_with(name, self.node.get_service_names_and_types_by_node)
        return [(node, kind.removesuffix(part[1])) for node, kinds in served for kind in kinds]

    def calling_nodes(self, client: Client) -> list[str]:
        is_action = isinstance(client, rosgraph.ActionClient)
        name = self.node.resolve_service_name(client.identifier + (_SENDING if is_action else ""))
        # The exact list of clients takes longer.
        if self.node.count_clients(name) <= 1:
            return []
        called = self._nodes_with(name, self.node.get_client_names_and_types_by_node)
        return [node for node, _ in called if node != self.full_name]

    def _nodes_with(self, name: str, services_of: Callable[[str, str], Any]) -> list[tuple[str, Sequence[str]]]:
        """Return the nodes that serve or call a service, with its types there."""
        nodes = []
        for node, space in self.node.get_node_names_and_namespaces():
            try:
                types = dict(services_of(node, space)).get(name)
            except NodeNameNonExistentError:
                continue  # it has just gone
            if types:
                nodes.append((f"{space.rstrip('/')}/{node}", types))
        return nodes

    def endpoints(self) -> dict[rosgraph.Subscription | rosgraph.Publisher, list[Endpoint]]:
        self._durabilities.look()
        self._services = None
        return {element: self._endpoints(element) for element in self._topics}

    def _endpoints(self, element: rosgraph.Subscription | rosgraph.Publisher) -> list[Endpoint]:
        publishers = self.node.get_publishers_info_by_topic(element.topic)
        endpoints = [_endpoint(other, other.qos_profile, self._qualities[element]) for other in publishers]
        if isinstance(element, rosgraph.Publisher):
            # Use the node's own entry in the graph: the requested profile leaves deadlines and leases open.
            own = [info.qos_profile for info in publishers if _full_name(info) == self.full_name]
            endpoints += [
                replace(_endpoint(other, own[0], other.qos_profile), listens=True)
                for other in self.node.get_subscriptions_info_by_topic(element.topic)
                if own
            ]
        return [endpoint for endpoint in endpoints if endpoint.node != self.full_name]

    def hear(self) -> None:
        self._queues.empty()

    # Data

    def create(self, interface: rosgraph.Interface, section: Section) -> Message:
        kind = self._types[interface]
        return (kind if section is Section.MESSAGE else getattr(kind, section.name.capitalize()))()

    def wire_types(self, message: Message) -> Mapping[str, str]:
        types: Mapping[str, str] = message.get_fields_and_field_types()
        return types

    def _stamp_now(self) -> Any:
        return self._clock.now().to_msg()

    # Services and actions

    def is_served(self, client: Client) -> bool:
        connected = self._clients[client]
        action = isinstance(client, rosgraph.ActionClient)
        return bool(connected.server_is_ready() if action else connected.service_is_ready())

    def _service_client(self, service: rosgraph.ServiceClient) -> Any:
        qos = _qos(quality.service_calls(service.identifier, self._configuration))
        return self.node.create_client(self._types[service.interface], service.identifier, qos_profile=qos)

    def call(self, client: rosgraph.ServiceClient, request: Message, handlers: CallHandlers) -> None:
        connected = self._clients[client]
        if client in self._pending:
            connected.remove_pending_request(self._pending[client])
        self._pending[client] = connected.call_async(request)
        self._pending[client].add_done_callback(partial(settle, handlers.answered, handlers.failed))

    def serve(self, kind: Any, name: str, called: Callable[[Message, LateAnswer], None]) -> None:
        """Offer a service whose calls are answered later; rclpy by itself answers as soon as `called` returns."""
        under_way: list[LateAnswer] = []

        def serve(request: Message, response: Message) -> Message:
            under_way.append(LateAnswer(response))
            called(request, under_way[-1])
            return response

        chosen = quality.service_calls(name, self._configuration)
        qos = _qos(chosen)
        qos.depth = chosen.settings.depth or RECEIVED_REQUESTS
        service = self.node.create_service(kind, name, serve, qos_profile=qos)
        send = service.send_response
        service.send_response = lambda _, caller: under_way.pop().send_with(lambda response: send(response, caller))

    def _action_client(self, action: rosgraph.ActionClient) -> Any:
        kind, qos = self._types[action.interface], self.feedback_qos(action)
        return rclpy.action.ActionClient(self.node, kind, action.identifier, feedback_sub_qos_profile=qos)

    def send_goal(self, client: rosgraph.ActionClient, goal: Message, handlers: GoalHandlers) -> Goal:
        return SentGoal(self._clients[client], goal, handlers, partial(self.servers, client.identifier))

    def servers(self, action: str) -> frozenset[bytes]:
        """Return the servers of an action in the ROS graph; a restarted server has another identity."""
        publishers = self.node.get_publishers_info_by_topic(f"{action}/_action/status")
        return frozenset(bytes(publisher.endpoint_gid) for publisher in publishers)

    def _serve_action(self, action: rosgraph.ActionServer, server: ActionServer) -> None:
        from robosc.run.runtime.ros2.servers import Ros2ActionServer  # noqa: PLC0415  # few models serve actions

        self._served.append(Ros2ActionServer(self, self._types[action.interface], action, server))

    def _proxy(self, action: rosgraph.ActionClient, layer: Layer, timeout: float) -> ActionProxy[Any]:
        return Ros2ActionProxy(self, self._types[action.interface].Impl, action, layer, timeout)


def start(name: str, arguments: Sequence[str]) -> Any:
    """Start ROS and a node of this name; `arguments` are those of ROS. Raises StartError."""
    try:
        rclpy.init(args=["robosc", *arguments], signal_handler_options=SignalHandlerOptions.NO)
        return rclpy.create_node(name)
    except (RuntimeError, rclpy.exceptions.ParameterException) as error:
        # The error names an argument, a file or a folder; the place in rcl helps no user.
        raise StartError(f"ROS 2 does not start: {str(error).partition(', at /')[0]}") from None


def executor() -> Any:
    """Return the executor: by events if rclpy has one, which takes a fiftieth of the time for a message."""
    try:
        from rclpy.experimental import EventsExecutor  # noqa: PLC0415  # not in every rclpy
    except ImportError:
        return SingleThreadedExecutor()
    return EventsExecutor()


def _endpoint(other: Any, offered: Any, requested: Any) -> Endpoint:
    compatibility, reason = qos_check_compatible(offered, requested)
    fault = reason.strip(";: ") if compatibility == QoSCompatibility.ERROR else None
    name = _full_name(other)
    return Endpoint("" if "UNKNOWN" in name else name, other.topic_type, fault)


def _full_name(info: Any) -> str:
    return f"{info.node_namespace.rstrip('/')}/{info.node_name}"


class QueuedSubscription:
    """Subscription whose messages wait in a queue. `topic`: the type, the name and the quality of service."""

    def __init__(
        self,
        node: Any,
        queues: MessageQueues,
        receive: Callable[[Message], None],
        topic: tuple[Any, str, Any],
        options: Mapping[str, Any],
    ) -> None:
        self._node = node
        self._queues = queues
        kind, name, qos = topic
        self._queue = MessageQueue(receive, self._take, qos.depth)
        self._subscription = node.create_subscription(kind, name, self._queue.store, qos, **options)
        queues.add(self._queue)

    def close(self) -> None:
        """Unsubscribe."""
        self._node.destroy_subscription(self._subscription)
        self._queues.remove(self._queue)

    def _take(self) -> Message | None:
        subscription = self._subscription
        with subscription.handle:
            message_and_info = subscription.handle.take_message(subscription.msg_type, subscription.raw)
        return None if message_and_info is None else message_and_info[0]


@dataclass(frozen=True)
class _Route:
    """Route from one topic to another, each with its quality of service."""

    kind: Any
    source: str
    target: str
    received: Quality
    sent: Quality


class _Durabilities:
    """Detect whether the publishers of topics keep their last messages for late subscribers.

    A topic lasts if all of its publishers are transient-local and reliable. A subscription that requests less receives
    their messages, but not the kept ones. A subscription that requests durability receives nothing from other
    publishers.
    """

    def __init__(self, node: Any) -> None:
        self._node = node
        self._watched: list[tuple[str, Callable[[bool], None]]] = []
        self._lasting: dict[int, bool | None] = {}

    def watch(self, topic: str, changed: Callable[[bool], None], *, lasting: bool | None = None) -> None:
        """Call `changed` whenever a topic lasts or no longer does. `lasting`: the known state, None if unknown."""
        if not self._watched:
            # Publishers come and go whether simulated time passes or not.
            self._node.create_timer(_LOOK, self.look, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._lasting[len(self._watched)] = lasting
        self._watched.append((topic, changed))

    def look(self) -> None:
        """Check all topics."""
        for number, (topic, changed) in enumerate(self._watched):
            publishers = self._node.get_publishers_info_by_topic(topic)
            if not publishers:
                continue
            lasting = all(_keeps(info.qos_profile) for info in publishers)
            if lasting != self._lasting[number]:
                self._lasting[number] = lasting
                changed(lasting)


def _keeps(quality: Any) -> bool:
    keeps: bool = quality.durability == DurabilityPolicy.TRANSIENT_LOCAL
    return keeps and quality.reliability == ReliabilityPolicy.RELIABLE


class _Relay:
    """Forward messages from one topic to another, as `forwarded` returns them; None is not forwarded.

    The publisher is reliable, and transient-local if all publishers of the source are.
    """

    def __init__(
        self,
        port: Ros2Node,
        durabilities: _Durabilities,
        route: _Route,
        forwarded: Callable[[Message], Message | None],
        opened: Callable[[Any, Any], None],
    ) -> None:
        self._port = port
        node = self._node = port.node
        self._route = route
        self._forwarded = forwarded
        self._opened = opened
        self._lasting = False
        self._subscription: QueuedSubscription | None = None
        self._publisher = node.create_publisher(route.kind, route.target, _qos(route.sent))
        opened(_qos(route.received), _qos(route.sent))
        durabilities.watch(node.resolve_topic_name(route.source), self._open)

    def _open(self, lasting: bool) -> None:
        node, route = self._node, self._route
        sent = _qos(route.sent.latched if lasting else route.sent)
        if lasting != self._lasting:
            self._lasting = lasting
            node.destroy_publisher(self._publisher)
            self._publisher = node.create_publisher(route.kind, route.target, sent)
        if self._subscription is not None:
            self._subscription.close()
        received = _qos(route.received.latched if lasting else route.received.volatile)
        self._opened(received, sent)
        self._subscription = self._port.listen(route.kind, route.source, self._forward, received)

    def _forward(self, message: Message) -> None:
        forwarded = self._forwarded(message)
        if forwarded is not None:
            self.publish(forwarded)

    def publish(self, message: Message) -> None:
        """Send a message to the subscribers of the forwarded topic."""
        self._publisher.publish(message)

    def wait_for_all_acked(self, timeout: Any) -> None:
        """Wait until all sent messages have arrived."""
        self._publisher.wait_for_all_acked(timeout)


def _qos(quality: Quality) -> Any:
    """Return a quality of service for rclpy."""
    profile, chosen = _PROFILES[quality.profile], quality.settings
    qos = QoSProfile(
        depth=chosen.depth or profile.depth, reliability=profile.reliability, durability=profile.durability
    )
    if chosen.reliability:
        qos.reliability = ReliabilityPolicy[chosen.reliability.upper()]
    if chosen.durability:
        qos.durability = DurabilityPolicy[chosen.durability.upper()]
    return qos
