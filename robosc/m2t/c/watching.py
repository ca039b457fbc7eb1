"""How the control loop of a large robot knows whom to ask again after an event: who reads what it writes."""

from __future__ import annotations

import textwrap
from itertools import accumulate, islice
from typing import TYPE_CHECKING, Any

from robosc.m2t.c.comments import comment_text
from robosc.m2t.c.guards import Everywhere
from robosc.m2t.c.sharing import Condition
from robosc.m2t.c.types import unsigned_type
from robosc.semantics.roles import event_name, plant_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.m2t.c.context import Context
    from robosc.m2t.c.ranges import Cell
    from robosc.m2t.c.sharing import Shared
    from robosc.metamodel import sct


_WORD = 32
#: How many times its length the queue has places: the more, the fewer rounds begin with closing its gaps.
_GENEROUS = 3
#: How many events the engine remembers before it looks up whom they concern. A message rarely means more.
_BEHIND = 8


class Watching:
    """What the engine keeps an eye on, by number.

    These are the cancels, triggers, silent events, the plants that choose data, and conditions that their guards share.
    """

    def __init__(self, context: Context, shared: Shared) -> None:
        self._context = context
        self._shared = shared
        self._read: dict[Cell | Condition, list[int]] = {}
        self._count = 0
        for cells in self._reads():
            self._note(cells)
        self._conditions = [each for each in shared.conditions if each in self._read]
        for each in self._conditions:
            self._note(context.ranges.cells(each.node))

    def _note(self, cells: Iterable[Cell | Condition]) -> None:
        for cell in cells:
            self._read.setdefault(cell, []).append(self._count)
        self._count += 1

    def prepared(self) -> dict[str, Any]:
        """The values that the templates put in."""
        events, roles = self._context.events, self._context.roles
        queued = len(self._context.queued)
        watched, places = queued + len(roles.silent) + len(roles.data), _GENEROUS * queued
        words = -(-max(self._count, places, len(events)) // _WORD)
        readers = [(event_name(event), self._readers(self._writes(event))) for event in events]
        readers += [(each.name, self._readers([each])) for each in self._conditions]
        starts = accumulate((len(numbers) for _, numbers in readers), initial=0)
        return {
            "watched": watched,
            "behind": _BEHIND,
            "after_queued": "QUEUED" if queued else "0U",
            "places": places,
            "queue_index": unsigned_type(queued),
            "place_index": unsigned_type(places),
            "moved_index": unsigned_type(max((len(each.locations) for each in roles.data_plants.values()), default=0)),
            "ready": "ready_like(self, event)" if roles.cancels and roles.triggers else "&self->ready",
            "words": words,
            "summary": -(-words // _WORD),
            "watched_conditions": [each.call for each in self._conditions],
            "watched_index": unsigned_type(self._count),
            "reader_index": unsigned_type(sum(len(numbers) for _, numbers in readers)),
            "readers": [
                {"of": comment_text(name), "numbers": ", ".join(map(str, numbers))}
                for name, numbers in readers
                if numbers
            ],
            "first_reader": textwrap.fill(", ".join(map(str, starts)), 100, subsequent_indent="    "),
        }

    def _readers(self, cells: Iterable[Cell | Condition]) -> list[int]:
        """The numbers of those that read any of these, in ascending order."""
        return sorted({number for cell in cells for number in self._read.get(cell, ())})

    def _reads(self) -> Iterable[set[Cell | Condition]]:
        """What each of them depends on, by number."""
        roles = self._context.roles
        for event in (*self._context.queued, *roles.silent):
            sent = roles.data_plants.get(event)
            yield self._guard(event).union([] if sent is None else [sent])
        for events in roles.data:
            yield set().union([plant_of(events[0])], *map(self._guard, events))

    def _guard(self, event: sct.Event) -> set[Cell | Condition]:
        """What the guard of an event reads: conditions that it shares, and for the rest locations and variables."""
        parts = self._shared.parts(self._context.guard(event))
        return {
            each
            for part in parts
            for each in ([part] if isinstance(part, Condition) else self._context.ranges.cells(part))
        }

    def _writes(self, event: sct.Event) -> set[Cell]:
        written: set[Cell] = set()
        for plant, edges in self._context.table.edges[event].items():
            # What is the same in every location is seen in the first two.
            for location, edge in islice(edges.items(), 2 if isinstance(edges, Everywhere) else None):
                written |= {update.variable for update in edge.updates}
                if edge.target is not location:
                    written.add(plant)
        return written
