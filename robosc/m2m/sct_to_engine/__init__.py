"""Transformation of an sct model with its supervisor to the controller's program. Each pass is a module.

The passes work on `terms`. `transform` defines their order.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.base.cache import cached
from robosc.m2m.sct_to_engine.build_expressions import as_denial, build_expression, build_value
from robosc.m2m.sct_to_engine.collect_events import collect_edges, collect_events, collect_groups, collect_sources
from robosc.m2m.sct_to_engine.combine_guards import combine_guards
from robosc.m2m.sct_to_engine.find_readers import find_readers
from robosc.m2m.sct_to_engine.lower_expressions import Lowering
from robosc.m2m.sct_to_engine.lower_timers import lower_timers
from robosc.m2m.sct_to_engine.merge_effects import EffectTerms, merge_effects
from robosc.m2m.sct_to_engine.name_reasons import name_reasons
from robosc.m2m.sct_to_engine.place_state import place_inputs, place_state
from robosc.m2m.sct_to_engine.share_conditions import SharedTerms, share_conditions
from robosc.m2m.sct_to_engine.terms import Term, Terms
from robosc.model import engine, sct
from robosc.model.semantics.roles import Roles, event_name, plant_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robosc.m2m.sct_to_engine.collect_events import EdgeTable
    from robosc.m2m.sct_to_engine.combine_guards import GuardTerms
    from robosc.model import expression as ex

#: Maximum number of events for a control loop that checks all events after each change. For fewer events, tracking the
#: affected ones costs more. Measured, see docs/engine.md.
POLLED = 64


def transform(model: sct.SupervisoryControlModel, polled: int | None = None) -> engine.EngineModel:
    """Return the controller's program for an sct model with its supervisor.

    With up to `polled` events the control loop checks all of them, else only those whose state changed. Raises
    ValueError if the model has no supervisor, or a supervisor without a guard for a controllable event.
    """
    polled = POLLED if polled is None else polled
    return cached((transform, model, polled), lambda: _transform(model, polled))


def lowering(model: sct.SupervisoryControlModel) -> Lowering:
    """Return the lowering of a model's expressions. The model needs no supervisor."""
    return Lowering(Terms(), place_state(model), place_inputs(model))


def _transform(model: sct.SupervisoryControlModel, polled: int) -> engine.EngineModel:
    _check(model)
    variables, inputs = place_state(model), place_inputs(model)
    edges = collect_edges(model)
    events = collect_events(model, edges, inputs)
    incremental = len(events) > polled and any(event.role != engine.Role.incoming for event in events.values())
    lower = Lowering(Terms(), variables, inputs)
    guards = combine_guards(model, edges, lower)
    shared = share_conditions(guards, events, lower.terms, incremental=incremental)
    effects = {event: merge_effects(edges[event], lower) for event in events}
    engine_model = engine.EngineModel(
        name=model.name,
        model=model,
        variables=list(variables.values()),
        inputs=list(inputs.values()),
        sources=collect_sources(model, events),
        groups=collect_groups(model, events),
        conditions=list(shared.conditions.values()),
        events=list(events.values()),
        choices=_choices(model, events, edges, lower),
        settlingBound=Roles(model).settling_bound,
        incremental=incremental,
    )
    lower_timers(engine_model, edges, lower)
    for term, condition in shared.conditions.items():
        condition.value = build_expression(term, shared, body=True)
    for event, element in events.items():
        element.guard = _guard(guards[event], shared)
        element.effect = _effect(effects[event])
    name_reasons(model, events, guards, lower)
    if incremental:
        find_readers(engine_model, guards, effects, shared)
    return engine_model


def _check(model: sct.SupervisoryControlModel) -> None:
    if model.supervisor is None:
        raise ValueError(f"{model.name} has no supervisor: synthesize it first")
    guarded = {guard.event for guard in model.supervisor.guards}
    for plant in model.plants:
        for event in plant.events:
            if event.controllable and event not in guarded:
                raise ValueError(f"the supervisor has no guard for {event_name(event)}")


def _choices(
    model: sct.SupervisoryControlModel,
    events: Mapping[sct.Event, engine.Event],
    edges: EdgeTable,
    lower: Lowering,
) -> list[engine.Choice]:
    """Return the choices of outgoing data. Sets `choice` of the triggers."""
    roles, choices = Roles(model), {}
    for alternatives in roles.data:
        plant = plant_of(alternatives[0])
        choices[plant] = engine.Choice(
            name=plant.name,
            plant=plant,
            variable=lower.variables.get(plant),
            alternatives=[
                engine.Alternative(event=events[event], chosen=_expression(_stays(edges, event, plant, lower)))
                for event in alternatives
            ],
        )
    for trigger, plant in roles.data_plants.items():
        events[trigger].choice = choices.get(plant)
    return list(choices.values())


def _stays(edges: EdgeTable, event: sct.Event, plant: sct.Plant, lower: Lowering) -> Term:
    """Return the condition that an event leaves its plant in its location."""
    taken = edges[event].get(plant, {})
    if None in taken:
        return lower.within(plant, [edge.target for edge in taken[None]])
    loops = [location for location, leaving in taken.items() if all(edge.target is location for edge in leaving)]
    return lower.within(plant, loops)


def _expression(condition: Term) -> ex.Expression | None:
    """Return the expression of a condition. None if it never holds."""
    return None if condition.constant == 0 else build_expression(condition)


def _guard(guard: GuardTerms, shared: SharedTerms) -> engine.Guard:

    def build(term: Term, origins: Sequence[engine.Origin]) -> engine.Term:
        condition = build_expression(term, shared)
        only_synthesis = origins == [engine.Origin.synthesis]
        return engine.Term(condition=as_denial(condition) if only_synthesis else condition, origins=origins)

    plants, assumption, requirement, synthesis = (
        None if part.constant == 1 else build_expression(part) for _, part in guard.parts
    )
    return engine.Guard(
        terms=[build(term, origins) for term, origins in shared.ask_for(guard).items()],
        plants=plants,
        assumption=assumption,
        requirement=requirement,
        synthesis=synthesis,
        data=None if guard.data.constant == 1 else build_expression(guard.data),
    )


def _effect(effect: EffectTerms) -> engine.Effect:
    def assignments(values: Mapping[engine.StateVariable, Term]) -> list[engine.Assignment]:
        return [
            engine.Assignment(variable=variable, value=build_value(variable, value, effect.copied))
            for variable, value in values.items()
        ]

    steps: list[engine.Step] = []
    for step in effect.steps:
        if len(step.cases) == 1 and step.cases[0][0] is None:
            steps += assignments(step.cases[0][1])
            continue
        cases = [
            engine.Case(
                condition=None if condition is None else build_expression(condition, None, effect.copied),
                assignments=assignments(values),
            )
            for condition, values in step.cases
        ]
        steps.append(engine.Switch(cases=cases))
    return engine.Effect(steps=steps, copied=list(effect.copied))
