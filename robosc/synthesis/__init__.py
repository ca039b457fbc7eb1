"""From plants and requirements to the supervisor, over decision diagrams.

synthesis = synthesize(model)
if synthesis.supervisor is None:
    print(synthesis.reason.message)
else:
    model.supervisor = synthesis.supervisor
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from time import perf_counter

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.metamodel import sct
from robosc.metamodel.places import place
from robosc.roles import event_name
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.encoding import Encoding, Layout
from robosc.synthesis.explanation import EmptySupervisor, Reason
from robosc.synthesis.fixpoint import reachable, supervise
from robosc.synthesis.guards import permission
from robosc.synthesis.observations import Observations, Observer
from robosc.synthesis.paths import TraceStep
from robosc.synthesis.relation import event_relations

__all__ = ["Observations", "Reason", "Synthesis", "TraceStep", "synthesize"]


@dataclass(frozen=True)
class Synthesis:
    """The result of synthesis. All but `seconds` is the same on every run.

    Either `supervisor` and `observations` are there and `reason` is None, or the supervisor is empty, and `reason` says
    why. A state is an assignment of locations and variables: `uncontrolled_states` counts those that the plants reach
    without requirements, `controlled_states` those under the supervisor. `bdd_nodes` are the nodes of the diagrams of
    the controlled states and of the states in which each controllable event is allowed.
    """

    supervisor: sct.Supervisor | None
    observations: Observations | None
    reason: Reason | None
    uncontrolled_states: int
    controlled_states: int
    bdd_nodes: int
    seconds: float
    #: The events that can happen under the supervisor, in the order of the plants.
    possible: tuple[sct.Event, ...] = ()


def synthesize(model: sct.SupervisoryControlModel, *, memory: int = 4 << 30) -> Synthesis:
    """The maximally permissive, controllable, non-blocking supervisor of a valid model, which stays as it is.

    Plants, events, expressions mean what the documentation of `sct.ecore` says; inputs are parameters of their event:
    an uncontrollable event is controllable for all of their values, a marked state is reachable for some. `memory`
    bounds the bytes for decision diagrams: they grow as needed, and MemoryError is raised beyond. Raises ModelError,
    located, for what no synthesis can be made of: doubles, strings, and data that comes with a controllable event.
    """
    began = perf_counter()
    _refuse_data_of_controllable_events(model)
    layout = Layout(model)
    result = with_enough_memory(lambda capacity: _synthesize(model, layout, capacity), memory)
    return replace(result, seconds=perf_counter() - began)


def _refuse_data_of_controllable_events(model: sct.SupervisoryControlModel) -> None:
    events = [event for plant in model.plants for event in plant.events if event.controllable and event.inputs]
    if events:
        raise ModelError(
            [
                Diagnostic(
                    *place(event), Severity.ERROR, "type", f"the controllable event {event_name(event)} carries inputs"
                )
                for event in events
            ]
        )


def _synthesize(model: sct.SupervisoryControlModel, layout: Layout, capacity: int) -> Synthesis:
    """All of the result but the seconds."""
    diagrams = Diagrams(layout.levels, capacity)
    encoding = Encoding(layout, diagrams)
    relations = event_relations(model, encoding)
    plant_moves = [(each, each.plant_step) for each in relations if each.plant_step is not None]
    moves = [(each, each.step) for each in relations if each.step is not None]
    uncontrolled = reachable(diagrams, [step for _, step in plant_moves], encoding.initial, diagrams.true)
    found = supervise(
        diagrams,
        [step for _, step in moves],
        [step for relation, step in moves if not relation.event.controllable],
        encoding.initial,
        encoding.all_marked,
    )
    if not found.controlled.satisfiable():
        reason = EmptySupervisor(encoding, moves, plant_moves, found).reason()
        return Synthesis(None, None, reason, encoding.count(uncontrolled), 0, found.controlled.node_count(), 0.0)
    permissions = [
        permission(each, found.controlled, encoding, restricts=len(found.rounds) > 1)
        for each in relations
        if each.event.controllable
    ]
    permitted = {each.relation.event: each.allowed for each in permissions}
    supervisor = sct.Supervisor(
        uncontrolledStates=encoding.count(uncontrolled),
        controlledStates=encoding.count(found.controlled),
        bddNodes=found.controlled.node_count() + sum(each.allowed.node_count() for each in permissions),
        guards=[each.guard for each in permissions],
    )
    return Synthesis(
        supervisor,
        Observer(model, encoding, moves, found, permissions).observations(uncontrolled),
        None,
        supervisor.uncontrolledStates,
        supervisor.controlledStates,
        supervisor.bddNodes,
        0.0,
        tuple(
            each.event
            for each in relations
            if (permitted[each.event] if each.event in permitted else found.controlled & each.enabled).satisfiable()
        ),
    )
