"""How the control loop of a large robot knows whom to ask again after an event: who reads what it writes."""

from __future__ import annotations

import textwrap
from itertools import accumulate
from typing import TYPE_CHECKING, Any

from robosc.m2t.c.comments import comment_text
from robosc.m2t.c.nodes import All
from robosc.m2t.c.types import index_type
from robosc.roles import event_name, plant_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.m2t.c.context import Context
    from robosc.m2t.c.ranges import Cell
    from robosc.metamodel import sct


_WORD = 32
#: How many times its length the queue has places: the more, the fewer rounds begin with closing its gaps.
_GENEROUS = 3


class Watching:
    """What the engine keeps an eye on, by number: cancels, triggers, silent events, and the plants that choose data."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._written = {event: self._writes(event) for event in context.events}
        self._read: dict[Cell, list[int]] = {}
        for number, cells in enumerate(self._reads()):
            for cell in cells:
                self._read.setdefault(cell, []).append(number)

    def prepared(self) -> dict[str, Any]:
        """The values that the templates put in."""
        events, roles = self._context.events, self._context.roles
        queued = len(self._context.queued)
        watched, places = queued + len(roles.silent) + len(roles.data), _GENEROUS * queued
        words = -(-max(watched, places, len(events)) // _WORD)
        readers = {event: self._readers(event) for event in events}
        starts = accumulate(map(len, readers.values()), initial=0)
        return {
            "watched": watched,
            "after_queued": "QUEUED" if queued else "0U",
            "places": places,
            "queue_index": index_type(queued),
            "place_index": index_type(places),
            "moved_index": index_type(max((len(each.locations) for each in roles.data_plants.values()), default=0)),
            "ready": "ready_like(self, event)" if roles.cancels and roles.triggers else "&self->ready",
            "words": words,
            "summary": -(-words // _WORD),
            "watched_index": index_type(watched),
            "reader_index": index_type(sum(map(len, readers.values()))),
            "readers": [
                {"event": comment_text(event_name(event)), "numbers": ", ".join(map(str, numbers))}
                for event, numbers in readers.items()
                if numbers
            ],
            "first_reader": textwrap.fill(", ".join(map(str, starts)), 100, subsequent_indent="    "),
        }

    def _readers(self, event: sct.Event) -> list[int]:
        """The numbers of those that the event concerns, in ascending order."""
        return sorted({number for cell in self._written[event] for number in self._read.get(cell, ())})

    def _reads(self) -> Iterable[set[Cell]]:
        """What each of them depends on, by number."""
        roles = self._context.roles
        for event in (*self._context.queued, *roles.silent):
            sent = roles.data_plants.get(event)
            yield self._guard(event) | ({sent} if sent is not None else set())
        for events in roles.data:
            yield {plant_of(events[0])}.union(*map(self._guard, events))

    def _guard(self, event: sct.Event) -> set[Cell]:
        table, printer = self._context.table, self._context.printer
        condition = All([table.possible(event, printer), table.required(event), table.added(event)])
        return set(self._context.ranges.cells(condition))

    def _writes(self, event: sct.Event) -> set[Cell]:
        written: set[Cell] = set()
        for plant, edges in self._context.table.edges[event].items():
            for location, edge in edges.items():
                written |= {update.variable for update in edge.updates}
                if edge.target is not location:
                    written.add(plant)
        return written
