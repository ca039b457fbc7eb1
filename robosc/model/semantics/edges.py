"""Edges of a location, a plant or an event."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.model import sct

if TYPE_CHECKING:
    from collections.abc import Iterable


def edges_from(location: sct.Location, event: sct.Event | None = None) -> list[sct.Edge]:
    """Return the edges that leave a location, then the edges that leave every location of its plant.

    `event` limits the result to edges of this event.
    """
    edges = [*location.edges, *location.eContainer().edges]
    return edges if event is None else [edge for edge in edges if edge.event is event]


def edges_of(plant: sct.Plant, event: sct.Event | None = None) -> list[sct.Edge]:
    """Return all edges of a plant, each once. `event` limits the result to edges of this event."""
    edges = [*(edge for location in plant.locations for edge in location.edges), *plant.edges]
    return edges if event is None else [edge for edge in edges if edge.event is event]


def origin(edge: sct.Edge) -> sct.Location | None:
    """Return the location that an edge leaves. None if it leaves every location of its plant."""
    owner = edge.eContainer()
    return owner if isinstance(owner, sct.Location) else None


def edges_by_event(plants: Iterable[sct.Plant]) -> dict[sct.Event, dict[sct.Plant, list[sct.Edge]]]:
    """Return the edges of each event by plant. Only plants with an edge for an event take part in it."""
    by_event: dict[sct.Event, dict[sct.Plant, list[sct.Edge]]] = {}
    for plant in plants:
        for edge in edges_of(plant):
            by_event.setdefault(edge.event, {}).setdefault(plant, []).append(edge)
    return by_event
