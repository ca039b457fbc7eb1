"""From plants and requirements to the supervisor, over decision diagrams.

    synthesis = synthesize(model)
    if synthesis.supervisor is not None:
        model.supervisor = synthesis.supervisor

`solve` lets its caller look at the decision diagrams, too; `encoded` makes those of a model without synthesis. Why a
supervisor is empty and what is doubtful about one is found by `robosc.analysis`.

The modules, from the lowest up: `bdd` wraps the library of decision diagrams; `order` puts variables in order;
`arithmetic` computes with vectors of diagrams; `encoding` maps elements and expressions to diagrams, and `decoding` and
`cover` back; `relation` is what an event does; `fixpoint` closes sets of states, in small steps or by `acceleration`;
`guards` says in expressions what the fixpoint found, as seen from few elements by `projection`, and `simplification`
makes requirements shorter; `run_to_completion` bounds internal events.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

from robosc.diagnostics import Diagnostic, ModelError, Severity
from robosc.metamodel import sct
from robosc.metamodel.places import place
from robosc.semantics.roles import event_name, is_from_cif
from robosc.synthesis.bdd import Diagrams, with_enough_memory
from robosc.synthesis.cover import separating_expression
from robosc.synthesis.encoding import Encoding, Layout
from robosc.synthesis.fixpoint import SupervisedStates, reachable, supervise, supervise_only
from robosc.synthesis.guards import Permission, permission
from robosc.synthesis.projection import Projection
from robosc.synthesis.relation import EventRelation, event_relations, plant_moves, required_moves, steps, violations
from robosc.synthesis.run_to_completion import completion, internal_events
from robosc.synthesis.statistics import Phase, Statistics

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.relation import Move

    T = TypeVar("T")
    _Supervising = Callable[[Encoding, Sequence[Move], Diagram], SupervisedStates]

__all__ = [
    "MEMORY",
    "Counts",
    "Phase",
    "Solution",
    "Statistics",
    "Synthesis",
    "count",
    "encoded",
    "solve",
    "synthesize",
]

#: How many bytes decision diagrams may take where nothing else is said.
MEMORY = 4 << 30
#: What may be spent on the bound on internal events, in nodes looked at: some tenths of a second.
COMPLETION_EFFORT = 2_000_000


@dataclass(frozen=True)
class Synthesis:
    """The result of synthesis. All but the seconds is the same on every run.

    `supervisor` is None where it is empty. A state is an assignment of locations and variables: `controlled_states`
    counts those under the supervisor, `uncontrolled_states` those that the plants reach without requirements, None for
    a model from CIF: plants that only requirements keep together can have diagrams that no controlled system has.
    `bdd_nodes` are the nodes of the diagrams of the controlled states and of what says of each controllable event where
    it is allowed; `statistics`, what it cost.
    """

    supervisor: sct.Supervisor | None
    uncontrolled_states: int | None
    controlled_states: int
    bdd_nodes: int
    statistics: Statistics
    #: The events that can happen under the supervisor, in the order of the plants.
    possible: tuple[sct.Event, ...] = ()
    #: The events of which the supervisor does not say what synthesis added, since that takes more than the effort
    #: allowed, each with the nodes of the diagram that says so.
    unwritten: Mapping[sct.Event, int] = field(default_factory=dict)

    @property
    def seconds(self) -> float:
        """How long it took."""
        return sum(self.statistics.seconds.values())


@dataclass(frozen=True)
class Counts:
    """How many states there are, as `Synthesis` counts them, and the nodes of the diagram of the controlled ones."""

    uncontrolled_states: int | None
    controlled_states: int
    bdd_nodes: int


@dataclass(frozen=True)
class _Found:
    """What the fixpoint found, with what it was found by; None where `uncontrolled` states are not counted."""

    encoding: Encoding
    relations: Sequence[EventRelation]
    states: SupervisedStates
    uncontrolled: Diagram | None


@dataclass(frozen=True)
class Solution:
    """The result of synthesis with the decision diagrams that it was found with.

    `relations` are those of all events, in the order of the plants, `permissions` those of the controllable ones: none
    where the supervisor is empty. `states` is what the fixpoint found, `uncontrolled` what the plants reach without
    requirements, None where that is not counted.
    """

    synthesis: Synthesis
    encoding: Encoding
    relations: Sequence[EventRelation]
    permissions: Sequence[Permission]
    states: SupervisedStates
    uncontrolled: Diagram | None


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
    return solve(model, lambda solution: solution.synthesis, memory=memory, statistics=statistics)


def count(model: sct.SupervisoryControlModel, *, memory: int = MEMORY, statistics: Statistics | None = None) -> Counts:
    """How many states the supervisor of a model leaves it: 0 where there is none; its guards are not written out.

    For models with guards that take longer than all else. All else is as `synthesize` says.
    """

    def counted(found: _Found) -> Counts:
        encoding, controlled = found.encoding, found.states.controlled
        states = encoding.count(controlled) if controlled.satisfiable() else 0
        return Counts(_uncontrolled_states(found), states, controlled.node_count())

    return _with_states(model, counted, memory, statistics or Statistics(), supervise_only)


def solve(
    model: sct.SupervisoryControlModel,
    look: Callable[[Solution], T],
    *,
    memory: int = MEMORY,
    statistics: Statistics | None = None,
    effort: int | None = None,
) -> T:
    """Synthesizes and returns `look(solution)`.

    When the decision diagrams outgrow their limit, synthesis and `look` run again with a larger one, so `look` must
    have no lasting side effects. `effort`: most nodes visited for one guard; what synthesis added to a guard that takes
    more is left out, and `unwritten` lists its event. All else, and errors, as `synthesize`.
    """
    statistics = statistics or Statistics()
    return _with_states(model, lambda found: look(_solved(found, statistics, effort)), memory, statistics, supervise)


def encoded(model: sct.SupervisoryControlModel, look: Callable[[Encoding], T], memory: int = MEMORY) -> T:
    """Returns `look(encoding)`, of the decision diagrams of a model without synthesis.

    When these outgrow their limit, `look` runs again with a larger one, so it must have no lasting side effects. Raises
    MemoryError where they would take more than `memory` bytes.
    """
    layout = Layout(model)
    return with_enough_memory(
        lambda capacity: look(Encoding(layout, Diagrams(layout.levels, capacity))), memory, layout.levels
    )


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


def _refuse_overlapping(relations: Sequence[EventRelation]) -> None:
    """A supervisor allows an event, not one of its edges: those of a controllable event must exclude each other."""
    edges = [edge for relation in relations if relation.event.controllable for edge in relation.overlapping()]
    if edges:
        raise ModelError(
            [
                Diagnostic(
                    *place(edge),
                    Severity.ERROR,
                    "nondeterminism",
                    f"another edge of the controllable event {event_name(edge.event)} can be taken in the same state",
                    "let their guards exclude each other",
                )
                for edge in edges
            ]
        )


def _with_states(
    model: sct.SupervisoryControlModel,
    use: Callable[[_Found], T],
    memory: int,
    statistics: Statistics,
    supervising: _Supervising,
) -> T:
    """What `use` makes of the states that the supervisor of a model leaves it."""
    _refuse_data_of_controllable_events(model)
    with statistics.during(Phase.ORDER):
        layout = Layout(model)
    return with_enough_memory(
        lambda capacity: use(_found(model, layout, capacity, statistics, supervising)), memory, layout.levels
    )


def _found(
    model: sct.SupervisoryControlModel,
    layout: Layout,
    capacity: int,
    statistics: Statistics,
    supervising: _Supervising,
) -> _Found:
    """The states, with room for so many nodes."""
    statistics.begin_again()
    with statistics.during(Phase.ENCODE):
        diagrams = Diagrams(layout.levels, capacity, statistics)
        encoding = Encoding(layout, diagrams)
        relations = event_relations(model, encoding)
        _refuse_overlapping(relations)
        moves = required_moves(relations)
    with statistics.during(Phase.FIXPOINT):
        uncontrolled = None
        if not is_from_cif(model):
            uncontrolled = reachable(diagrams, steps(plant_moves(relations)), encoding.initial, diagrams.true)
        violating = diagrams.any_of(violations(model, relations, encoding).values())
        return _Found(encoding, relations, supervising(encoding, moves, violating), uncontrolled)


def _uncontrolled_states(found: _Found) -> int | None:
    return None if found.uncontrolled is None else found.encoding.count_plants(found.uncontrolled)


def _solved(all_found: _Found, statistics: Statistics, effort: int | None) -> Solution:
    encoding, relations, found = all_found.encoding, all_found.relations, all_found.states
    uncontrolled, all_states = all_found.uncontrolled, _uncontrolled_states(all_found)
    diagrams, nodes = encoding.diagrams, found.controlled.node_count()
    if not found.controlled.satisfiable():
        empty = Synthesis(None, all_states, 0, nodes, statistics)
        return Solution(empty, encoding, relations, (), found, uncontrolled)
    with statistics.during(Phase.GUARDS):
        controlled = Projection(found.controlled, encoding)
        permissions = [
            permission(relation, controlled, encoding, restricts=len(found.rounds) > 1, effort=effort)
            for relation in relations
            if relation.event.controllable
        ]
        supervisor = sct.Supervisor(
            uncontrolledStates=all_states,
            controlledStates=encoding.count(found.controlled),
            bddNodes=nodes + sum(permission.where.node_count() for permission in permissions),
            guards=[permission.guard for permission in permissions],
        )
        left_out = encoding.initial & ~found.controlled
        if left_out.satisfiable():
            started = encoding.initial & found.controlled
            supervisor.initial = separating_expression(encoding, started, left_out, encoding.layout.state)
        # Within the controlled states a step leads where its guard lets it, and nowhere else.
        supervised = [(relation, relation.enabled & relation.requirement, relation.step) for relation in relations]
        unwritten = {
            permission.relation.event: permission.where.node_count()
            for permission in permissions
            if permission.unwritten
        }
        if not unwritten:
            internal = internal_events(supervised, supervisor.guards)
            supervisor.settlingBound = completion(diagrams, internal, found.controlled, COMPLETION_EFFORT).bound
        permitted = {permission.relation.event: permission.where for permission in permissions}
        possible = [
            relation.event
            for relation in relations
            if (
                permitted[relation.event]
                if relation.event in permitted
                else controlled.onto(relation.concerned) & relation.enabled
            ).satisfiable()
        ]
    synthesis = Synthesis(
        supervisor, all_states, supervisor.controlledStates, supervisor.bddNodes, statistics, tuple(possible), unwritten
    )
    return Solution(synthesis, encoding, relations, permissions, found, uncontrolled)
