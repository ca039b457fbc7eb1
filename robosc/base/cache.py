"""Cache of results, valid while no model changes."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_Result = TypeVar("_Result")

#: Results by key while `cache_results` is active, else None.
_cache: ContextVar[dict[object, Any] | None] = ContextVar("_cache", default=None)


@contextmanager
def cache_results() -> Iterator[None]:
    """Cache the results of `cached`, so that each is computed once.

    Models must not change in this context. A nested context shares the cache of the outer one.
    """
    known = _cache.get()
    before = _cache.set({} if known is None else known)
    try:
        yield
    finally:
        _cache.reset(before)


def cached(key: object, compute: Callable[[], _Result]) -> _Result:
    """Return the result of `compute()`. Within `cache_results`, return the cached result of an equal `key`."""
    known = _cache.get()
    if known is None:
        return compute()
    if key not in known:
        known[key] = compute()
    result: _Result = known[key]
    return result
