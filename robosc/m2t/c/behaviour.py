"""What the source computes: the condition of each event, what it changes, and the tables of the control loop."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robosc.m2t.c.comments import comment
from robosc.m2t.c.effects import Effects
from robosc.m2t.c.nodes import All
from robosc.m2t.c.sharing import Shared
from robosc.m2t.c.types import unsigned_type
from robosc.m2t.c.watching import Watching
from robosc.semantics.roles import event_name, plant_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.m2t.c.context import Context
    from robosc.metamodel import sct

_INDENT = 4
#: Of how many events a comment on what their guards share gives the names.
_NAMED = 3
#: A robot of so many events is asked for all of them whenever something happened: to keep an eye on who is concerned
#: costs more. Measured, see docs/engine.md.
SMALL = 64


@dataclass(frozen=True)
class _Case:
    """A part of a `switch`: its events, a comment on them, its lines, and whether they read a copy of the state."""

    events: list[str]
    comment: str
    lines: list[str]
    old: bool = False


def _merged(cases: Iterable[_Case]) -> list[_Case]:
    """Neighbours with the same lines as one, where the second has no comment."""
    merged: list[_Case] = []
    for case in cases:
        if merged and merged[-1].lines == case.lines and not case.comment:
            merged[-1].events.extend(case.events)
        else:
            merged.append(case)
    return merged


def _of(events: list[sct.Event]) -> str:
    named = [event_name(each) for each in events[:_NAMED]]
    more = len(events) - len(named)
    return f"In the guards of {', '.join(named)}{f' and {more} more' if more else ''}."


class Behaviour:
    """Prepares conditions, changes and tables for the templates."""

    def __init__(self, context: Context) -> None:
        self._context = context
        roles = context.roles
        self._watching = bool(context.queued or roles.silent or roles.data) and len(context.events) > SMALL
        self._shared = Shared(context, watched=self._watching)

    def prepared(self) -> dict[str, Any]:
        """The values that the templates put in."""
        effects = Effects(self._context.names, self._context.ranges)
        executed, guarded = self._effects(effects), self._guards()
        roles = self._context.roles
        arrived = [self._arrived(event) for event in self._context.data]
        return {
            "watching": self._watching,
            **(Watching(self._context, self._shared).prepared() if self._watching else {}),
            "index": unsigned_type(len(self._context.events)),
            "cancels": len(roles.cancels),
            "triggers": len(roles.triggers),
            "queued": len(self._context.queued),
            "silent": len(roles.silent),
            "own": " + ".join(["QUEUED"] * bool(self._context.queued) + ["SILENT"] * bool(roles.silent)),
            "bound": roles.settling_bound,
            "data": self._data_starts(),
            "settles": bool(roles.silent or roles.data),
            "topics": len(roles.shared_topics),
            "groups": len(roles.shared_topics) + len(roles.once_per_tick),
            "group_of": self._group_of(),
            "incoming": len(self._context.events) - len(roles.incoming),
            "sources": len(roles.sources) + 1,
            "source_index": unsigned_type(len(roles.sources) + 1),
            "source_of": self._source_of(),
            "conditions": [
                {"name": each.name, "comment": comment([_of(each.events)]), "text": self._shared.body(each)}
                for each in self._shared.conditions
            ],
            "guards": guarded,
            "guards_read_state": any(re.search(r"\bstate\b", line) for each in guarded for line in each.lines),
            "effects": executed,
            "effects_read_inputs": any("inputs->" in line for each in executed for line in each.lines),
            "helpers": sorted(effects.helpers),
            "arrived": [each for each in arrived if each is not None],
            "moved": self._moved(),
        }

    def _guards(self) -> list[_Case]:
        """The conditions of the events, but of those that nothing forbids and that there is nothing to tell about."""
        cases = []
        for event in self._context.events:
            unforced = All(
                [self._context.table.possible(event, self._context.printer), self._context.table.required(event)]
            )
            added = self._context.table.added(event)
            told = self._context.table.words(event)
            guard = self._context.guard(event)
            if told or self._context.ranges(guard).single != 1:
                lines = self._lines(guard, unforced, added)
                cases.append(_Case([self._context.names.enumerator(event)], comment(told, _INDENT), lines))
        if not self._context.events:
            cases.append(_Case([f"{self._context.names.prefix}_nothing"], "", ["false"]))
        return _merged(cases)

    def _lines(self, guard: All, unforced: All, added: All) -> list[str]:
        """A guard, one part a line, with what synthesis added to the rest."""
        operator, terms = self._shared.shown(guard)
        plain, by_synthesis = (
            {text for texts, _ in self._shared.shown(each)[1] for text in texts} for each in (unforced, added)
        )
        told = by_synthesis - plain if operator == "&&" else set()
        marked = [
            text if not texts & told else f"{text} /* {'' if texts <= told else 'partly '}added by synthesis */"
            for texts, text in terms
        ]
        return [marked[0], *(f"{operator} {each}" for each in marked[1:])]

    def _effects(self, effects: Effects) -> list[_Case]:
        """The statements of the events that change something."""
        cases = []
        for event in self._context.events:
            lines, old = effects.statements(self._context.table.edges[event])
            if lines:
                cases.append(_Case([self._context.names.enumerator(event)], "", lines, old))
        return _merged(cases)

    def _data_starts(self) -> list[str]:
        """The first event of each data plant, and the one behind the last."""
        if not self._context.data:
            return []
        start = len(self._context.queued) + len(self._context.roles.silent)
        return [self._context.names.enumerator(events[0]) for events in self._context.roles.data] + [
            f"{start + len(self._context.data)}"
        ]

    def _arrived(self, event: sct.Event) -> dict[str, str] | None:
        stays = self._context.table.stays(event, plant_of(event))
        if self._context.ranges(stays).single == 0:
            return None
        return {"event": self._context.names.enumerator(event), "condition": self._context.printer(stays)}

    def _moved(self) -> list[dict[str, str]]:
        """The triggers whose data a plant with several locations chooses."""
        return [
            {"event": self._context.names.enumerator(trigger), "member": self._context.names.member(plant)}
            for trigger, plant in self._context.roles.data_plants.items()
            if plant in self._context.located
        ]

    def _source_of(self) -> list[int]:
        """For each event from the robot the number of what it comes from."""
        numbers = {event: number for number, events in enumerate(self._context.roles.sources, 1) for event in events}
        return [numbers[event] for event in self._context.roles.incoming]

    def _group_of(self) -> list[int]:
        """For each cancel and trigger: 0, or the number of those of which one runs only."""
        groups = dict.fromkeys(self._context.queued, 0)
        for number_, events in enumerate(
            [*self._context.roles.shared_topics, *((each,) for each in self._context.roles.once_per_tick)], 1
        ):
            groups.update(dict.fromkeys(events, number_))
        return list(groups.values())
