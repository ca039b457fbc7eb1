"""The edges of a location, of a plant, of an event."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robosc.metamodel import sct


def edges_from(location: sct.Location) -> list[sct.Edge]:
    """Its own edges, then those that every location of its plant has."""
    return [*location.edges, *location.eContainer().edges]


def edges_of(plant: sct.Plant) -> list[sct.Edge]:
    """All edges of a plant, each once."""
    return [*(edge for location in plant.locations for edge in location.edges), *plant.edges]


def edges_by_event(plants: Iterable[sct.Plant]) -> dict[sct.Event, dict[sct.Plant, list[sct.Edge]]]:
    """The edges of each event, plant by plant: only plants that have an edge for it take part in an event."""
    found: dict[sct.Event, dict[sct.Plant, list[sct.Edge]]] = {}
    for plant in plants:
        for edge in edges_of(plant):
            found.setdefault(edge.event, {}).setdefault(plant, []).append(edge)
    return found
