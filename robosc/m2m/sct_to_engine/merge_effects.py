"""Pass: one simultaneous effect for each event, made of the updates and moves of its edges in all plants."""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING

from robosc.m2m.sct_to_engine.alternatives import Alternatives, exclusive
from robosc.metamodel import engine, sct
from robosc.semantics.domains import Interval
from robosc.semantics.edges import origin

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from robosc.m2m.sct_to_engine.collect_events import Edges
    from robosc.m2m.sct_to_engine.lower_expressions import Lowering
    from robosc.m2m.sct_to_engine.terms import Term

#: Variables with the values that they get.
Values = dict[engine.StateVariable, "Term"]


@dataclass(frozen=True, eq=False)
class StepTerms:
    """Assignments that are made together: those of the first case whose condition holds (None: in all others).

    A step that does not depend on a location has one case, without condition.
    """

    cases: Sequence[tuple[Term | None, Values]]

    def writes(self) -> set[engine.StateVariable]:
        """The variables that get a value."""
        return {variable for _, values in self.cases for variable in values}

    def reads(self) -> set[engine.Declaration]:
        """What the values and the choice among the cases depend on."""
        terms = [term for condition, values in self.cases for term in (condition, *values.values())]
        return {read for term in terms if term is not None for read in term.reads()}


@dataclass(frozen=True)
class EffectTerms:
    """What an event changes, step by step, and which variables are read after they were written."""

    steps: Sequence[StepTerms]
    copied: Collection[engine.StateVariable]


def merge_effects(edges: Mapping[sct.Plant, Edges], lower: Lowering) -> EffectTerms:
    """The effect of an event whose plants take these edges.

    Variables come first, ordered so that each is read before it is written; where that is impossible the value before
    is to be read from a copy. Locations come last: no other step needs one after it has changed. Where several edges of
    a location may be possible, which is so in models from CIF, one is taken with all that it changes.
    """
    chosen = {plant: taken for plant, taken in edges.items() if not exclusive(taken, lower)}
    others = {plant: taken for plant, taken in edges.items() if plant not in chosen}
    steps = [step for plant, taken in others.items() for step in _updates(plant, taken, lower)]
    steps = _ordered([*steps, *(step for plant, taken in chosen.items() for step in _changes(plant, taken, lower))])
    moves = [step for plant, taken in others.items() for step in _moves(plant, taken, lower)]
    return EffectTerms([*steps, *moves], _read_late([*steps, *moves]))


def _changes(plant: sct.Plant, edges: Edges, lower: Lowering) -> list[StepTerms]:
    """What the edges change, updates and location together: of those that may be taken the first in the text does."""
    variable = lower.variables.get(plant)
    cases: list[tuple[list[sct.Edge], Values]] = []
    known: dict[tuple[tuple[engine.StateVariable, Term], ...], int] = {}
    last: dict[sct.Location | None, int] = {}
    for edge in _all(edges):
        location, values = origin(edge), _values(edge, lower)
        if variable is not None and edge.target is not location:
            values[variable] = lower.terms.place(plant, edge.target)
        case = known.get(tuple(values.items()), -1)
        # Not before an edge of the same location that comes before it in the text.
        if case < last.get(location, 0):
            case = known[tuple(values.items())] = len(cases)
            cases.append(([], _in_order(values)))
        last[location] = case
        cases[case][0].append(edge)
    return _by_edge(plant, cases, edges, lower, overlapping=True)


def _updates(plant: sct.Plant, edges: Edges, lower: Lowering) -> list[StepTerms]:
    """Updates that are the same on all edges, one by one; else by location."""
    groups: dict[tuple[tuple[engine.StateVariable, Term], ...], list[sct.Edge]] = {}
    for edge in _all(edges):
        groups.setdefault(tuple(_values(edge, lower).items()), []).append(edge)
    if len(groups) == 1:
        return [StepTerms([(None, {variable: value})]) for values in groups for variable, value in values]
    cases = [(taken, _in_order(dict(values))) for values, taken in groups.items()]
    return _by_edge(plant, cases, edges, lower)


def _values(edge: sct.Edge, lower: Lowering) -> Values:
    """What the updates of an edge change."""
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
    """The change of location. Staying counts as going to the same location where that takes fewer conditions."""
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
    """A step with the cases that change something; the last needs no condition where all do.

    Where the cases are `overlapping`, the first that holds is taken also where it changes nothing.
    """
    alternatives = Alternatives(plant, edges, lower)
    found: list[tuple[Term | None, Values]] = []
    for chosen, values in cases:
        if values:
            found.append((alternatives.one_of(chosen), values))
        elif overlapping:
            alternatives.rule_out(chosen)
    if len(found) == len(cases):
        found[-1] = None, cases[-1][1]
    found = [(condition, values) for condition, values in found if condition is None or condition.constant != 0]
    return [StepTerms(found)] if found else []


def _ordered(steps: Sequence[StepTerms]) -> list[StepTerms]:
    """The steps so that each comes before those that write what it reads, as far as that is possible.

    The first of those that come next is taken; where each waits for another (a cycle), the first of all.
    """
    writers = {variable: number for number, step in enumerate(steps) for variable in step.writes()}
    # Whom each step is to come before: who writes what it reads.
    before = [
        {writers[read] for read in step.reads() if isinstance(read, engine.StateVariable) and read in writers}
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
    """What is read after it was written, in the order of the steps."""
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
    """Those of the variables that a term reads."""
    return dict.fromkeys(read for read in term.reads() if isinstance(read, engine.StateVariable) and read in written)
