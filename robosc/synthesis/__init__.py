"""From plants and requirements to the supervisor, over decision diagrams.

synthesis = synthesize(model)
if synthesis.supervisor is None:
    print(synthesis.reason.message)
else:
    model.supervisor = synthesis.supervisor
"""

from __future__ import annotations

from dataclasses import dataclass

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.metamodel import sct
from robosc.metamodel.places import place
from robosc.semantics.recursion import deep_recursion
from robosc.semantics.roles import event_name
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.encoding import Encoding, Layout
from robosc.synthesis.explanation import EmptySupervisor, Reason
from robosc.synthesis.fixpoint import reachable, supervise
from robosc.synthesis.guards import permission
from robosc.synthesis.observations import Observations, Observer
from robosc.synthesis.paths import TraceStep
from robosc.synthesis.projection import Projection
from robosc.synthesis.relation import event_relations
from robosc.synthesis.settling import settling, silent_events
from robosc.synthesis.statistics import Phase, Statistics

__all__ = ["Observations", "Phase", "Reason", "Statistics", "Synthesis", "TraceStep", "synthesize"]

#: How many bytes decision diagrams may take where nothing else is said.
MEMORY = 4 << 30
#: What may be spent on the bound on silent events, in nodes looked at: some tenths of a second.
SETTLING_EFFORT = 2_000_000


@dataclass(frozen=True)
class Synthesis:
    """The result of synthesis. All but the seconds is the same on every run.

    Either `supervisor` and `observations` are there and `reason` is None, or the supervisor is empty, and `reason` says
    why. A state is an assignment of locations and variables: `uncontrolled_states` counts those that the plants reach
    without requirements, `controlled_states` those under the supervisor. `bdd_nodes` are the nodes of the diagrams of
    the controlled states and of what says of each controllable event where it is allowed; `statistics`, what it cost.
    """

    supervisor: sct.Supervisor | None
    observations: Observations | None
    reason: Reason | None
    uncontrolled_states: int
    controlled_states: int
    bdd_nodes: int
    statistics: Statistics
    #: The events that can happen under the supervisor, in the order of the plants.
    possible: tuple[sct.Event, ...] = ()

    @property
    def seconds(self) -> float:
        """How long it took."""
        return sum(self.statistics.seconds.values())


@deep_recursion()
def synthesize(
    model: sct.SupervisoryControlModel, *, memory: int = MEMORY, statistics: Statistics | None = None
) -> Synthesis:
    """The maximally permissive, controllable, non-blocking supervisor of a valid model, which stays as it is.

    Plants, events, expressions mean what the documentation of `sct.ecore` says; inputs are parameters of their event:
    an uncontrollable event is controllable for all of their values, a marked state is reachable for some. `memory`
    bounds the bytes for decision diagrams: they grow as needed, and MemoryError is raised beyond. New `statistics` that
    are handed in tell another thread how far it is. Raises ModelError,
    located, for what no synthesis can be made of: doubles, strings, and data that comes with a controllable event.
    """
    _refuse_data_of_controllable_events(model)
    statistics = statistics or Statistics()
    with statistics.during(Phase.ORDER):
        layout = Layout(model)
    return with_enough_memory(lambda capacity: _synthesize(model, layout, capacity, statistics), memory)


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


def _synthesize(model: sct.SupervisoryControlModel, layout: Layout, capacity: int, statistics: Statistics) -> Synthesis:
    """The result, with room for so many nodes."""
    statistics.begin_again()
    with statistics.during(Phase.ENCODE):
        diagrams = Diagrams(layout.levels, capacity, statistics)
        encoding = Encoding(layout, diagrams)
        relations = event_relations(model, encoding)
        plant_moves = [(each, each.plant_step) for each in relations if each.plant_step is not None]
        moves = [(each, each.step) for each in relations if each.step is not None]
    with statistics.during(Phase.FIXPOINT):
        uncontrolled = reachable(diagrams, [step for _, step in plant_moves], encoding.initial, diagrams.true)
        found = supervise(
            encoding,
            [step for _, step in moves],
            [step for relation, step in moves if not relation.event.controllable],
        )
    if not found.controlled.satisfiable():
        with statistics.during(Phase.GUARDS):
            reason = EmptySupervisor(encoding, moves, plant_moves, found).reason()
        nodes = found.controlled.node_count()
        return Synthesis(None, None, reason, encoding.count(uncontrolled), 0, nodes, statistics)
    with statistics.during(Phase.GUARDS):
        controlled = Projection(found.controlled, encoding)
        permissions = [
            permission(each, controlled, encoding, restricts=len(found.rounds) > 1)
            for each in relations
            if each.event.controllable
        ]
        permitted = {each.relation.event: each.where for each in permissions}
        supervisor = sct.Supervisor(
            uncontrolledStates=encoding.count(uncontrolled),
            controlledStates=encoding.count(found.controlled),
            bddNodes=found.controlled.node_count() + sum(each.where.node_count() for each in permissions),
            guards=[each.guard for each in permissions],
        )
        # Within the controlled states a step leads where its guard lets it, and nowhere else.
        supervised = [(each, each.enabled & each.requirement, each.step) for each in relations]
        silent = silent_events(supervised, supervisor.guards)
        supervisor.settlingBound = settling(diagrams, silent, found.controlled, SETTLING_EFFORT).bound
    with statistics.during(Phase.OBSERVE):
        observations = Observer(model, encoding, moves, found, permissions).observations(uncontrolled)
        possible = [
            each.event
            for each in relations
            if (
                permitted[each.event] if each.event in permitted else controlled.onto(each.concerned) & each.enabled
            ).satisfiable()
        ]
    return Synthesis(
        supervisor,
        observations,
        None,
        supervisor.uncontrolledStates,
        supervisor.controlledStates,
        supervisor.bddNodes,
        statistics,
        tuple(possible),
    )
