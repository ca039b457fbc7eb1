"""Pass: one guard an event, of what the plants, the requirements and synthesis ask."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.metamodel import engine, sct

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from robosc.m2m.sct_to_engine.collect_events import Edges, EdgeTable
    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.m2m.sct_to_engine.terms import Term

#: Where the plants have their locations.
Variables = Mapping[sct.Plant | sct.DiscreteVariable, engine.StateVariable]


@dataclass(frozen=True, eq=False)
class GuardTerms:
    """When an event can happen: the three parts, each by itself, and their conjunction."""

    plants: Term
    requirement: Term
    synthesis: Term
    whole: Term

    @property
    def parts(self) -> list[tuple[engine.Origin, Term]]:
        """The parts with where they come from."""
        kinds = (engine.Origin.plants, engine.Origin.requirement, engine.Origin.synthesis)
        return list(zip(kinds, (self.plants, self.requirement, self.synthesis), strict=True))


def combine_guards(
    model: sct.SupervisoryControlModel, edges: EdgeTable, variables: Variables, lower: Lowering
) -> dict[sct.Event, GuardTerms]:
    """The guard of each event: every plant that has it has an edge for it, and the supervisor's two parts hold."""
    assert model.supervisor is not None
    supervised = {guard.event: guard for guard in model.supervisor.guards}
    combined = {}
    for event, by_plant in edges.items():
        guard = supervised.get(event)
        parts = (
            lower.terms.junction(
                engine.And, [_possible(plant, taken, variables, lower) for plant, taken in by_plant.items()]
            ),
            lower(guard.requirement if guard else None),
            lower(guard.synthesis if guard else None),
        )
        combined[event] = GuardTerms(*parts, lower.terms.junction(engine.And, parts))
    return combined


def _possible(plant: sct.Plant, edges: Edges, variables: Variables, lower: Lowering) -> Term:
    """That a plant has an edge for an event from where it is: locations with the same guard together."""
    if None in edges:
        return lower(edges[None].guard)
    by_guard: dict[Term, list[sct.Location | None]] = {}
    for location, edge in edges.items():
        by_guard.setdefault(lower(edge.guard), []).append(location)
    return lower.terms.junction(
        engine.Or,
        [
            lower.terms.junction(engine.And, [within(locations, plant.locations, variables.get(plant), lower), guard])
            for guard, locations in by_guard.items()
        ],
    )


def within(
    locations: Collection[sct.Location | None],
    possible: Sequence[sct.Location | None],
    variable: engine.StateVariable | None,
    lower: Lowering,
) -> Term:
    """That a plant is in one of the locations, given that it is in a possible one, said the shorter way.

    All of these are possible, and each once.
    """
    holds = 2 * len(locations) <= len(possible)
    chosen = set(locations)
    return lower.terms.junction(
        engine.Or if holds else engine.And,
        [lower.terms.at(variable, place, holds=holds) for place in possible if place and (place in chosen) is holds],
    )
