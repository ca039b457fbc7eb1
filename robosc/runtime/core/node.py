"""A ROS node without its middleware, and the error of a node that can't start."""

from __future__ import annotations

import signal
from abc import ABC, abstractmethod
from functools import partial
from importlib import import_module
from itertools import zip_longest
from typing import TYPE_CHECKING, Any, ClassVar

from robosc.metamodel import rosgraph
from robosc.ros_types.wire import FOLDERS, Section
from robosc.runtime.core.layer import Layer
from robosc.runtime.core.node_data import element_type
from robosc.runtime.core.port import ControllerPort
from robosc.runtime.core.proxies import ServiceProxy
from robosc.runtime.core.settings import check

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.configuration.parameters import Parameter, Value
    from robosc.runtime.core.controller import Controller
    from robosc.runtime.core.event_handler import EventHandler
    from robosc.runtime.core.event_loop import EventLoop
    from robosc.runtime.core.port import Client, ComponentStatus, Message
    from robosc.runtime.core.proxies import ActionProxy
    from robosc.runtime.core.settings import Settings

#: Seconds that a node waits at most before it looks whether it was interrupted, and for what it sent at its end.
LONGEST_WAIT = 0.1
FAREWELL = 0.5
#: Where monitors of robots listen.
DIAGNOSTICS = "/diagnostics"


class StartError(Exception):
    """A node can't start, for a reason that its user can do something about: what to do is the second argument."""

    def __init__(self, message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.hint = hint


class Node(ControllerPort, ABC):
    """A running node, for a controller or a layer. Raises StartError for a type that is not there.

    The subclass makes publishers, subscriptions and clients with its middleware.
    """

    #: What to do where a ROS type is not there, and what is raised where ROS refuses a name or value.
    type_hint: ClassVar[str]
    refusals: ClassVar[tuple[type[Exception], ...]]
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

    def unset(self, interface: rosgraph.Interface, section: Section, path: Sequence[str]) -> Message:
        """Return the object at a path in new data of a type; a step `0` is an element of an array."""
        made = self.create(interface, section)
        for name, behind in zip_longest(path, path[1:]):
            if behind == "0":
                package, *_, kind = element_type(self.wire_types(made)[name]).split("/")
                element = rosgraph.Interface(package=package, type=kind, kind=rosgraph.InterfaceKind.message)
                self._types[element] = self._load_type(element)
                made = self.create(element, Section.MESSAGE)
            elif name != "0":
                made = getattr(made, name)
        return made

    def _load_type(self, interface: rosgraph.Interface) -> Any:
        """The Python class of a ROS type. Raises StartError where there is none."""
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
        """The values of the node's parameters. Raises StartError for one that does not fit."""
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
        """Makes what is sent with, then what is listened to. Raises StartError where ROS refuses a name."""
        try:
            if isinstance(handler, Layer):
                self._connect_layer(handler, settings)
            else:
                self._connect_controller(handler)
        except self.refusals as error:
            raise StartError(str(error)) from None
        self._follow_parameters(handler)

    def _connect_controller(self, controller: Controller) -> None:
        for publisher in self._graph.publishers:
            self._publishers[publisher] = self._publisher(publisher)
        for service in self._graph.serviceClients:
            self._clients[service] = self._service_client(service)
        for action in self._graph.actionClients:
            self._clients[action] = self._action_client(action)
        for subscription in self._graph.subscriptions:
            self._subscribe(subscription, partial(controller.receive, subscription))

    def _connect_layer(self, layer: Layer, settings: Settings) -> None:
        """Stands between the controller and the robot: each of its names has a private one for the controller."""
        for topic in self._graph.subscriptions:
            self._relay(topic, topic.topic, self.inside(topic.topic), partial(_forwarded, layer, topic))
        for publisher in self._graph.publishers:
            (sending,) = publisher.sendings
            self._publishers[publisher] = self._relay(
                publisher, self.inside(publisher.topic), publisher.topic, partial(_allowed, layer, sending)
            )
        for service in self._graph.serviceClients:
            self._clients[service] = self._service_client(service)
            proxy = ServiceProxy(self, self.event_loop, service, layer, settings.seconds("service_timeout_ms"))
            self.serve(self._types[service.interface], self.inside(service.identifier), proxy.call)
        for action in self._graph.actionClients:
            layer.goals[action.cancel] = self._proxy(action, layer, settings.seconds("action_timeout_ms"))

    def spin(self, handler: EventHandler) -> None:
        """Lets somebody act until the user interrupts it; it stops before the node ends."""
        interrupted: list[int] = []

        def interrupt(number: int, _: object) -> None:
            interrupted.append(number)

        # A hangup is ignored under nohup.
        hangup = [signal.SIGHUP] if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN else []
        for number in [signal.SIGINT, signal.SIGTERM, *hangup]:
            signal.signal(number, interrupt)
        handler.start()
        while not interrupted and self._is_up():
            self._spin_once()
        handler.stop()
        while handler.busy:
            self._spin_once()
        handler.close()
        self._take_leave()
        self.close()

    # What the middleware does

    @abstractmethod
    def _follow_parameters(self, handler: EventHandler) -> None:
        """Reports parameters that change while the node runs to the handler, between batches."""

    @property
    @abstractmethod
    def full_name(self) -> str:
        """The node's name with its namespace, such as `/left/base`."""

    @abstractmethod
    def open_reports(self, names: Sequence[str]) -> None:
        """Makes what `publish_report` publishes on; the definition is kept for those who come later."""

    @abstractmethod
    def _diagnostics_publisher(self, kind: Any) -> Any:
        """Publishes arrays of statuses."""

    @abstractmethod
    def close(self) -> None:
        """Nothing more is sent or received."""

    @abstractmethod
    def inside(self, name: str) -> str:
        """The layer's name for the controller in the place of a topic, service or action of the robot."""

    @abstractmethod
    def _parameter(self, parameter: Parameter) -> object:
        """The value that the node was started with. Raises one of `refusals`."""

    @abstractmethod
    def _is_up(self) -> bool:
        """Whether ROS runs: the node may go on."""

    @abstractmethod
    def _spin_once(self) -> None:
        """Does what is due, and waits for more, at most `LONGEST_WAIT` seconds."""

    @abstractmethod
    def _take_leave(self) -> None:
        """Lets what was sent last arrive, as far as that is soon."""

    @abstractmethod
    def _publisher(self, publisher: rosgraph.Publisher) -> Any:
        """Publishes the controller's messages."""

    @abstractmethod
    def _subscribe(self, subscription: rosgraph.Subscription, receive: Callable[[Message], None]) -> None:
        """Calls `receive` in the event loop's thread for every message."""

    @abstractmethod
    def _service_client(self, service: rosgraph.ServiceClient) -> Any:
        """Calls a service of the robot."""

    @abstractmethod
    def _action_client(self, action: rosgraph.ActionClient) -> Any:
        """Sends goals to the robot."""

    @abstractmethod
    def _relay(
        self,
        element: rosgraph.Subscription | rosgraph.Publisher,
        source: str,
        target: str,
        passes: Callable[[Message], bool],
    ) -> Any:
        """Forwards messages from one topic to another where `passes` says so; what it returns publishes there, too."""

    @abstractmethod
    def serve(self, kind: Any, name: str, called: Callable[[Message, Any], None]) -> None:
        """A service whose calls are answered later.

        `called` is called in the event loop's thread, with the request and its `Answer`.
        """

    @abstractmethod
    def _proxy(self, action: rosgraph.ActionClient, layer: Layer, timeout: float) -> ActionProxy[Any]:
        """An action for the controller behind which stands the robot's one; `timeout` in seconds."""

    @abstractmethod
    def _stamp_now(self) -> Any:
        """The node's time, as ROS has it in headers."""

    # What needs no middleware

    def stamp(self, message: Message, frame: str) -> None:
        """Gives a header the node's time and a frame."""
        header: Any = getattr(message, "header", None)
        if hasattr(header, "stamp"):
            header.stamp = self._stamp_now()
            header.frame_id = frame

    def open_diagnostics(self) -> None:
        """Makes what `publish_statuses` publishes on; where its types are not there, a warning says so."""
        try:
            self._statuses = import_module("diagnostic_msgs.msg")
        except ImportError as error:
            self.warn(f"nothing is published on {DIAGNOSTICS}: {error}. {self.type_hint}; or set diagnostics_ms to 0")
        else:
            self._reports["diagnostics"] = self._diagnostics_publisher(self._statuses.DiagnosticArray)

    def publish_statuses(self, statuses: Sequence[ComponentStatus]) -> None:
        """Publishes statuses on `/diagnostics`, named by the node and the component."""
        kinds = self._statuses
        report = kinds.DiagnosticArray()
        report.header.stamp = self._stamp_now()
        report.status = [
            kinds.DiagnosticStatus(
                level=kinds.DiagnosticStatus.WARN if status.warns else kinds.DiagnosticStatus.OK,
                name=f"{self.full_name.removeprefix('/')}: {status.component}",
                message=status.message,
                hardware_id=self._graph.name,
                values=[kinds.KeyValue(key=key, value=value) for key, value in status.values],
            )
            for status in statuses
        ]
        self._reports["diagnostics"].publish(report)

    def status_listeners(self) -> int:
        """How many subscriptions there are to it."""
        return self.report_listeners("diagnostics") if "diagnostics" in self._reports else 0

    def publish(self, publisher: rosgraph.Publisher, message: Message) -> None:
        """Sends a message."""
        self._publishers[publisher].publish(message)

    @property
    def _topics(self) -> list[rosgraph.Subscription | rosgraph.Publisher]:
        return [*self._graph.subscriptions, *self._graph.publishers]


def _forwarded(layer: Layer, topic: rosgraph.Subscription, message: Message) -> bool:
    layer.receive(topic, message)
    return True


def _allowed(layer: Layer, sending: rosgraph.Sending, _: Message) -> bool:
    return layer.passes(sending)
