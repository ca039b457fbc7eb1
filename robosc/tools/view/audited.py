"""Moments of an audited recording: the events that changed the state, and the findings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.run.audit.as_text import describe
from robosc.tools.view.live import CAPACITY
from robosc.tools.view.moments import Moments

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robosc.engine import Engine
    from robosc.engine.timers import Timers
    from robosc.model import rosgraph
    from robosc.run.audit import Audit, Finding
    from robosc.run.simulation import Simulation


class Audited(Moments):
    """Moments of an audit. Call `begin` with its engine before it runs; `note` is its `watch`.

    Events that change nothing are left out: a recording of an hour has very many of them. Beyond `most` moments, only
    findings are added, up to twice as many moments.
    """

    def __init__(self, simulation: Simulation, graph: rosgraph.RosGraph | None, most: int = CAPACITY) -> None:
        super().__init__(simulation, graph)
        self._limit = most
        self._audit: Audit | None = None
        self._audited: Engine | None = None
        self._timers: Timers | None = None
        self._cells: tuple[int, ...] = ()

    def begin(self, audit: Audit, audited: Engine, timers: Timers | None = None) -> None:
        """Follow an audit with its engine and its timers."""
        self._audit, self._audited, self._timers = audit, audited, timers

    def finish(self) -> None:
        """Add the start if nothing happened."""
        if not self.moments:
            self._follow({})

    def note(self, event: str, finding: Finding | None) -> None:
        """Add an event that has happened, or a finding."""
        assert self._audit is not None
        assert self._audited is not None
        if not self.moments:
            self._add(0.0, {}, {}, (), self._kept_last)
        if len(self.moments) >= (self._limit if finding is None else 2 * self._limit):
            self.status = f"After {self.moments[-1]['time']} s, the page leaves out events: `robosc audit` lists all."
        elif finding is not None:
            words = self.describe_event(event) if event in self.events else event
            entries = {"event": event, "words": words, "data": {}, "by": finding.reason, "reason": describe(finding)}
            self._follow(entries)
        elif self._audited.saved[0] != self._cells:
            self._follow({"event": event, "words": self.describe_event(event), "data": {}})

    def _follow(self, entries: Mapping[str, Any]) -> None:
        """Add a moment with the state of the audit."""
        assert self._audit is not None
        assert self._audited is not None
        self.engine.restore(self._audited.saved)
        self._cells = self._audited.saved[0]
        end = self._audit.end if self._audit.end is not None else self._audit.start
        running = {} if self._timers is None else self._timers.running
        time = 0.0 if end is None else round(self._audit.seconds(end), 3)
        self._add(time, running, entries, (), self._kept_last)
