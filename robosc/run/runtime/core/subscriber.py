"""Interface between the middleware and subscribers to a node's reports."""

from __future__ import annotations

from typing import Protocol

#: Seconds between two counts of publishers.
LOOK = 0.5
#: Queue depth for reports.
WAITING = 1000


class Listener(Protocol):
    """Callbacks for the reports of nodes, called from a thread of the middleware."""

    def receive_definition(self, text: str) -> None:
        """Receive the JSON text of a definition on `~/definition`."""

    def receive_report(self, text: str) -> None:
        """Receive the JSON text of one report on `~/state`."""

    def heard(self, publishers: int) -> None:
        """Receive the number of nodes that publish their state, at regular intervals."""


class ReportSubscriber(Protocol):
    """Subscription to reports, until it is closed."""

    def close(self) -> None:
        """End the subscription."""
