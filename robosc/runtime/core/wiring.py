"""Reports, by name and once each, what is wrong with the topics of a node."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import rosgraph

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.runtime.core.agenda import Agenda
    from robosc.runtime.core.port import Endpoint, Port

_PERIOD = 1.0
_PATIENCE = 5


class Wiring:
    """Looks every second who else is on the node's topics.

    Reported are another type, a quality of service that does not fit, nobody who publishes for five seconds, and
    somebody who publishes beside the controller on a topic that it commands.
    """

    def __init__(self, port: Port, agenda: Agenda) -> None:
        self._port = port
        self._agenda = agenda
        self._looks = 0
        self._heard: set[str] = set()
        self._reported: set[str] = set()

    def start(self) -> None:
        """Looks from now on."""
        self._agenda.after(_PERIOD, self._look)

    def _look(self) -> None:
        self._looks += 1
        for element, endpoints in self._port.wiring().items():
            if isinstance(element, rosgraph.Subscription):
                self._listened(element, endpoints)
            else:
                self._commanded(element, endpoints)
        self.start()

    def _listened(self, subscription: rosgraph.Subscription, endpoints: list[Endpoint]) -> None:
        topic = subscription.topic
        if endpoints:
            self._heard.add(topic)
        elif topic not in self._heard and self._looks >= _PATIENCE:
            # It may tell what seldom happens, such as that a button was pressed.
            self._report(f"{topic}: nobody publishes it after {_PATIENCE} s", self._port.info)
        for each in endpoints:
            self._compare(subscription, each, "publishes", "offers")

    def _commanded(self, publisher: rosgraph.Publisher, endpoints: list[Endpoint]) -> None:
        for each in endpoints:
            if each.listens:
                self._compare(publisher, each, "expects", "asks for")
            else:
                self._report(f"{publisher.topic}: {each.node} publishes it, too")

    def _compare(self, own: rosgraph.Subscription | rosgraph.Publisher, other: Endpoint, does: str, has: str) -> None:
        topic, expected = own.topic, self._port.type_name(own.interface)
        if other.type != expected:
            self._report(f"{topic}: {other.node} {does} {other.type}, not {expected}")
        elif other.incompatible:
            self._report(f"{topic}: {other.node} {has} a quality of service that does not fit: {other.incompatible}")

    def _report(self, text: str, tell: Callable[[str], None] | None = None) -> None:
        if text not in self._reported:
            self._reported.add(text)
            (tell or self._port.warn)(text)
