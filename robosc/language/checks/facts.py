"""Cache of values that rules compute from a robot or library, for one check."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, TypeVar

from robosc.model import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_Base = TypeVar("_Base", bound=rsc.Base)
_Fact = TypeVar("_Fact")

_FACTS: ContextVar[dict[tuple[Callable[..., Any], rsc.Base], Any]] = ContextVar("_FACTS")


@contextmanager
def keeping_facts() -> Iterator[None]:
    """Cache facts within the `with` block, in which no model may change."""
    token = _FACTS.set({})
    try:
        yield
    finally:
        _FACTS.reset(token)


def fact(find: Callable[[_Base], _Fact], base: _Base) -> _Fact:
    """Return `find(base)`, computed once for each check."""
    facts = _FACTS.get({})
    if (find, base) not in facts:
        facts[find, base] = find(base)
    value: _Fact = facts[find, base]
    return value
