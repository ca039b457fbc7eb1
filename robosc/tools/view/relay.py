"""Passes messages from the threads of a middleware to the thread that serves the page."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from robosc.tools.view.live import Live


class Relay:
    """Listener for a live view; created in the thread of the event loop, and called from any thread."""

    def __init__(self, live: Live) -> None:
        self._live = live
        self._loop = asyncio.get_running_loop()
        self._tasks: set[asyncio.Task[None]] = set()

    def receive_definition(self, text: str) -> None:
        """Pass on a text from `~/definition`."""
        self._call(lambda: self._live.receive_definition(text))

    def receive_report(self, text: str) -> None:
        """Pass on a text from `~/state`."""
        self._call(lambda: self._live.receive_report(text))

    def heard(self, publishers: int) -> None:
        """Pass on the number of nodes that publish their states."""
        self._call(lambda: self._live.heard(publishers))

    def _call(self, take: Callable[[], None]) -> None:
        def here() -> None:
            take()
            if not self._tasks:
                task = self._loop.create_task(self._live.tell())
                self._tasks.add(task)
                task.add_done_callback(self._tasks.discard)

        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(here)
