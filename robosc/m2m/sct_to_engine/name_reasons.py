"""Pass: names the reasons that can prevent an event, in the terms of the robot's model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.m2m.sct_to_engine.build_expressions import build_expression
from robosc.m2m.sct_to_engine.collect_events import shorten
from robosc.m2m.sct_to_engine.combine_guards import reads_inputs
from robosc.model import engine, sct
from robosc.model.semantics.roles import assumption_text

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from robosc.m2m.sct_to_engine.combine_guards import GuardTerms
    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.m2m.sct_to_engine.terms import Term

#: Roles of events that the controller sends. A node reports all reasons that block them.
_COMMANDS = (engine.Role.cancel, engine.Role.trigger)


def name_reasons(
    model: sct.SupervisoryControlModel,
    events: Mapping[sct.Event, engine.Event],
    guards: Mapping[sct.Event, GuardTerms],
    lower: Lowering,
) -> None:
    """Set `reasons` of the events: requirements and assumptions for all; plants and synthesis only for commands."""
    assert model.supervisor is not None
    forbidding = {
        requirement: lower(requirement.condition, positive=requirement.kind == sct.RequirementKind.disables)
        for requirement in model.requirements
    }
    by_state: dict[sct.Event, list[Term]] = {}
    for requirement, forbidden in forbidding.items():
        if not reads_inputs(forbidden):
            by_state.setdefault(requirement.event, []).append(forbidden)
    for requirement, condition in forbidding.items():
        forbidden = condition
        if reads_inputs(condition):
            # In a state in which the plants and the other requirements enable the command, no data are allowed.
            guard, junction, opposite = guards[requirement.event], lower.terms.junction, lower.terms.opposite
            others = map(opposite, by_state.get(requirement.event, ()))
            nothing_allowed = junction(engine.And, [guard.plants, opposite(guard.requirement), *others])
            forbidden = junction(engine.Or, [condition, nothing_allowed])
        if forbidden.constant != 0:
            reason = _reason(engine.Origin.requirement, forbidden, requirement.text or "a requirement")
            reason.requirement = requirement
            events[requirement.event].reasons.append(reason)
    explained = {guard.event: guard.explanation for guard in model.supervisor.guards if guard.explanation}
    for event, element in events.items():
        element.reasons.extend(_of_assumptions(guards[event].by_plant, lower))
        if element.role in _COMMANDS:
            element.reasons.extend(_of_plants(guards[event].by_plant, lower))
            if event in explained:
                element.reasons.append(engine.Reason(kind=engine.Origin.synthesis, text=shorten(explained[event])))


def _of_assumptions(possible: Mapping[sct.Plant, Term], lower: Lowering) -> Iterator[engine.Reason]:
    """Return a reason for each assumption that an event can violate."""
    for plant, holds in possible.items():
        if plant.kind == sct.PlantKind.assumption and holds.constant != 1:
            reason = _reason(engine.Origin.assumption, lower.terms.opposite(holds), assumption_text(plant))
            reason.assumption = plant
            yield reason


def _of_plants(possible: Mapping[sct.Plant, Term], lower: Lowering) -> Iterator[engine.Reason]:
    """Return a reason for each plant that does not have an edge for the event in all its locations."""
    for plant, holds in possible.items():
        if holds.constant != 1:
            location = lower.variables.get(plant)
            place = "" if location else plant.locations[0].name
            text = f"{plant.origin or plant.name}.{place}"
            reason = _reason(engine.Origin.plants, lower.terms.opposite(holds), text)
            reason.location = location
            yield reason


def _reason(kind: engine.Origin, condition: Term, text: str) -> engine.Reason:
    return engine.Reason(kind=kind, condition=build_expression(condition), text=text)
