"""Cache of transformations, valid while a model does not change."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_Result = TypeVar("_Result")

#: Results by key while `cache_transformations` is active, else None.
_cache: ContextVar[dict[object, Any] | None] = ContextVar("made", default=None)


@contextmanager
def cache_transformations() -> Iterator[None]:
    """Cache the results of `once`, so that each model is transformed once.

    Models must not change in this context. A nested context shares the cache of the outer one.
    """
    known = _cache.get()
    before = _cache.set({} if known is None else known)
    try:
        yield
    finally:
        _cache.reset(before)


def once(key: object, make: Callable[[], _Result]) -> _Result:
    """Return the result of `make()`. Within `cache_transformations`, return the cached result of an equal `key`."""
    known = _cache.get()
    if known is None:
        return make()
    if key not in known:
        known[key] = make()
    result: _Result = known[key]
    return result
