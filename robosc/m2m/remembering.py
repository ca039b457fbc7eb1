"""Results of transformations that are made once while a model does not change."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_Made = TypeVar("_Made")

#: While `remembered` lasts, what was made, by its key.
_made: ContextVar[dict[object, Any] | None] = ContextVar("made", default=None)


@contextmanager
def remembered() -> Iterator[None]:
    """A context in which `once` keeps its results, so that each model is transformed once.

    Models must not change meanwhile. Within another context it is that one.
    """
    known = _made.get()
    before = _made.set({} if known is None else known)
    try:
        yield
    finally:
        _made.reset(before)


def once(key: object, make: Callable[[], _Made]) -> _Made:
    """The result of `make()`; within `remembered`, that of the first call with an equal `key`."""
    known = _made.get()
    if known is None:
        return make()
    if key not in known:
        known[key] = make()
    found: _Made = known[key]
    return found
