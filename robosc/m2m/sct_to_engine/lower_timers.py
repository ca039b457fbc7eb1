"""Pass: creates timers, with those that run from the start and the events that restart them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2m.sct_to_engine.alternatives import Alternatives
from robosc.m2m.sct_to_engine.build_expressions import build_expression
from robosc.model import engine, sct
from robosc.model.semantics.roles import plant_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.m2m.sct_to_engine.collect_events import Edges, EdgeTable
    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.m2m.sct_to_engine.terms import Term


def lower_timers(model: engine.EngineModel, edges: EdgeTable, lower: Lowering) -> None:
    """Create the timers of a model and set the restarts of each event."""
    located: dict[sct.Plant, dict[sct.Location, list[tuple[sct.Timer, engine.Timer]]]] = {}
    everywhere: dict[sct.Event, list[engine.Timer]] = {}
    listening: dict[sct.Event, dict[sct.Plant, None]] = {}
    for event in model.events:
        timed = event.event.timer
        if timed is None:
            continue
        initial = timed.location is None or timed.location.initial
        length = (timed.duration or timed).milliseconds
        timer = engine.Timer(event=event, milliseconds=length, location=timed.location, initial=initial)
        timer.duration = timed.duration
        model.timers.append(timer)
        if timed.location is not None:
            of_plant = located.setdefault(plant_of(event.event), {})
            of_plant.setdefault(timed.location, []).append((timed, timer))
            for message in timed.without:
                listening.setdefault(message, {})[plant_of(event.event)] = None
        else:
            for message in timed.without:
                everywhere.setdefault(message, []).append(timer)
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
    """Return the effect of an event on the timers of a plant's locations, by the location that it leaves.

    If no edge of the plant has the event (`taken` is None), the plant stays in its location.
    """
    if taken is None:
        return _staying(event, plant, timers, lower)
    cases: dict[tuple[bool, tuple[engine.Timer, ...]], list[sct.Edge]] = {}
    for location, leaving in taken.items():
        for edge in leaving:
            here = timers.get(edge.target, ())
            entering = edge.target is not location or any(edge in timed.entries for timed, _ in here)
            starts = tuple(timer for timed, timer in here if entering or event in timed.without)
            left = entering and location in timers
            if left or starts:
                cases.setdefault((left, starts), []).append(edge)
    restarts = []
    for (left, starts), edges in cases.items():
        restarts.append(_restart(Alternatives(plant, taken, lower).one_of(edges), plant if left else None, starts))
    return restarts


def _staying(
    event: sct.Event,
    plant: sct.Plant,
    timers: Mapping[sct.Location, Sequence[tuple[sct.Timer, engine.Timer]]],
    lower: Lowering,
) -> list[engine.Restart]:
    """Return the timers that an event restarts in a plant without an edge for it."""
    cases: dict[tuple[engine.Timer, ...], list[sct.Location]] = {}
    for location in plant.locations:
        starts = tuple(timer for timed, timer in timers.get(location, ()) if event in timed.without)
        if starts:
            cases.setdefault(starts, []).append(location)
    return [_restart(lower.within(plant, locations), None, starts) for starts, locations in cases.items()]


def _restart(condition: Term, left: sct.Plant | None, starts: Sequence[engine.Timer]) -> engine.Restart:
    holds = None if condition.constant == 1 else build_expression(condition)
    return engine.Restart(condition=holds, left=left, starts=starts)
