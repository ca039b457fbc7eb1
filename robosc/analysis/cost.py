"""Causes of the cost of a synthesis: hubs, events and requirements."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, cast

from robosc.synthesis import MEMORY, Statistics, count, use_encoding
from robosc.synthesis.encoding import BitLayout, couplings_of
from robosc.synthesis.order import hubs

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robosc.model import sct
    from robosc.synthesis import Counts, Tuning
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element
    from robosc.synthesis.relation import SymbolicStep
    from robosc.synthesis.statistics import Follow

    Events = tuple[sct.Event, ...]
    Conditional = sct.Requirement | sct.StateInvariant | sct.ReachabilityRequirement


@dataclass(frozen=True)
class EventCost:
    """Cost of events that synthesis follows as one step.

    `operations` counts the images and preimages, `nodes` the nodes of their diagrams in total.
    """

    events: Sequence[sct.Event]
    operations: int
    nodes: int


@dataclass(frozen=True)
class Cost:
    """Causes of the cost of a synthesis, the largest first.

    `order` lists the elements from the top of the diagrams down. `hubs` holds the elements of almost every event, each
    with its number of `couplings`: of events, invariants and predicates that read or change it. `requirements` holds
    the nodes of the diagram of each condition.
    """

    counts: Counts
    statistics: Statistics
    order: Sequence[Element]
    hubs: Sequence[tuple[Element, int]]
    couplings: int
    events: Sequence[EventCost]
    requirements: Sequence[tuple[Conditional, int]]


@dataclass
class _Observed(Statistics):
    """Statistics that record the cost of each step."""

    operations_of: Counter[Events] = field(default_factory=Counter)
    nodes_of: Counter[Events] = field(default_factory=Counter)

    def begin_again(self) -> None:
        super().begin_again()
        self.operations_of.clear()
        self.nodes_of.clear()

    def followed(self, follow: Follow) -> Follow:
        def observed(step: SymbolicStep, states: Diagram) -> Diagram:
            result: Diagram = follow(step, states)
            self.operations_of[step.events] += 1
            self.nodes_of[step.events] += result.node_count()
            return result

        return cast("Follow", observed)

    def replace_costs(self, other: Statistics) -> None:
        super().replace_costs(other)
        if isinstance(other, _Observed):
            self.operations_of, self.nodes_of = other.operations_of, other.nodes_of


def explain_cost(model: sct.SupervisoryControlModel, tuning: Tuning, *, memory: int = MEMORY) -> Cost:
    """Count the states under the supervisor of a model, and return what the count costs.

    Every run returns the same, except for the seconds. For the arguments and errors see `robosc.synthesis.synthesize`.
    """
    statistics = _Observed()
    counts = count(model, memory=memory, statistics=statistics, tuning=tuning)
    layout = BitLayout(model, tuning.order)
    elements = sorted(layout.domains.values(), key=lambda domain: domain.rank)
    index = {domain.element: domain.rank for domain in elements}
    couplings = [[index[element] for element in coupling] for coupling in couplings_of(model, index)]
    degree = Counter(vertex for coupling in couplings for vertex in coupling)
    central = sorted(hubs(len(index), couplings), key=degree.__getitem__, reverse=True)
    conditions: list[Conditional] = [
        *model.requirements,
        *model.invariants,
        *model.reachabilityRequirements,
    ]
    sizes = use_encoding(
        model, lambda encoding: [encoding.holds(own.condition).node_count() for own in conditions], memory
    )
    by_nodes = sorted(zip(conditions, sizes, strict=True), key=lambda row: row[1], reverse=True)
    return Cost(
        counts,
        statistics,
        [domain.element for domain in layout.domains.values() if domain.levels],
        [(elements[vertex].element, degree[vertex]) for vertex in central],
        len(couplings),
        [
            EventCost(events, statistics.operations_of[events], nodes)
            for events, nodes in sorted(statistics.nodes_of.items(), key=lambda row: row[1], reverse=True)
        ],
        by_nodes,
    )
