"""Notices topics that have fallen silent."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.runtime.core.agenda import Agenda


class Watchdog:
    """One topic that should speak. `silent`: it has not for so many seconds; `speaks`: it does again."""

    def __init__(self, agenda: Agenda, seconds: float, silent: Callable[[], None], speaks: Callable[[], None]) -> None:
        self._agenda = agenda
        self._seconds = seconds
        self._silent = silent
        self._speaks = speaks
        self._heard = agenda.clock()
        self.tripped = False
        agenda.after(seconds, self._look)

    def hear(self) -> None:
        """The topic speaks."""
        self._heard = self._agenda.clock()
        if self.tripped:
            self.tripped = False
            self._agenda.after(self._seconds, self._look)
            self._speaks()

    def _look(self) -> None:
        left = self._heard + self._seconds - self._agenda.clock()
        if left > 0:
            self._agenda.after(left, self._look)
        else:
            self.tripped = True
            self._silent()
