"""What listens to a node's reports needs of the middleware."""

from __future__ import annotations

from typing import Protocol

#: Seconds between two looks at who is there.
LOOK = 0.5
#: So many reports wait to be heard.
WAITING = 1000


class Listener(Protocol):
    """What is called, from a thread of the middleware's, with what nodes tell."""

    def defined(self, text: str) -> None:
        """Receives the JSON text of a definition on `~/definition`."""

    def told(self, text: str) -> None:
        """Receives the JSON text of one report on `~/state`."""

    def heard(self, publishers: int) -> None:
        """Receives the number of nodes that publish their state; called every now and then."""


class ReportSubscriber(Protocol):
    """What listens, until it is closed."""

    def close(self) -> None:
        """Nothing is heard any more."""
