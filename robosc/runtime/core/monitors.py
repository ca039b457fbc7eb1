"""What a node watches: topics that fall silent, and how it is connected to the rest of the ROS graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import rosgraph

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.runtime.core.event_loop import EventLoop
    from robosc.runtime.core.port import ControllerPort, Endpoint

#: From one look at the graph to the next, in seconds, and after how many looks a topic should have a publisher.
_PERIOD = 1.0
_PATIENCE = 5


class Watchdog:
    """Calls `silent` when nothing was received for so many seconds, and `resumed` when something is again.

    `tripped` says whether the topic is silent.
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
        """A message was received: the seconds count from now."""
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
    """Looks every second at the other nodes on the node's topics, and reports each fault once.

    Reported are another type, a quality of service that does not fit, no publisher for five seconds, and another
    publisher on a topic that the controller commands.
    """

    def __init__(self, port: ControllerPort, loop: EventLoop) -> None:
        self._port = port
        self._loop = loop
        self._looks = 0
        self._published: set[str] = set()
        self._reported: set[str] = set()

    def start(self) -> None:
        """Looks from now on."""
        self._loop.call_later(_PERIOD, self._look)

    def _look(self) -> None:
        self._looks += 1
        for element, endpoints in self._port.endpoints().items():
            if isinstance(element, rosgraph.Subscription):
                self._check_subscription(element, endpoints)
            else:
                self._check_publisher(element, endpoints)
        self.start()

    def _check_subscription(self, subscription: rosgraph.Subscription, endpoints: list[Endpoint]) -> None:
        topic = subscription.topic
        if endpoints:
            self._published.add(topic)
        elif topic not in self._published and self._looks >= _PATIENCE:
            # It may tell what seldom happens, such as that a button was pressed.
            self._report(f"{topic}: nobody publishes it after {_PATIENCE} s", self._port.info)
        for publisher in endpoints:
            self._compare(subscription, publisher, "publishes", "offers")

    def _check_publisher(self, publisher: rosgraph.Publisher, endpoints: list[Endpoint]) -> None:
        for endpoint in endpoints:
            if endpoint.listens:
                self._compare(publisher, endpoint, "expects", "asks for")
            else:
                self._report(f"{publisher.topic}: {endpoint.node} publishes it, too")

    def _compare(self, own: rosgraph.Subscription | rosgraph.Publisher, other: Endpoint, does: str, has: str) -> None:
        topic, expected = own.topic, self._port.type_name(own.interface)
        if other.type != expected:
            self._report(f"{topic}: {other.node} {does} {other.type}, not {expected}")
        elif other.incompatible:
            self._report(f"{topic}: {other.node} {has} a quality of service that does not fit: {other.incompatible}")

    def _report(self, text: str, report: Callable[[str], None] | None = None) -> None:
        if text not in self._reported:
            self._reported.add(text)
            (report or self._port.warn)(text)
