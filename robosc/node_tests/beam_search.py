"""A shorter tour: of many ways of the same length those that show the most are followed (Lowerre's beam search)."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from robosc.node_tests.steps import Place, Step

    #: Where a way has come to, and what it has shown.
    _End = tuple[Place, int]
    #: The last step of a way to each end, and the end of the way before it.
    _Layer = dict[_End, tuple[_End, Step]]

#: So many steps what is shown counts by itself.
_WORTH = 0.3


def beam_search(  # noqa: PLR0913 - what to search in, what for, and how long
    steps: Callable[[Place], list[Step] | None],
    start: Place,
    tour: Sequence[Step],
    wanted: int,
    *,
    longest: int,
    width: int,
) -> list[Step] | None:
    """A way of at most so many steps that shows all that is wanted, as a tour does; None where none is found.

    Of all ways of a length it goes on with the tour itself and the best others, `width` in all: whatever a way shows
    counts as many steps as the tour took for it. Of two ways to the same place that is only the one that shows more,
    where the other shows nothing else. `steps` gives those from a place, or None where the search is to end.
    """
    value = _Value(tour, wanted)
    layers: list[_Layer] = []
    followed = start, 0
    kept = [followed]
    for taken in tour[:longest]:
        layer: _Layer = {}
        for here, shown in kept:
            found = steps(here)
            if found is None:
                return None
            for step in found:
                layer.setdefault((step.end, shown | step.shows & wanted), ((here, shown), step))
        layers.append(layer)
        end = next((end for end in layer if end[1] == wanted), None)
        if end is not None:
            return _way_to(end, layers)
        followed = taken.end, followed[1] | taken.shows & wanted
        kept = _best(followed, sorted(layer, key=lambda end: -value(end[1])), width)
    return None


class _Value:
    """How many steps that what is shown is worth."""

    def __init__(self, tour: Iterable[Step], wanted: int) -> None:
        self._worth: dict[int, float] = {}
        self._known: dict[int, float] = {}
        shown = taken = 0
        for step in tour:
            taken += 1
            found = list(_bits(step.shows & wanted & ~shown))
            if found:
                # What is shown together shares the steps that the tour took for it.
                self._worth |= dict.fromkeys(found, _WORTH + taken / len(found))
                shown |= step.shows
                taken = 0

    def __call__(self, shown: int) -> float:
        if shown not in self._known:
            self._known[shown] = sum(self._worth[bit] for bit in _bits(shown))
        return self._known[shown]


def _best(followed: _End, ends: Iterable[_End], width: int) -> list[_End]:
    kept, shown_at = [followed], defaultdict["Place", list[int]](list)
    for place, shown in ends:
        if len(kept) < width and all(shown & ~other for other in shown_at[place]):
            shown_at[place].append(shown)
            kept.append((place, shown))
    return kept


def _way_to(end: _End, layers: Sequence[_Layer]) -> list[Step]:
    way = []
    for layer in reversed(layers):
        end, step = layer[end]
        way.append(step)
    return way[::-1]


def _bits(mask: int) -> Iterator[int]:
    while mask:
        lowest = mask & -mask
        yield lowest
        mask ^= lowest
