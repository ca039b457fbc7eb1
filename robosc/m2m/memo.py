"""Cache of transformations, valid while a model does not change."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_Made = TypeVar("_Made")

#: Results by key while `cache_transformations` is active, else None.
_made: ContextVar[dict[object, Any] | None] = ContextVar("made", default=None)


@contextmanager
def cache_transformations() -> Iterator[None]:
    """Cache the results of `once`, so that each model is transformed once.

    Models must not change in this context. A nested context shares the cache of the outer one.
    """
    known = _made.get()
    before = _made.set({} if known is None else known)
    try:
        yield
    finally:
        _made.reset(before)


def once(key: object, make: Callable[[], _Made]) -> _Made:
    """Return the result of `make()`. Within `cache_transformations`, return the cached result of an equal `key`."""
    known = _made.get()
    if known is None:
        return make()
    if key not in known:
        known[key] = make()
    found: _Made = known[key]
    return found
