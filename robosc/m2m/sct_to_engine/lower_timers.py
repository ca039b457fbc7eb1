"""Pass: which times run from the start, and which events start them anew."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2m.sct_to_engine.build_expressions import build_expression
from robosc.metamodel import engine, sct
from robosc.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.m2m.sct_to_engine.collect_events import Edges, EdgeTable
    from robosc.m2m.sct_to_engine.lower_expressions import Lowering


def lower_timers(model: engine.EngineModel, edges: EdgeTable, lower: Lowering) -> None:
    """Makes the timers of a model, and tells each event what it does with them."""
    located: dict[sct.Plant, dict[sct.Location, list[tuple[sct.Timer, engine.Timer]]]] = {}
    everywhere: dict[sct.Event, list[engine.Timer]] = {}
    listening: dict[sct.Event, dict[sct.Plant, None]] = {}
    for event in model.events:
        timed = event.event.timer
        if timed is None:
            continue
        initial = timed.location is None or timed.location.initial
        made = engine.Timer(event=event, milliseconds=timed.milliseconds, location=timed.location, initial=initial)
        model.timers.append(made)
        if timed.location is not None:
            of_plant = located.setdefault(plant_of(event.event), {})
            of_plant.setdefault(timed.location, []).append((timed, made))
            for message in timed.without:
                listening.setdefault(message, {})[plant_of(event.event)] = None
        else:
            for message in timed.without:
                everywhere.setdefault(message, []).append(made)
    for event in model.events if model.timers else ():
        taken = edges[event.event]
        for plant in dict.fromkeys([*taken, *listening.get(event.event, ())]):
            if plant in located:
                event.restarts.extend(_restarts(event.event, plant, taken.get(plant), located[plant], lower))
        if event.event in everywhere:
            event.restarts.append(engine.Restart(starts=everywhere[event.event]))


def _restarts(
    event: sct.Event,
    plant: sct.Plant,
    taken: Edges | None,
    timers: Mapping[sct.Location, Sequence[tuple[sct.Timer, engine.Timer]]],
    lower: Lowering,
) -> list[engine.Restart]:
    """What an event does with the timers of a plant's locations, by where it comes from.

    Where it is on no edge of the plant (`taken` is None), the plant stays where it is.
    """
    ways: dict[sct.Location | None, tuple[sct.Location, sct.Edge | None]]
    ways = {origin: (edge.target, edge) for origin, edge in taken.items()} if taken else _staying(plant)
    cases: dict[tuple[bool, tuple[engine.Timer, ...]], list[sct.Location | None]] = {}
    for origin, (target, edge) in ways.items():
        here = timers.get(target, ())
        entering = target is not origin or any(edge in timed.entries for timed, _ in here)
        starts = tuple(made for timed, made in here if entering or event in timed.without)
        leaving = entering and origin in timers
        if leaving or starts:
            cases.setdefault((leaving, starts), []).append(origin)
    found = []
    for (leaving, starts), origins in cases.items():
        condition = lower.within(plant, origins, list(ways))
        found.append(
            engine.Restart(
                condition=None if condition.constant == 1 else build_expression(condition),
                left=plant if leaving else None,
                starts=starts,
            )
        )
    return found


def _staying(plant: sct.Plant) -> dict[sct.Location | None, tuple[sct.Location, sct.Edge | None]]:
    return {location: (location, None) for location in plant.locations}
