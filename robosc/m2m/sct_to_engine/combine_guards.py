"""Pass: combines the conditions of plants, requirements and synthesis to one guard for each event."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.m2m.sct_to_engine.alternatives import remaining_guard
from robosc.model import engine, sct
from robosc.model import expression as ex
from robosc.model.places import place
from robosc.model.semantics.roles import event_name

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.m2m.sct_to_engine.collect_events import Edges, EdgeTable
    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.m2m.sct_to_engine.terms import Term


@dataclass(frozen=True, eq=False)
class GuardTerms:
    """The condition under which an event can happen: its four parts on the state, and their conjunction.

    `by_plant` holds the condition that a plant has an edge for the event. `assumption` is the conjunction of these for
    assumptions, and `plants` for the other plants. The four parts of an event that depends on its inputs hold
    where some inputs are allowed: of a command, or of a goal that the controller can reject. `data` is the further
    condition on its inputs.
    """

    by_plant: Mapping[sct.Plant, Term]
    plants: Term
    assumption: Term
    requirement: Term
    synthesis: Term
    whole: Term
    data: Term

    @property
    def parts(self) -> list[tuple[engine.Origin, Term]]:
        """The parts with their origins."""
        return [
            (engine.Origin.plants, self.plants),
            (engine.Origin.assumption, self.assumption),
            (engine.Origin.requirement, self.requirement),
            (engine.Origin.synthesis, self.synthesis),
        ]


def combine_guards(
    model: sct.SupervisoryControlModel, edges: EdgeTable, lower: Lowering
) -> dict[sct.Event, GuardTerms]:
    """Return the guard of each event: all its plants have an edge for it, and both parts of the supervisor hold."""
    assert model.supervisor is not None
    supervised = {guard.event: guard for guard in model.supervisor.guards}
    return {event: _guard(event, by_plant, supervised.get(event), lower) for event, by_plant in edges.items()}


def _guard(
    event: sct.Event, by_plant: Mapping[sct.Plant, Edges], guard: sct.EventGuard | None, lower: Lowering
) -> GuardTerms:
    junction, possible, available, data = lower.terms.junction, {}, {}, []
    for plant, taken in by_plant.items():
        possible[plant] = available[plant] = _possible(plant, taken, lower)
        if reads_inputs(possible[plant]):
            _refuse_inputs_of_robot(event, taken)
            available[plant] = _possible(plant, taken, lower, with_some_data=True)
            data.append(possible[plant])
    supervising = []
    for part, with_some_data in _supervisor_parts(guard):
        term, state_part = lower(part), lower(with_some_data)
        if reads_inputs(term):
            data.append(term)
            term = state_part
        supervising.append(junction(engine.And, [term, state_part]))
    assumed = [term for plant, term in available.items() if plant.kind == sct.PlantKind.assumption]
    others = [term for plant, term in available.items() if plant.kind != sct.PlantKind.assumption]
    parts = junction(engine.And, others), junction(engine.And, assumed), supervising[0], supervising[1]
    return GuardTerms(possible, *parts, junction(engine.And, parts), junction(engine.And, data))


def _supervisor_parts(
    guard: sct.EventGuard | None,
) -> list[tuple[ex.Expression | None, ex.Expression | None]]:
    """Return the two parts of a supervisor's guard, each with the states in which it allows some inputs."""
    if guard is None:
        return [(None, None), (None, None)]
    return [(guard.requirement, guard.someRequired), (guard.synthesis, guard.someData)]


def reads_inputs(condition: Term) -> bool:
    """Return whether a condition reads inputs."""
    return any(isinstance(declaration, engine.Input) for declaration in condition.reads())


def _possible(plant: sct.Plant, edges: Edges, lower: Lowering, *, with_some_data: bool = False) -> Term:
    """Return the condition that a plant has an edge for an event. Locations with the same guard are combined.

    `with_some_data`: conditions that read inputs are true.
    """

    def one_of(leaving: Sequence[sct.Edge]) -> Term:
        whole = _one_of(leaving, lower)
        return lower.terms.true if with_some_data and reads_inputs(whole) else whole

    if None in edges:
        return one_of(edges[None])
    return lower.where(plant, {location: one_of(leaving) for location, leaving in edges.items()})


def _refuse_inputs_of_robot(event: sct.Event, edges: Edges) -> None:
    """Raise ModelError for an event of the robot: its data is unknown until it happens.

    The controller rejects a goal because of its data, so that the goal of an action that it serves may depend on them.
    """
    if not event.controllable and event.kind != sct.EventKind.request:
        message = f"`{event_name(event)}` depends on its data, which the controller only receives with the event"
        hint = "remove it from plant invariants, or add an edge for all other data"
        first = next(edge for leaving in edges.values() for edge in leaving)
        raise ModelError([Diagnostic(*place(first), Severity.ERROR, "cif-construct", message, hint)])


def _one_of(edges: Sequence[sct.Edge], lower: Lowering) -> Term:
    """Return the condition that one of the guards holds, without parts that earlier guards imply."""
    # Lower each guard, even if it is not needed: it may be invalid in an sct model.
    guards = [lower(edge.guard) for edge in edges]
    if _all_covered(edges, lower):
        return lower.terms.true
    denied: set[Term] = set()
    return lower.terms.junction(engine.Or, [remaining_guard(guard, denied, lower.terms) for guard in guards])


def _all_covered(edges: Sequence[sct.Edge], lower: Lowering) -> bool:
    """Return whether the edges cover all states, by the form that `robosc_to_sct` gives them.

    Each guard has the negations of the conditions before it, then its own condition; the last has only the negations.
    This test needs no analysis of the conditions, which may depend on several variables and data.
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
    """Return the parts of a left-nested conjunction, the last first. Right operands are not split."""
    parts = []
    while isinstance(condition, ex.Conjunction):
        parts.append(condition.right)
        condition = condition.left
    return [*parts, condition]
