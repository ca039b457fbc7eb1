"""Pass: one guard an event, of what the plants, the requirements and synthesis ask."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.m2m.sct_to_engine.alternatives import left_open
from robosc.metamodel import engine, sct
from robosc.metamodel import expression as ex
from robosc.metamodel.places import place
from robosc.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.m2m.sct_to_engine.collect_events import Edges, EdgeTable
    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.m2m.sct_to_engine.terms import Term


@dataclass(frozen=True, eq=False)
class GuardTerms:
    """When an event can happen: the three parts, each by itself, and their conjunction.

    `by_plant` says of each plant that has the event where it has an edge for it; `plants` is their conjunction.
    """

    by_plant: Mapping[sct.Plant, Term]
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
    model: sct.SupervisoryControlModel, edges: EdgeTable, lower: Lowering
) -> dict[sct.Event, GuardTerms]:
    """The guard of each event: every plant that has it has an edge for it, and the supervisor's two parts hold."""
    assert model.supervisor is not None
    supervised = {guard.event: guard for guard in model.supervisor.guards}
    combined = {}
    for event, by_plant in edges.items():
        guard = supervised.get(event)
        possible = {plant: _possible(plant, taken, lower) for plant, taken in by_plant.items()}
        parts = (
            lower.terms.junction(engine.And, possible.values()),
            lower(guard.requirement if guard else None),
            lower(guard.synthesis if guard else None),
        )
        combined[event] = GuardTerms(possible, *parts, lower.terms.junction(engine.And, parts))
    return combined


def _possible(plant: sct.Plant, edges: Edges, lower: Lowering) -> Term:
    """That a plant has an edge for an event from where it is: locations with the same guard together."""
    if None in edges:
        return _one_of(edges[None], lower)
    return lower.where(plant, {location: _one_of(leaving, lower) for location, leaving in edges.items()})


def _one_of(edges: Sequence[sct.Edge], lower: Lowering) -> Term:
    """That a guard of these holds, of each what those before it leave open.

    Raises ModelError where it depends on the data of the event: that comes when the event is happening already.
    """
    # Each is lowered, also where nothing of it is needed: it may be what no sct model holds.
    guards = [lower(edge.guard) for edge in edges]
    if _all_covered(edges, lower):
        return lower.terms.true
    denied: set[Term] = set()
    whole = lower.terms.junction(engine.Or, [left_open(guard, denied, lower.terms) for guard in guards])
    if any(isinstance(read, engine.Input) for read in whole.reads()):
        name = event_name(edges[0].event)
        message = f"whether `{name}` can happen depends on its data, which a controller learns when it happens"
        hint = "leave it out of plant invariants, or add an edge for all other data"
        raise ModelError([Diagnostic(*place(edges[0]), Severity.ERROR, "cif-construct", message, hint)])
    return whole


def _all_covered(edges: Sequence[sct.Edge], lower: Lowering) -> bool:
    """Whether the last of these takes all that those before it leave, as `robosc_to_sct` makes them.

    Each has the negations of the conditions before it, then its own condition; the last has only the negations. That
    needs nothing to be known of the conditions, which may be on several variables and data.
    """
    denied = {lower.terms.true}
    for edge in edges:
        if denied.issuperset(map(lower, _conjuncts(edge.guard))):
            return True
        own = edge.guard
        if isinstance(own, ex.Conjunction) and denied.issuperset(map(lower, _conjuncts(own.left))):
            own = own.right
        denied.add(lower(own, positive=False))
    return False


def _conjuncts(condition: ex.Expression | None) -> list[ex.Expression | None]:
    """The parts of a conjunction of conjunctions, the last first; those on the right of one are whole."""
    found = []
    while isinstance(condition, ex.Conjunction):
        found.append(condition.right)
        condition = condition.left
    return [*found, condition]
