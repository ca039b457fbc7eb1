"""Which requirement, left out, would let something happen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.explanation.answers import Loosening

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from robosc.analysis.explanation.space import Space
    from robosc.metamodel import sct

#: How many requirements are tried: each takes as long as a synthesis.
_TRIED = 24


def loosenings(
    space: Space, helps: Callable[[Space], bool], first: Iterable[sct.Requirement] = ()
) -> tuple[Loosening, ...] | None:
    """The requirements of the text each of which helps if it alone is left out, those of `first` before the others.

    None where it does not even help to leave out all of them.
    """
    texts = requirement_texts(space, first)
    if not helps(space.without(frozenset(each for text in texts for each in text))):
        return None
    found = []
    for text in texts[:_TRIED]:
        other = space.without(frozenset(text))
        if helps(other):
            found.append(Loosening(text, space.encoding.count(other.controlled)))
    return tuple(found)


def requirement_texts(space: Space, first: Iterable[sct.Requirement] = ()) -> list[tuple[sct.Requirement, ...]]:
    """The requirements by the place in the text that they come from; not those that say when an action is cancelled."""
    own = [each for each in space.model.requirements if space.start_of(each.event) is None]
    by_place: dict[object, list[sct.Requirement]] = {}
    for each in dict.fromkeys([*(each for each in first if each in own), *own]):
        by_place.setdefault(each.source or each, []).append(each)
    return [tuple(each) for each in by_place.values()]
