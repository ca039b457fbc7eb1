"""Pass: one simultaneous effect for each event, made of the updates and moves of its edges in all plants."""

from __future__ import annotations

from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING

from robosc.metamodel import engine, sct
from robosc.semantics.domains import Interval

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
        """What the values depend on."""
        return {read for _, values in self.cases for value in values.values() for read in value.reads()}


@dataclass(frozen=True)
class EffectTerms:
    """What an event changes, step by step, and which variables are read after they were written."""

    steps: Sequence[StepTerms]
    copied: Collection[engine.StateVariable]


def merge_effects(edges: Mapping[sct.Plant, Edges], lower: Lowering) -> EffectTerms:
    """The effect of an event whose plants take these edges.

    Variables come first, ordered so that each is read before it is written; where that is impossible the value before
    is to be read from a copy. Locations come last: no other step needs one after it has changed.
    """
    steps = _ordered([step for plant, taken in edges.items() for step in _updates(plant, taken, lower)])
    moves = [step for plant, taken in edges.items() for step in _moves(plant, taken, lower)]
    return EffectTerms([*steps, *moves], _read_late(steps))


def _updates(plant: sct.Plant, edges: Edges, lower: Lowering) -> list[StepTerms]:
    """Updates that are the same on all edges, one by one; else by location."""
    groups: dict[tuple[tuple[engine.StateVariable, Term], ...], list[sct.Location | None]] = {}
    for location, edge in edges.items():
        values: Values = {}
        for update in edge.updates:
            variable = lower.variables[update.variable]
            value = lower.terms.saturation(lower(update.value), Interval(variable.minimum, variable.maximum))
            if value is not lower.terms.reference(variable):
                values[variable] = value
        groups.setdefault(tuple(values.items()), []).append(location)
    if len(groups) == 1:
        return [StepTerms([(None, {variable: value})]) for values in groups for variable, value in values]
    cases = [(locations, _in_order(dict(values))) for values, locations in groups.items()]
    return _by_location(plant, cases, list(edges), lower)


def _in_order(values: Values) -> Values:
    singles = [StepTerms([(None, {variable: value})]) for variable, value in values.items()]
    return {variable: value for step in _ordered(singles) for variable, value in step.cases[0][1].items()}


def _moves(plant: sct.Plant, edges: Edges, lower: Lowering) -> list[StepTerms]:
    """The change of location. Staying counts as going to the same location, so that one assignment often does."""
    variable = lower.variables.get(plant)
    if variable is None:
        return []
    targets: dict[sct.Location, list[sct.Location | None]] = {}
    for location, edge in edges.items():
        targets.setdefault(edge.target, []).append(location)
    cases: list[tuple[list[sct.Location | None], Values]] = [
        ([*locations], {} if locations == [target] else {variable: lower.terms.place(plant, target)})
        for target, locations in targets.items()
    ]
    if len(cases) == 1:
        return [StepTerms([(None, values)]) for _, values in cases if values]
    return _by_location(plant, cases, list(edges), lower)


def _by_location(
    plant: sct.Plant,
    cases: Sequence[tuple[Sequence[sct.Location | None], Values]],
    possible: Sequence[sct.Location | None],
    lower: Lowering,
) -> list[StepTerms]:
    """A step with the cases that change something; the last needs no condition where all do."""
    acting = [(locations, values) for locations, values in cases if values]
    others = len(acting) == len(cases)
    found: list[tuple[Term | None, Values]] = [
        (lower.within(plant, locations, possible), values) for locations, values in acting
    ]
    if others:
        found[-1] = None, acting[-1][1]
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
        for _, values in step.cases:
            here = set(written)
            for variable, value in values.items():
                late |= dict.fromkeys(
                    read for read in value.reads() if isinstance(read, engine.StateVariable) and read in here
                )
                here.add(variable)
        written |= step.writes()
    return list(late)
