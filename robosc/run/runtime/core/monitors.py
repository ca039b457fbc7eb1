"""Monitors of a node: silent topics, and its connections in the ROS graph."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from robosc.model import rosgraph

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from robosc.run.runtime.core.event_loop import EventLoop
    from robosc.run.runtime.core.port import Client, ControllerPort, Endpoint, Server

#: Seconds between two looks at the graph, and looks after which a topic should have a publisher.
_PERIOD = 1.0
_PATIENCE = 5
#: Looks for which two nodes of one name may serve: a killed and restarted node is listed twice for 20 s.
_LEASE = 25
#: End of a warning about commands that do not pass the layer.
AROUND = ", around this layer"
#: Why a call or goal has failed if only such a server exists.
OTHER_TYPE = "the server has another type"


class Watchdog:
    """Call `silent` after some seconds without a message, and `resumed` at the next message.

    `tripped`: whether the topic is silent.
    """

    def __init__(
        self, loop: EventLoop, seconds: float, silent: Callable[[], None], resumed: Callable[[], None]
    ) -> None:
        self._loop = loop
        self._seconds = seconds
        self._silent = silent
        self._resumed = resumed
        self._received = loop.clock()
        self.tripped = False
        loop.call_later(seconds, self._check)

    def reset(self) -> None:
        """Note a message: the seconds count from now."""
        self._received = self._loop.clock()
        if self.tripped:
            self.tripped = False
            self._loop.call_later(self._seconds, self._check)
            self._resumed()

    def _check(self) -> None:
        left = self._received + self._seconds - self._loop.clock()
        if left > 0:
            self._loop.call_later(left, self._check)
        else:
            self.tripped = True
            self._silent()


class GraphMonitor:
    """Check the other nodes on the node's topics, and the servers that it calls, every second.

    Each fault is logged once, and `faults` has it as long as it lasts: another type, a quality of service that does not
    fit, no publisher for five seconds, another publisher on a topic that the controller commands, a server of another
    type if there is none of the right one, and several servers of the right type, the controller among them if it
    serves. If the node is a layer, another publisher goes around it, and so do other clients of its services and
    actions.
    """

    def __init__(
        self, port: ControllerPort, loop: EventLoop, called: Sequence[Client | Server] = (), *, layer: bool = False
    ) -> None:
        self._port = port
        self._loop = loop
        self._called = called
        self._layer = layer
        self._missing: dict[str, int] = {}
        self._twice: Counter[Client | Server] = Counter()
        self._other_types: set[Client | Server] = set()
        self._reported: set[str] = set()
        self._faults: dict[rosgraph.Subscription | rosgraph.Publisher | Client | Server, list[str]] = {}

    def start(self) -> None:
        """Begin to check."""
        self._loop.call_later(_PERIOD, self._look)

    def faults(self, element: rosgraph.Subscription | rosgraph.Publisher | Client | Server) -> Sequence[str]:
        """Return the faults of a topic, service or action at the last check."""
        return self._faults.get(element, ())

    def has_other_type(self, client: Client) -> bool:
        """Return whether the last check found servers of another type only."""
        return client in self._other_types

    def _look(self) -> None:
        self._faults = {}
        self._other_types = set()
        for element, endpoints in self._port.endpoints().items():
            if isinstance(element, rosgraph.Subscription):
                self._check_subscription(element, endpoints)
            else:
                self._check_publisher(element, endpoints)
        for called in self._called:
            self._check_servers(called)
            if self._layer and isinstance(called, rosgraph.ServiceClient | rosgraph.ActionClient):
                self._check_callers(called)
        self.start()

    def _check_subscription(self, subscription: rosgraph.Subscription, endpoints: list[Endpoint]) -> None:
        topic = subscription.topic
        self._missing[topic] = 0 if endpoints else self._missing.get(topic, 0) + 1
        if self._missing[topic] >= _PATIENCE:
            # A late publisher is usual while a robot starts: information, not a warning.
            text = f"{topic}: nobody publishes it after {_PATIENCE} s"
            self._note(subscription, f"{topic}: nobody publishes it", text, self._port.info)
        for publisher in endpoints:
            self._compare(subscription, publisher, "publishes", "offers")

    def _check_publisher(self, publisher: rosgraph.Publisher, endpoints: list[Endpoint]) -> None:
        for endpoint in endpoints:
            if endpoint.listens:
                self._compare(publisher, endpoint, "expects", "asks for")
            elif endpoint.node:
                around = AROUND if self._layer else ""
                self._note(publisher, f"{publisher.topic}: {endpoint.node} publishes it, too{around}")

    def _check_callers(self, client: Client) -> None:
        does = "sends goals" if isinstance(client, rosgraph.ActionClient) else "calls it"
        for node in self._port.calling_nodes(client):
            self._note(client, f"{client.identifier}: {node} {does}, too{AROUND}")

    def _check_servers(self, called: Client | Server) -> None:
        serving = self._port.serving_nodes(called)
        if not serving:
            self._twice[called] = 0
            return
        expected = self._port.type_name(called.interface)
        others = [] if self._is_served(called) else [server for server in serving if server[1] != expected]
        for node, other in others:
            self._other_types.add(called)
            self._note(called, f"{called.identifier}: {node} serves {other}, not {expected}")
        self._check_single(called, sorted(node for node, kind in serving if kind == expected))

    def _is_served(self, called: Client | Server) -> bool:
        return isinstance(called, rosgraph.ServiceServer | rosgraph.ActionServer) or self._port.is_served(called)

    def _check_single(self, called: Client | Server, servers: list[str]) -> None:
        """Note several servers of the right type: only the first answer counts."""
        names = sorted(set(servers))
        self._twice[called] = self._twice[called] + 1 if len(names) < len(servers) else 0
        if len(names) > 1:
            self._note(called, f"{called.identifier}: {' and '.join(names)} serve it: only one answer counts")
        elif self._twice[called] > _LEASE:
            self._note(called, f"{called.identifier}: several nodes {names[0]} serve it: only one answer counts")

    def _compare(self, own: rosgraph.Subscription | rosgraph.Publisher, other: Endpoint, does: str, has: str) -> None:
        topic, expected = own.topic, self._port.type_name(own.interface)
        if not other.node:
            return
        if other.type != expected:
            self._note(own, f"{topic}: {other.node} {does} {other.type}, not {expected}")
        elif other.incompatible:
            self._note(own, f"{topic}: {other.node} {has} a quality of service that does not fit: {other.incompatible}")

    def _note(
        self,
        element: rosgraph.Subscription | rosgraph.Publisher | Client | Server,
        fault: str,
        text: str | None = None,
        report: Callable[[str], None] | None = None,
    ) -> None:
        """Note a fault until the next check; log the text, else the fault, the first time."""
        faults = self._faults.setdefault(element, [])
        if fault not in faults:
            faults.append(fault)
        text = text or fault
        if text not in self._reported:
            self._reported.add(text)
            (report or self._port.warn)(text)
