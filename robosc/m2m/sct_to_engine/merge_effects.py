"""Pass: merges the updates and moves of an event's edges in all plants to one simultaneous effect."""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING

from robosc.m2m.sct_to_engine.alternatives import Alternatives, exclusive
from robosc.model import engine, sct
from robosc.model.semantics.domains import Interval
from robosc.model.semantics.edges import origin

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from robosc.m2m.sct_to_engine.collect_events import Edges
    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.m2m.sct_to_engine.terms import Term

#: Variables with their new values.
Values = dict[engine.StateVariable, "Term"]


@dataclass(frozen=True, eq=False)
class StepTerms:
    """Simultaneous assignments. The first case whose condition holds is executed (None: all other states).

    A step that does not depend on a location has one case, without condition.
    """

    cases: Sequence[tuple[Term | None, Values]]

    def writes(self) -> set[engine.StateVariable]:
        """Return the assigned variables."""
        return {variable for _, values in self.cases for variable in values}

    def reads(self) -> set[engine.Declaration]:
        """Return the variables and inputs that the values and conditions depend on."""
        terms = [term for condition, values in self.cases for term in (condition, *values.values())]
        return {declaration for term in terms if term is not None for declaration in term.reads()}


@dataclass(frozen=True)
class EffectTerms:
    """Changes by an event, step by step, and the variables that are read after they are written."""

    steps: Sequence[StepTerms]
    copied: Collection[engine.StateVariable]


def merge_effects(edges: Mapping[sct.Plant, Edges], lower: Lowering) -> EffectTerms:
    """Return the effect of an event whose plants take these edges.

    Variables come first, ordered so that each is read before it is written. If no such order exists, the old value is
    read from a copy. Locations come last: no other step needs one after it has changed. In models from CIF, several
    edges of a location may be possible; one of them is taken with all its changes.
    """
    chosen = {plant: taken for plant, taken in edges.items() if not exclusive(taken, lower)}
    others = {plant: taken for plant, taken in edges.items() if plant not in chosen}
    steps = [step for plant, taken in others.items() for step in _updates(plant, taken, lower)]
    steps = _ordered([*steps, *(step for plant, taken in chosen.items() for step in _changes(plant, taken, lower))])
    moves = [step for plant, taken in others.items() for step in _moves(plant, taken, lower)]
    return EffectTerms([*steps, *moves], _read_late([*steps, *moves]))


def _changes(plant: sct.Plant, edges: Edges, lower: Lowering) -> list[StepTerms]:
    """Return updates and move of the edges in one step: the first possible edge in the text is taken."""
    variable = lower.variables.get(plant)
    cases: list[tuple[list[sct.Edge], Values]] = []
    known: dict[tuple[tuple[engine.StateVariable, Term], ...], int] = {}
    last: dict[sct.Location | None, int] = {}
    for edge in _all(edges):
        location, values = origin(edge), _values(edge, lower)
        if variable is not None and edge.target is not location:
            values[variable] = lower.terms.place(plant, edge.target)
        case = known.get(tuple(values.items()), -1)
        # The order of edges of one location stays that of the text.
        if case < last.get(location, 0):
            case = known[tuple(values.items())] = len(cases)
            cases.append(([], _in_order(values)))
        last[location] = case
        cases[case][0].append(edge)
    return _by_edge(plant, cases, edges, lower, overlapping=True)


def _updates(plant: sct.Plant, edges: Edges, lower: Lowering) -> list[StepTerms]:
    """Return updates that all edges share, one by one; else the updates by location."""
    groups: dict[tuple[tuple[engine.StateVariable, Term], ...], list[sct.Edge]] = {}
    for edge in _all(edges):
        groups.setdefault(tuple(_values(edge, lower).items()), []).append(edge)
    if len(groups) == 1:
        return [StepTerms([(None, {variable: value})]) for values in groups for variable, value in values]
    cases = [(taken, _in_order(dict(values))) for values, taken in groups.items()]
    return _by_edge(plant, cases, edges, lower)


def _values(edge: sct.Edge, lower: Lowering) -> Values:
    """Return the variables that an edge's updates change, with their values."""
    values: Values = {}
    for update in edge.updates:
        variable = lower.variables[update.variable]
        value = lower.terms.saturation(lower(update.value), Interval(variable.minimum, variable.maximum))
        if value is not lower.terms.reference(variable):
            values[variable] = value
    return values


def _in_order(values: Values) -> Values:
    singles = [StepTerms([(None, {variable: value})]) for variable, value in values.items()]
    return {variable: value for step in _ordered(singles) for variable, value in step.cases[0][1].items()}


def _moves(plant: sct.Plant, edges: Edges, lower: Lowering) -> list[StepTerms]:
    """Return the change of location. Staying counts as a move to the same location if that needs fewer conditions."""
    variable = lower.variables.get(plant)
    if variable is None:
        return []
    targets: dict[sct.Location, list[sct.Edge]] = {}
    moving: dict[sct.Location, list[sct.Edge]] = {}
    staying: list[sct.Edge] = []
    for edge in _all(edges):
        targets.setdefault(edge.target, []).append(edge)
        (staying if edge.target is origin(edge) else moving.setdefault(edge.target, [])).append(edge)
    if not moving:
        return []
    places = {target: {variable: lower.terms.place(plant, target)} for target in moving}
    if len(targets) == 1:
        return [StepTerms([(None, values)]) for values in places.values()]
    joined = [(taken, places.get(target, {})) for target, taken in targets.items()]
    apart = [(taken, places[target]) for target, taken in moving.items()]
    apart += [(staying, {})] if staying else []
    ways = [_by_edge(plant, cases, edges, lower) for cases in (apart, joined)]
    return min(ways, key=lambda steps: sum(_size(condition) for step in steps for condition, _ in step.cases))


def _size(condition: Term | None) -> int:
    return 0 if condition is None else sum(1 for _ in condition.below())


def _all(edges: Edges) -> list[sct.Edge]:
    return [edge for leaving in edges.values() for edge in leaving]


def _by_edge(
    plant: sct.Plant,
    cases: Sequence[tuple[Sequence[sct.Edge], Values]],
    edges: Edges,
    lower: Lowering,
    *,
    overlapping: bool = False,
) -> list[StepTerms]:
    """Return a step with the cases that change something. If all cases do, the last needs no condition.

    If the cases are `overlapping`, the first case that holds is taken even if it changes nothing.
    """
    alternatives = Alternatives(plant, edges, lower)
    changing: list[tuple[Term | None, Values]] = []
    for chosen, values in cases:
        if values:
            changing.append((alternatives.one_of(chosen), values))
        elif overlapping:
            alternatives.rule_out(chosen)
    if len(changing) == len(cases):
        changing[-1] = None, cases[-1][1]
    changing = [(condition, values) for condition, values in changing if condition is None or condition.constant != 0]
    return [StepTerms(changing)] if changing else []


def _ordered(steps: Sequence[StepTerms]) -> list[StepTerms]:
    """Return the steps in an order in which each comes before the writers of its operands, as far as possible.

    Among several possible next steps, the first is taken; in a cycle, the first of all.
    """
    writers = {variable: number for number, step in enumerate(steps) for variable in step.writes()}
    # For each step, the writers that must come after it.
    before = [
        {
            writers[declaration]
            for declaration in step.reads()
            if isinstance(declaration, engine.StateVariable) and declaration in writers
        }
        - {number}
        for number, step in enumerate(steps)
    ]
    waiting = [0] * len(steps)
    for later in before:
        for number in later:
            waiting[number] += 1
    free = [number for number, count in enumerate(waiting) if not count]
    heapify(free)
    taken: dict[int, None] = {}
    first = 0
    while len(taken) < len(steps):
        while first in taken:
            first += 1
        number = heappop(free) if free else first
        if number in taken:
            continue
        taken[number] = None
        for later_number in before[number]:
            waiting[later_number] -= 1
            if not waiting[later_number]:
                heappush(free, later_number)
    return [steps[number] for number in taken]


def _read_late(steps: Sequence[StepTerms]) -> list[engine.StateVariable]:
    """Return variables that are read after they are written, in the order of the steps."""
    late: dict[engine.StateVariable, None] = {}
    written: set[engine.StateVariable] = set()
    for step in steps:
        for condition, values in step.cases:
            here = set(written)
            if condition is not None:
                late |= _variables(condition, here)
            for variable, value in values.items():
                late |= _variables(value, here)
                here.add(variable)
        written |= step.writes()
    return list(late)


def _variables(term: Term, written: Collection[engine.StateVariable]) -> dict[engine.StateVariable, None]:
    """Return the written variables that a term reads."""
    return dict.fromkeys(
        declaration
        for declaration in term.reads()
        if isinstance(declaration, engine.StateVariable) and declaration in written
    )
