"""Which edges leave a location of a plant."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.metamodel import sct


def edges_from(location: sct.Location) -> list[sct.Edge]:
    """Its own edges, then those that every location of its plant has."""
    return [*location.edges, *location.eContainer().edges]


def edges_of(plant: sct.Plant) -> list[sct.Edge]:
    """All edges of a plant, each once."""
    return [*(edge for location in plant.locations for edge in location.edges), *plant.edges]
