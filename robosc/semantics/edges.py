"""The edges of a location, of a plant, of an event."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import sct

if TYPE_CHECKING:
    from collections.abc import Iterable


def edges_from(location: sct.Location, event: sct.Event | None = None) -> list[sct.Edge]:
    """The edges that leave a location, then those that leave each location of its plant; `event` selects by event."""
    edges = [*location.edges, *location.eContainer().edges]
    return edges if event is None else [edge for edge in edges if edge.event is event]


def edges_of(plant: sct.Plant, event: sct.Event | None = None) -> list[sct.Edge]:
    """All edges of a plant, each once; `event` selects by event."""
    edges = [*(edge for location in plant.locations for edge in location.edges), *plant.edges]
    return edges if event is None else [edge for edge in edges if edge.event is event]


def origin(edge: sct.Edge) -> sct.Location | None:
    """The location that an edge leaves; None where it leaves each of its plant's."""
    owner = edge.eContainer()
    return owner if isinstance(owner, sct.Location) else None


def edges_by_event(plants: Iterable[sct.Plant]) -> dict[sct.Event, dict[sct.Plant, list[sct.Edge]]]:
    """The edges of each event, plant by plant: only plants that have an edge for it take part in an event."""
    found: dict[sct.Event, dict[sct.Plant, list[sct.Edge]]] = {}
    for plant in plants:
        for edge in edges_of(plant):
            found.setdefault(edge.event, {}).setdefault(plant, []).append(edge)
    return found
