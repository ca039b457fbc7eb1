"""ROS node without its middleware, and the error of a node that can't start."""

from __future__ import annotations

import signal
from abc import ABC, abstractmethod
from functools import partial
from importlib import import_module
from itertools import zip_longest
from typing import TYPE_CHECKING, Any, ClassVar

from robosc.base.ros_types.wire import FOLDERS, Section
from robosc.language.configuration import ABSOLUTE_NAMES
from robosc.model import rosgraph
from robosc.run.runtime.core.gate import GatedLayer
from robosc.run.runtime.core.layer import Layer
from robosc.run.runtime.core.node_data import element_type
from robosc.run.runtime.core.port import ControllerPort
from robosc.run.runtime.core.proxies import ServiceProxy
from robosc.run.runtime.core.settings import check

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.language.configuration.parameters import Parameter, Value
    from robosc.run.runtime.core.controller import Controller
    from robosc.run.runtime.core.event_handler import EventHandler
    from robosc.run.runtime.core.event_loop import EventLoop
    from robosc.run.runtime.core.port import Client, ComponentStatus, Message
    from robosc.run.runtime.core.proxies import ActionProxy
    from robosc.run.runtime.core.servers import ActionServer
    from robosc.run.runtime.core.settings import Settings

#: Seconds between two checks for an interrupt at most, and seconds for the last messages to arrive.
LONGEST_WAIT = 0.1
FAREWELL = 0.5
#: Topic of robot monitors.
DIAGNOSTICS = "/diagnostics"


class StartError(Exception):
    """Error of a node that can't start. `hint` describes how the user can fix it."""

    def __init__(self, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.hint = hint


class RunningNode(ControllerPort, ABC):
    """Running node for a controller or a layer. Raises StartError for a missing type.

    The subclass creates publishers, subscriptions and clients with its middleware.
    """

    #: Hint for a missing ROS type, and the exceptions of a ROS that rejects a name or value.
    type_hint: ClassVar[str]
    refusals: ClassVar[tuple[type[Exception], ...]]
    #: Whether other programs can receive the node's reports.
    in_graph: ClassVar[bool] = True
    event_loop: EventLoop
    #: Whether the clock is that of a simulation.
    simulated: bool

    def __init__(self, graph: rosgraph.RosGraph) -> None:
        self._graph = graph
        self._types = {interface: self._load_type(interface) for interface in graph.interfaces}
        self._reports: dict[str, Any] = {}
        self._statuses: Any = None
        self._changing: dict[str, Parameter] = {}
        self._publishers: dict[rosgraph.Publisher, Any] = {}
        self._clients: dict[Client, Any] = {}
        self._ended = False

    def unset(self, interface: rosgraph.Interface, section: Section, path: Sequence[str]) -> Message:
        """Return the object at a path in new data of a type; a step `0` is an element of an array."""
        message = self.create(interface, section)
        for name, behind in zip_longest(path, path[1:]):
            if behind == "0":
                package, *_, kind = element_type(self.wire_types(message)[name]).split("/")
                element = rosgraph.Interface(package=package, type=kind, kind=rosgraph.InterfaceKind.message)
                self._types[element] = self._load_type(element)
                message = self.create(element, Section.MESSAGE)
            elif name != "0":
                message = getattr(message, name)
        return message

    def _load_type(self, interface: rosgraph.Interface) -> Any:
        """Return the Python class of a ROS type. Raises StartError if there is none."""
        folder = FOLDERS[interface.kind.name]
        package = interface.package
        try:
            return getattr(import_module(f"{package}.{folder}"), interface.type)
        except ImportError as error:
            missing = f"{package}.{folder}" if error.name in {package, f"{package}.{folder}"} else error
            why = f"{package}/{interface.type}: the ROS package {package} is not built for Python here ({missing})"
        except AttributeError:
            why = f"the ROS package {package} has no {interface.kind.name} {interface.type}"
        raise StartError(why, self.type_hint)

    # The node's life

    def parameters(self, declared: Sequence[Parameter]) -> dict[str, Value]:
        """Return the values of the node's parameters. Raises StartError for a value that does not fit."""
        values = {}
        for parameter in declared:
            try:
                value = self._parameter(parameter)
            except self.refusals as error:
                raise StartError(f"parameter {parameter.name}: {error}") from None
            try:
                values[parameter.name] = check(parameter, value)
            except ValueError as error:
                raise StartError(f"parameter {error}") from None
        self._changing = {parameter.name: parameter for parameter in declared if parameter.changes}
        return values

    def connect(self, handler: Controller | Layer, settings: Settings) -> None:
        """Create publishers and clients, then subscriptions. Raises StartError if ROS rejects a name."""
        try:
            if isinstance(handler, GatedLayer):
                self._connect_commands()
                self._connect_topics(handler)
            elif isinstance(handler, Layer):
                self._connect_layer(handler, settings)
            else:
                self._connect_controller(handler)
        except self.refusals as error:
            raise StartError(str(error)) from None
        self._follow_parameters(handler)
        if settings.configuration.warns_of_absolute_names:
            self._warn_of_absolute_names()

    def _warn_of_absolute_names(self) -> None:
        """Warn of the model's names that are outside of the node's namespace, after remapping."""
        namespace = self.full_name.rpartition("/")[0]
        outside = [name for name, resolved in self._absolute_names() if not resolved.startswith(f"{namespace}/")]
        if namespace and outside:
            self.warn(ABSOLUTE_NAMES % (namespace, ", ".join(outside)))

    def _connect_controller(self, controller: Controller) -> None:
        self._connect_commands()
        for served in self._graph.serviceServers:
            self.serve(self._types[served.interface], served.identifier, controller.services[served].call)
        for performed in self._graph.actionServers:
            self._serve_action(performed, controller.actions[performed])
        self._connect_topics(controller)

    def _connect_commands(self) -> None:
        for publisher in self._graph.publishers:
            self._publishers[publisher] = self._publisher(publisher)
        for service in self._graph.serviceClients:
            self._clients[service] = self._service_client(service)
        for action in self._graph.actionClients:
            self._clients[action] = self._action_client(action)

    def _connect_topics(self, handler: EventHandler) -> None:
        for subscription in self._graph.subscriptions:
            self._subscribe(subscription, partial(handler.receive, subscription))

    def _connect_layer(self, layer: Layer, settings: Settings) -> None:
        """Connect a layer between controller and robot: each name has a private counterpart for the controller."""
        for topic in self._graph.subscriptions:
            self._relay(topic, topic.topic, self.inside(topic.topic), partial(_forwarded, layer, topic))
        for publisher in self._graph.publishers:
            (sending,) = publisher.sendings
            self._publishers[publisher] = self._relay(
                publisher, self.inside(publisher.topic), publisher.topic, partial(layer.forwarded, sending)
            )
        for service in self._graph.serviceClients:
            self._clients[service] = self._service_client(service)
            proxy = ServiceProxy(self, self.event_loop, service, layer, settings.seconds("service_timeout_ms"))
            self.serve(self._types[service.interface], self.inside(service.identifier), proxy.call)
        for action in self._graph.actionClients:
            proxied = self._proxy(action, layer, settings.seconds("action_timeout_ms"))
            layer.goals[action.cancel] = self._clients[action] = proxied

    def end(self) -> None:
        """End `spin` soon, as an interrupt does; from any thread."""
        self._ended = True
        self.wake()

    def spin(self, handler: EventHandler) -> None:
        """Run a handler until the user interrupts it; stop it before the node ends."""
        interrupted: list[int] = []

        def interrupt(number: int, _: object) -> None:
            interrupted.append(number)

        # A hangup is ignored under nohup.
        hangup = [signal.SIGHUP] if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN else []
        for number in [signal.SIGINT, signal.SIGTERM, *hangup]:
            signal.signal(number, interrupt)
        handler.start()
        while not interrupted and not self._ended and self._is_up():
            self._spin_once()
        handler.stop()
        while handler.busy:
            self._spin_once()
        handler.close()
        self._take_leave()
        self.close()

    # Interface to the middleware

    @abstractmethod
    def _follow_parameters(self, handler: EventHandler) -> None:
        """Report parameters that change while the node runs to the handler, between batches."""

    @abstractmethod
    def _absolute_names(self) -> Sequence[tuple[str, str]]:
        """Return the absolute names of the model, each with its name in the ROS graph."""

    @property
    @abstractmethod
    def full_name(self) -> str:
        """Name of the node with its namespace, such as `/left/base`."""

    @abstractmethod
    def open_reports(self, names: Sequence[str]) -> None:
        """Create the publishers of `publish_report`; the definition is kept for late subscribers."""

    @abstractmethod
    def _diagnostics_publisher(self, kind: Any) -> Any:
        """Return a publisher of arrays of statuses."""

    @abstractmethod
    def close(self) -> None:
        """End the node: nothing more is sent or received."""

    @abstractmethod
    def inside(self, name: str) -> str:
        """Return the layer's name for the controller in place of a topic, service or action of the robot."""

    @abstractmethod
    def _parameter(self, parameter: Parameter) -> object:
        """Return the start value of a parameter. Raises one of `refusals`."""

    @abstractmethod
    def _is_up(self) -> bool:
        """Return whether ROS runs, so that the node may go on."""

    @abstractmethod
    def _spin_once(self) -> None:
        """Do what is due, and wait for more, at most `LONGEST_WAIT` seconds."""

    @abstractmethod
    def wake(self) -> None:
        """End the present wait, so that posted calls are made; from any thread."""

    @abstractmethod
    def _take_leave(self) -> None:
        """Wait briefly until the last messages have arrived."""

    @abstractmethod
    def _publisher(self, publisher: rosgraph.Publisher) -> Any:
        """Return a publisher of the controller's messages."""

    @abstractmethod
    def _subscribe(self, subscription: rosgraph.Subscription, receive: Callable[[Message], None]) -> None:
        """Call `receive` in the event loop's thread for every message."""

    @abstractmethod
    def _service_client(self, service: rosgraph.ServiceClient) -> Any:
        """Return a client of a service of the robot."""

    @abstractmethod
    def _action_client(self, action: rosgraph.ActionClient) -> Any:
        """Return a client that sends goals to the robot."""

    @abstractmethod
    def _relay(
        self,
        element: rosgraph.Subscription | rosgraph.Publisher,
        source: str,
        target: str,
        forwarded: Callable[[Message], Message | None],
    ) -> Any:
        """Forward messages from one topic to another, as `forwarded` returns them; return the publisher of the target.

        None is not forwarded.
        """

    @abstractmethod
    def serve(self, kind: Any, name: str, called: Callable[[Message, Any], None]) -> None:
        """Offer a service whose calls are answered later.

        `called` is called in the event loop's thread, with the request and its `Answer`.
        """

    @abstractmethod
    def _serve_action(self, action: rosgraph.ActionServer, server: ActionServer) -> None:
        """Offer an action of the controller."""

    @abstractmethod
    def _proxy(self, action: rosgraph.ActionClient, layer: Layer, timeout: float) -> ActionProxy[Any]:
        """Offer an action to the controller as a proxy of the robot's action; `timeout` in seconds."""

    @abstractmethod
    def _stamp_now(self) -> Any:
        """Return the node's time, as ROS has it in headers."""

    # Independent of the middleware

    def stamp(self, message: Message, frame: str) -> None:
        """Set the time and the frame of a header."""
        header: Any = getattr(message, "header", None)
        if hasattr(header, "stamp"):
            header.stamp = self._stamp_now()
            header.frame_id = frame

    def open_diagnostics(self) -> None:
        """Create the publisher of `publish_statuses`; warn if its types are missing."""
        try:
            self._statuses = import_module("diagnostic_msgs.msg")
        except ImportError as error:
            self.warn(f"nothing is published on {DIAGNOSTICS}: {error}. {self.type_hint}; or set diagnostics_ms to 0")
        else:
            self._reports["diagnostics"] = self._diagnostics_publisher(self._statuses.DiagnosticArray)

    def publish_statuses(self, statuses: Sequence[ComponentStatus]) -> None:
        """Publish statuses on `/diagnostics`, named by the node and the component."""
        kinds = self._statuses
        report = kinds.DiagnosticArray()
        report.header.stamp = self._stamp_now()
        report.status = [
            kinds.DiagnosticStatus(
                level=getattr(kinds.DiagnosticStatus, status.level),
                name=f"{self.full_name.removeprefix('/')}: {status.component}",
                message=status.message,
                hardware_id=self._graph.name,
                values=[kinds.KeyValue(key=key, value=value) for key, value in status.values],
            )
            for status in statuses
        ]
        self._reports["diagnostics"].publish(report)

    def status_listeners(self) -> int:
        """Return the number of subscriptions to `/diagnostics`."""
        return self.report_listeners("diagnostics") if "diagnostics" in self._reports else 0

    def publish(self, publisher: rosgraph.Publisher, message: Message) -> None:
        """Send a message."""
        self._publishers[publisher].publish(message)

    def receivers(self, publisher: rosgraph.Publisher) -> int:
        """Return the number of subscriptions to a topic that the node publishes."""
        return int(self._publishers[publisher].get_subscription_count())

    @property
    def _topics(self) -> list[rosgraph.Subscription | rosgraph.Publisher]:
        return [*self._graph.subscriptions, *self._graph.publishers]


def _forwarded(layer: Layer, topic: rosgraph.Subscription, message: Message) -> Message:
    layer.receive(topic, message)
    return message
