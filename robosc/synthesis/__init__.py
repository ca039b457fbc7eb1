"""Symbolic supervisor synthesis with decision diagrams.

    synthesis = synthesize(model)
    if synthesis.supervisor is not None:
        model.supervisor = synthesis.supervisor

`solve` also gives its caller the decision diagrams; `use_encoding` builds those of a model without synthesis.
`robosc.analysis` explains why a supervisor is empty and reports what is suspicious about one.

The modules, from the lowest up: `bdd` wraps the library of decision diagrams; `order` computes the variable order;
`arithmetic` computes with vectors of diagrams; `encoding` maps elements and expressions to diagrams, and `decoding`,
`factored` and `cover` map them back; `relation` holds the transition relation of each event; `fixpoint` closes sets of
states, in single steps or by `acceleration`; `race` chooses the strategy of the fixpoint; `guards` writes its result as
expressions, using `projection` to restrict state sets to few elements and `simplification` to shorten requirements;
`run_to_completion` bounds sequences of internal events.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

from robosc.base.diagnostics import Diagnostic, ModelError, Severity
from robosc.model import sct
from robosc.model.places import place
from robosc.model.semantics.roles import event_name, is_from_cif
from robosc.synthesis.bdd import Diagrams, OutOfRoomError, nodes_in, with_enough_memory
from robosc.synthesis.cover import separating_expression
from robosc.synthesis.encoding import BitLayout, Encoding, Order
from robosc.synthesis.fixpoint import Search, SupervisedStates, reachable
from robosc.synthesis.guards import Permission, permission
from robosc.synthesis.projection import Projection
from robosc.synthesis.race import Race, Strategy, StrategyChosenError
from robosc.synthesis.relation import (
    EventRelation,
    event_relations,
    goals,
    plant_moves,
    required_moves,
    steps,
    violations,
)
from robosc.synthesis.run_to_completion import completion, internal_events
from robosc.synthesis.statistics import Phase, Statistics

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from robosc.synthesis.bdd import Diagram

    T = TypeVar("T")

__all__ = [
    "MEMORY",
    "Counts",
    "Phase",
    "Solution",
    "Statistics",
    "Strategy",
    "Synthesis",
    "Tuning",
    "count",
    "solve",
    "synthesize",
    "use_encoding",
]

#: Default memory limit of the decision diagrams, in bytes.
MEMORY = 4 << 30
#: Share of the memory limit for the diagrams of a second strategy: one in this number.
_RIVAL = 4
#: Effort limit for the bound on internal events, in visited nodes. It takes some tenths of a second.
COMPLETION_EFFORT = 2_000_000


@dataclass(frozen=True)
class Synthesis:
    """Result of synthesis. Every run gives the same result, except for the seconds.

    `supervisor` is None if the supervisor is empty. A state is an assignment of locations and variables.
    `controlled_states` is the number of states under the supervisor. `uncontrolled_states` is the number of states that
    the plants reach without requirements. It is None for a model from CIF: if only requirements keep plants together,
    the diagrams of the uncontrolled states can be far larger than those of any controlled system. `bdd_nodes` counts
    the nodes of the diagram of the controlled states and of the diagrams in which each controllable event is allowed.
    `statistics` holds the costs.
    """

    supervisor: sct.Supervisor | None
    uncontrolled_states: int | None
    controlled_states: int
    bdd_nodes: int
    statistics: Statistics
    #: Events that can happen under the supervisor, in the order of the plants.
    possible: tuple[sct.Event, ...] = ()
    #: Events whose synthesized condition is missing from the supervisor because it is too long. Each event
    #: comes with the number of nodes of the diagram of that condition.
    unwritten: Mapping[sct.Event, int] = field(default_factory=dict)

    @property
    def seconds(self) -> float:
        """Total wall-clock time in seconds."""
        return sum(self.statistics.seconds.values())


@dataclass(frozen=True)
class Tuning:
    """Choices that change the cost of synthesis. They never change the supervisor.

    `order` is "automatic", "text" for the order of the model's text, or a sequence of names of elements from the top of
    the diagrams down, as `robosc.synthesis.encoding.element_name` returns them. The other elements follow in the
    automatic order. Without a `strategy`, synthesis chooses one. `longest` is the maximum number of conditions that
    synthesis adds to one event. A guard that needs more is written without them, and `unwritten` lists its event.
    """

    order: Order = "automatic"
    strategy: Strategy | None = None
    longest: int | None = None


@dataclass(frozen=True)
class Counts:
    """State counts as in `Synthesis`, and the node count of the controlled states' diagram."""

    uncontrolled_states: int | None
    controlled_states: int
    bdd_nodes: int


@dataclass(frozen=True)
class _Solution:
    """Result of the fixpoint.

    `uncontrolled_states` is None if these states are not counted. `uncontrolled` holds them if they have the encoding
    of the result.
    """

    states: SupervisedStates
    uncontrolled: Diagram | None
    uncontrolled_states: int | None


@dataclass(frozen=True)
class Solution:
    """Result of synthesis with its decision diagrams.

    `relations` are those of all events, in the order of the plants. `permissions` are those of the controllable events;
    it is empty if the supervisor is empty. `states` is the result of the fixpoint. `uncontrolled` holds the states that
    the plants reach without requirements; it is None if these are not counted, or not in this encoding.
    """

    synthesis: Synthesis
    encoding: Encoding
    relations: Sequence[EventRelation]
    permissions: Sequence[Permission]
    states: SupervisedStates
    uncontrolled: Diagram | None


def synthesize(
    model: sct.SupervisoryControlModel,
    *,
    memory: int = MEMORY,
    statistics: Statistics | None = None,
    tuning: Tuning | None = None,
) -> Synthesis:
    """Synthesize the maximally permissive, controllable, non-blocking supervisor of a valid model.

    The model is not changed. `sct.ecore` documents the meaning of plants, events and expressions. Inputs are parameters
    of their event. The supervisor copes with all values of an uncontrollable event. It decides on each combination of
    values of a controllable event. A marked state, and a state that a requirement wants to be reachable, is reachable
    for some values. `memory` is the limit of the decision diagrams
    in bytes. The diagrams grow as needed; beyond the limit, MemoryError is raised. Pass new `statistics` to follow the
    progress from another thread. `tuning` changes the cost, but never the supervisor.

    Raises a located ModelError if synthesis does not support the model: doubles and strings.
    """
    return solve(model, lambda solution: solution.synthesis, memory=memory, statistics=statistics, tuning=tuning)


def count(
    model: sct.SupervisoryControlModel,
    *,
    memory: int = MEMORY,
    statistics: Statistics | None = None,
    tuning: Tuning | None = None,
) -> Counts:
    """Count the states under the supervisor of a model, without writing its guards.

    The count is 0 if the supervisor is empty. Use it for models whose guards take longer than the rest of synthesis.
    For the arguments and errors see `synthesize`.
    """

    def counted(solution: _Solution) -> Counts:
        encoding, controlled = solution.states.search.encoding, solution.states.controlled
        states = encoding.count(controlled) if controlled.satisfiable() else 0
        return Counts(solution.uncontrolled_states, states, controlled.node_count())

    return _with_states(model, counted, memory, statistics or Statistics(), tuning or Tuning())


def solve(
    model: sct.SupervisoryControlModel,
    look: Callable[[Solution], T],
    *,
    memory: int = MEMORY,
    statistics: Statistics | None = None,
    tuning: Tuning | None = None,
) -> T:
    """Synthesize and return `look(solution)`.

    If the decision diagrams outgrow their limit, synthesis and `look` run again with a larger one. `look` must
    therefore have no lasting side effects. For the other arguments and the errors see `synthesize`.
    """
    statistics, tuning = statistics or Statistics(), tuning or Tuning()
    return _with_states(
        model, lambda all_states: look(_solved(all_states, statistics, tuning.longest)), memory, statistics, tuning
    )


def use_encoding(model: sct.SupervisoryControlModel, look: Callable[[Encoding], T], memory: int = MEMORY) -> T:
    """Return `look(encoding)` for the decision diagrams of a model, without synthesis.

    If the diagrams outgrow their limit, `look` runs again with a larger one. `look` must therefore have no lasting side
    effects. Raises MemoryError if the diagrams take more than `memory` bytes.
    """
    layout = BitLayout(model)
    return with_enough_memory(
        lambda capacity: look(Encoding(layout, Diagrams(layout.levels, capacity))), memory, layout.levels
    )


def _refuse_overlapping(relations: Sequence[EventRelation]) -> None:
    """Raise ModelError if two edges of a controllable event overlap.

    A supervisor allows an event, not one of its edges. The edges of a controllable event must therefore exclude each
    other.
    """
    edges = [edge for relation in relations if relation.event.controllable for edge in relation.overlapping_edges()]
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
    use: Callable[[_Solution], T],
    memory: int,
    statistics: Statistics,
    tuning: Tuning,
) -> T:
    """Compute the supervised states of a model and return the result of `use`."""
    with statistics.during(Phase.ORDER):
        layout = BitLayout(model, tuning.order)
    race = Race(tuning.strategy)

    rival_most = nodes_in(memory) // _RIVAL

    def run(capacity: int) -> T:
        is_open = race.strategy is None
        try:
            return use(_solve(layout, capacity, min(capacity, rival_most), statistics, race))
        except StrategyChosenError:
            pass
        except OutOfRoomError:
            # The winner had only the room of a rival.
            if not is_open or race.strategy is not Strategy.BACKWARD or capacity <= rival_most:
                raise
        # After the handlers, the diagrams of the other strategies are released.
        return use(_solve(layout, capacity, min(capacity, rival_most), statistics, race))

    return with_enough_memory(run, memory, layout.levels)


def _search(layout: BitLayout, capacity: int, statistics: Statistics) -> Search:
    """Return the problem of the fixpoint, with room for `capacity` nodes."""
    model = layout.model
    encoding = Encoding(layout, Diagrams(layout.levels, capacity, statistics))
    relations = event_relations(model, encoding)
    _refuse_overlapping(relations)
    violating = encoding.diagrams.any_of(violations(model, relations, encoding).values())
    states_to_reach = list(goals(model, encoding).values())
    return Search(encoding, relations, required_moves(relations), violating, states_to_reach)


def _solve(layout: BitLayout, capacity: int, rival_capacity: int, statistics: Statistics, race: Race) -> _Solution:
    """Compute the supervised states, with room for `capacity` nodes and `rival_capacity` of another strategy.

    Raises StrategyChosenError if this has to begin again with the chosen strategy.
    """
    statistics.begin_again()
    with statistics.during(Phase.ENCODE):
        search = _search(layout, capacity, statistics)
    with statistics.during(Phase.FIXPOINT):
        uncontrolled = uncontrolled_states = None
        if not is_from_cif(layout.model):
            encoding = search.encoding
            uncontrolled = reachable(
                encoding.diagrams, steps(plant_moves(search.relations)), encoding.initial, encoding.diagrams.true
            )
            uncontrolled_states = encoding.count_plants(uncontrolled)
        before = statistics.another()
        states = race.supervise(search, lambda: _search(layout, rival_capacity, before.another()))
    statistics.strategy = race.strategy
    if states.search is search:
        return _Solution(states, uncontrolled, uncontrolled_states)
    statistics.replace_costs(states.search.diagrams.statistics)
    return _Solution(states, None, uncontrolled_states)


def _solved(all_found: _Solution, statistics: Statistics, longest: int | None) -> Solution:
    fixpoint = all_found.states
    encoding, relations = fixpoint.search.encoding, fixpoint.search.relations
    uncontrolled, all_states = all_found.uncontrolled, all_found.uncontrolled_states
    diagrams, nodes = encoding.diagrams, fixpoint.controlled.node_count()
    if not fixpoint.controlled.satisfiable():
        empty = Synthesis(None, all_states, 0, nodes, statistics)
        return Solution(empty, encoding, relations, (), fixpoint, uncontrolled)
    with statistics.during(Phase.GUARDS):
        controlled = Projection(fixpoint.controlled, encoding)
        permissions = [
            permission(relation, controlled, encoding, restricts=fixpoint.restricted, longest=longest)
            for relation in relations
            if relation.event.controllable
        ]
        supervisor = sct.Supervisor(
            uncontrolledStates=all_states,
            controlledStates=encoding.count(fixpoint.controlled),
            bddNodes=nodes + sum(permission.where.node_count() for permission in permissions),
            guards=[permission.guard for permission in permissions],
        )
        left_out = encoding.initial & ~fixpoint.controlled
        if left_out.satisfiable():
            started = encoding.initial & fixpoint.controlled
            supervisor.initial = separating_expression(encoding, started, left_out, encoding.layout.state)
        # From a controlled state, an event leads to a controlled state exactly if its guard allows it.
        supervised = [(relation, relation.allowed_by(relation.permitted), relation.step) for relation in relations]
        unwritten = {
            permission.relation.event: permission.where.node_count()
            for permission in permissions
            if permission.unwritten
        }
        if not unwritten:
            internal = internal_events(supervised, supervisor.guards)
            supervisor.settlingBound = completion(diagrams, internal, fixpoint.controlled, COMPLETION_EFFORT).bound
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
    return Solution(synthesis, encoding, relations, permissions, fixpoint, uncontrolled)
