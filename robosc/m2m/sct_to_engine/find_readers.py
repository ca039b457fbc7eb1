"""Pass: finds the events that read a variable that an event writes, for an incremental control loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import engine, sct

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from robosc.m2m.sct_to_engine.combine_guards import GuardTerms
    from robosc.m2m.sct_to_engine.merge_effects import EffectTerms
    from robosc.m2m.sct_to_engine.share_conditions import SharedTerms

_QUERIED_ROLES = (engine.Role.cancel, engine.Role.trigger, engine.Role.silent)


def find_readers(
    model: engine.EngineModel,
    guards: Mapping[sct.Event, GuardTerms],
    effects: Mapping[sct.Event, EffectTerms],
    shared: SharedTerms,
) -> None:
    """Set the readers of each event, and of each condition that is a whole conjunct of a guard."""
    readers_of_cell: dict[object, list[engine.Reader]] = {}

    def note(reader: engine.Reader, cells: Iterable[object]) -> None:
        for cell in dict.fromkeys(cells):
            readers_of_cell.setdefault(cell, []).append(reader)

    for event in model.events:
        if event.role in _QUERIED_ROLES:
            chosen = event.choice.variable if event.choice else None
            note(event, [*([] if chosen is None else [chosen]), *_read(guards[event.event], shared)])
    for choice in model.choices:
        cells = [cell for alternative in choice.alternatives for cell in _read(guards[alternative.event.event], shared)]
        note(choice, [*([] if choice.variable is None else [choice.variable]), *cells])
    watched = [(term, condition) for term, condition in shared.conditions.items() if condition in readers_of_cell]
    for term, condition in watched:
        note(condition, term.reads())
    number = {reader: position for position, reader in enumerate((*model.events, *model.choices, *model.conditions))}

    def readers(cells: Iterable[object]) -> list[engine.Reader]:
        return sorted({reader for cell in cells for reader in readers_of_cell.get(cell, ())}, key=number.__getitem__)

    for event in model.events:
        event.readers.extend(readers({variable for step in effects[event.event].steps for variable in step.writes()}))
    for _, condition in watched:
        condition.readers.extend(readers([condition]))


def _read(guard: GuardTerms, shared: SharedTerms) -> list[object]:
    """Return the cells that a guard reads: its shared conditions, and locations and variables for the rest."""
    cells: list[object] = []
    for term in shared.ask_for(guard):
        cells += [shared.conditions[term]] if term in shared.conditions else term.reads()
    return cells
