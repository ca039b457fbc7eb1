"""When an event can happen: where its plants have an edge for it, and the supervisor allows it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePath
from typing import TYPE_CHECKING

from robosc.m2t.c.nodes import All, Node, Not, Some
from robosc.metamodel import sct

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from robosc.m2t.c.expressions import CPrinter
    from robosc.metamodel import expression as ex

#: The edges of one event in one plant, by the location they start from.
Edges = Mapping[sct.Location, sct.Edge]


class Everywhere(Mapping[sct.Location, sct.Edge]):
    """The one edge that an event has in every location of a plant."""

    def __init__(self, plant: sct.Plant, edge: sct.Edge) -> None:
        self.plant = plant
        self.edge = edge

    def __getitem__(self, location: sct.Location) -> sct.Edge:
        """The edge."""
        return self.edge

    def __iter__(self) -> Iterator[sct.Location]:
        """All locations."""
        return iter(self.plant.locations)

    def __len__(self) -> int:
        """How many locations there are."""
        return len(self.plant.locations)


class EventTable:
    """The edges of each event, plant by plant in the order of the model, and what the supervisor asks."""

    def __init__(self, model: sct.SupervisoryControlModel) -> None:
        self.edges: dict[sct.Event, dict[sct.Plant, Edges]] = {
            event: {} for plant in model.plants for event in plant.events
        }
        for plant in model.plants:
            own: dict[sct.Event, dict[sct.Location, sct.Edge]] = {}
            for location in plant.locations:
                for edge in location.edges:
                    own.setdefault(edge.event, {})[location] = edge
            for event, edges in own.items():
                self.edges[event][plant] = edges
            for edge in plant.edges:
                self.edges[edge.event][plant] = Everywhere(plant, edge)
        assert model.supervisor is not None
        self._guards = {guard.event: guard for guard in model.supervisor.guards}
        self._requirements: dict[sct.Event, list[sct.Requirement]] = {}
        for requirement in model.requirements:
            self._requirements.setdefault(requirement.event, []).append(requirement)

    def words(self, event: sct.Event) -> list[str]:
        """What the requirements on an event say, each with its file, and why synthesis restricts it.

        Where in the file it stands is left out: what does not change the robot does not change its code.
        """
        words = [f"{each.text}{_file(each)}" for each in self._requirements.get(event, ()) if each.text]
        why = self._guards[event].explanation if event in self._guards else None
        return [*words, f"synthesis prevents this: {why}"] if why else words

    def possible(self, event: sct.Event, printer: CPrinter) -> All:
        """Where all plants of the event can take part in it."""
        return All([_possible(plant, edges, printer) for plant, edges in self.edges[event].items()])

    def required(self, event: sct.Event) -> All:
        """What the requirements ask."""
        return All(_given(self._guards[event].requirement) if event in self._guards else [])

    def added(self, event: sct.Event) -> All:
        """What synthesis added."""
        return All(_given(self._guards[event].synthesis) if event in self._guards else [])

    def stays(self, event: sct.Event, plant: sct.Plant) -> Node:
        """Where the event would leave a plant, which takes part in it, in its location."""
        edges = self.edges[event].get(plant, {})
        if isinstance(edges, Everywhere) and len(edges) > 1:
            return sct.LocationReference(location=edges.edge.target)
        loops = [location for location, edge in edges.items() if edge.target is location]
        return within(loops, plant.locations)


def within(locations: Collection[sct.Location], possible: Sequence[sct.Location]) -> Node:
    """That a plant is in one of the locations, given that it is in a possible one, said the shorter way.

    All of these are possible, and each once.
    """
    if 2 * len(locations) <= len(possible):
        return Some([sct.LocationReference(location=each) for each in locations])
    chosen = set(locations)
    return All([Not(sct.LocationReference(location=each)) for each in possible if each not in chosen])


def _possible(plant: sct.Plant, edges: Edges, printer: CPrinter) -> Node:
    if isinstance(edges, Everywhere):
        return All(_given(edges.edge.guard))
    by_guard: dict[str, tuple[list[Node], list[sct.Location]]] = {}
    for location, edge in edges.items():
        guard = All(_given(edge.guard))
        by_guard.setdefault(printer(guard), ([guard], []))[1].append(location)
    return Some([All([within(locations, plant.locations), *guard]) for guard, locations in by_guard.values()])


def _file(requirement: sct.Requirement) -> str:
    file = requirement.source.file if requirement.source else None
    return f" ({PurePath(file.name).name})" if file else ""


def _given(expression: ex.Expression | None) -> list[Node]:
    return [] if expression is None else [expression]
