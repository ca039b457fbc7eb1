"""Warnings that would come too often."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

_SECONDS = 5.0


class Throttle:
    """Passes on at most one warning in five seconds of each kind."""

    def __init__(self, warn: Callable[[str], None], clock: Callable[[], float]) -> None:
        self._warn = warn
        self._clock = clock
        self._last: dict[Hashable, float] = {}

    def __call__(self, kind: Hashable, text: str) -> None:
        """Warns, unless something of this kind was said too recently."""
        now = self._clock()
        if now - self._last.get(kind, -_SECONDS * 2) >= _SECONDS:
            self._last[kind] = now
            self._warn(text)
