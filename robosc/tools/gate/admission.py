"""Admission of calls: rates for each client, and one writer at a time."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

#: Clients whose rates are remembered.
_MOST_CLIENTS = 100


@dataclass(frozen=True)
class Limits:
    """Limits of a gate: calls per second of a tool and in total, bytes of data, and seconds of silence of a writer."""

    rate: float = 20.0
    total: float = 50.0
    largest: int = 65_536
    lease: float = 60.0


@dataclass
class _Bucket:
    """Calls that are left, refilled at a rate; at most those of one second, and at least one."""

    rate: float
    left: float
    filled: float

    def has_one(self, now: float) -> bool:
        """Refill, and return whether a call is left."""
        self.left = min(max(self.rate, 1.0), self.left + (now - self.filled) * self.rate)
        self.filled = now
        return self.left >= 1


@dataclass
class Rates:
    """Rates of calls, for each client by itself. A call beyond one of them does not count for the other."""

    limits: Limits
    clock: Callable[[], float]
    _clients: OrderedDict[str, dict[str | None, _Bucket]] = field(default_factory=OrderedDict)

    def admits(self, client: str, tool: str) -> bool:
        """Count a call of a client, and return whether it is within the rates."""
        now = self.clock()
        buckets = self._clients.setdefault(client, {})
        self._clients.move_to_end(client)
        if len(self._clients) > _MOST_CLIENTS:
            self._clients.popitem(last=False)
        both = [
            buckets.setdefault(key, _Bucket(rate, max(rate, 1.0), now))
            for key, rate in ((tool, self.limits.rate), (None, self.limits.total))
        ]
        admitted = [bucket.has_one(now) for bucket in both]  # each is refilled
        if not all(admitted):
            return False
        for bucket in both:
            bucket.left -= 1
        return True


@dataclass
class Writer:
    """The client that may send commands, from its first command until it leaves or is silent for too long."""

    limits: Limits
    clock: Callable[[], float]
    holder: str | None = None
    _last: float = 0.0

    def admits(self, client: str) -> bool:
        """Make a client the writer if there is none; return whether it is the writer."""
        if self.holder is None:
            self.holder = client
        self.note(client)
        return self.holder == client

    def note(self, client: str) -> None:
        """Note a sign of life of a client."""
        if self.holder == client:
            self._last = self.clock()

    @property
    def is_silent(self) -> bool:
        """Whether the writer has been silent for too long."""
        return self.holder is not None and self.clock() - self._last > self.limits.lease

    def leave(self, client: str) -> bool:
        """End the role of a client; return whether it was the writer."""
        was_writer = self.holder == client
        if was_writer:
            self.holder = None
        return was_writer
