"""Finite and bounded response, and confluence: the end of sequences of internal events.

The terms are those of Reijnen, Hofkamp, van de Mortel-Fronczak, Reniers, Rooda: Finite response and confluence of
state-based supervisory controllers, CASE 2019. The paper examines pairs of events; this module decides confluence.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from itertools import chain, combinations
from typing import TYPE_CHECKING

from robosc.analysis.paths import shortest_path
from robosc.analysis.system import format_count
from robosc.analysis.verify.loop import require_loop_states
from robosc.analysis.verify.verdict import Outcome, Verdict, trace_step
from robosc.synthesis.encoding import pick
from robosc.synthesis.fixpoint import coreachable
from robosc.synthesis.relation import steps
from robosc.synthesis.run_to_completion import independent_groups, runs

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from robosc.analysis.paths import Path, TraceStep
    from robosc.analysis.system import GuardedSystem
    from robosc.analysis.verify.loop import LoopModel
    from robosc.model import sct
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element
    from robosc.synthesis.run_to_completion import InternalEvent

FINITE, BOUNDED, CONFLUENCE = "finite response", "bounded response", "confluence"
_GIVEN_UP = "silent events take too many steps to count before they end"
#: Effort limit for following all silent events together, in visited nodes.
_EFFORT = 20_000_000
#: Maximum number of resets of failed calls among dependent internal events. All combinations of held-back resets are
#: examined.
_MOST_WITHHELD = 6


def finite_response(system: GuardedSystem) -> Verdict:
    """Check that internal events can happen forever from no reachable state."""
    completion = system.completion
    evidence = f"{system.size}, {format_count(len(system.internal), 'silent event')}"
    if completion.divergent.satisfiable():
        stem, cycle = _lasso(system, completion.divergent)
        explanation = (
            f"{format_count(len(cycle), 'silent event')} can happen again and again, and no other event happens then"
        )
        return Verdict(FINITE, Outcome.REFUTED, evidence, explanation, stem, cycle)
    if completion.bound is None:
        return Verdict(FINITE, Outcome.SKIPPED, evidence, _GIVEN_UP)
    return Verdict(FINITE, Outcome.PROVED, evidence)


def bounded_response(system: GuardedSystem) -> Verdict:
    """Check that there is a bound on consecutive internal events, and that the supervisor's bound is right."""
    completion = system.completion
    if completion.divergent.satisfiable():
        return Verdict(
            BOUNDED, Outcome.REFUTED, system.size, "silent events need not come to rest: see finite response"
        )
    if completion.bound is None:
        return Verdict(BOUNDED, Outcome.SKIPPED, system.size, _GIVEN_UP)
    stored_bound = system.supervisor.settlingBound
    most = completion.bound if stored_bound is None else stored_bound
    longer = _longer(system, most)
    if longer is not None and longer.satisfiable():
        path = system.path_to(longer)
        run = _run(system, path.states[-1], most + 1)
        explanation = f"according to the supervisor, at most {format_count(most, 'silent event')} happen in a row"
        return Verdict(BOUNDED, Outcome.REFUTED, system.size, explanation, system.trace(path), run)
    bound = min(most, completion.bound)
    return Verdict(BOUNDED, Outcome.PROVED, f"{system.size}, at most {format_count(bound, 'silent event')} in a row")


def _longer(system: GuardedSystem, most: int) -> Diagram | None:
    """Return the states from which more than `most` silent events can happen in a row.

    All silent events are followed together. Synthesis computes its bound with `completion`, which adds up the bounds of
    groups; no sequence need be that long. Returns None if the effort limit is exceeded.
    """
    effort = _EFFORT
    for length, states in enumerate(runs(system.diagrams, system.internal, system.controlled), 1):
        effort -= len(system.internal) * (states.node_count() + 1)
        if length > most or not states.satisfiable():
            return states
        if effort < 0:
            return None
    raise AssertionError("there is no end to longer and longer runs")


def _lasso(system: GuardedSystem, divergent: Diagram) -> tuple[tuple[TraceStep, ...], tuple[TraceStep, ...]]:
    """Return a shortest path to the first cycle of internal events, and the cycle."""
    path = system.path_to(_recurring(system, divergent))
    states, events = [path.states[-1]], []
    while True:
        event, after = _next(system, states[-1], divergent)
        events.append(event)
        if after in states:
            start = states.index(after)
            taken = [trace_step(event.relation.event) for event in events]
            return (*system.trace(path), *taken[:start]), tuple(taken[start:])
        states.append(after)


def _recurring(system: GuardedSystem, divergent: Diagram) -> Diagram:
    """Return the divergent states that are on a cycle of internal events or on a path from one to another."""
    while True:
        after = system.diagrams.any_of(_after(internal, divergent) for internal in system.internal)
        if divergent == divergent & after:
            return divergent
        divergent &= after


def _run(system: GuardedSystem, codes: dict[Element, int], length: int) -> tuple[TraceStep, ...]:
    """Return `length` consecutive internal events from a state that allows them."""
    longer = [system.controlled]
    for states, _ in zip(runs(system.diagrams, system.internal, system.controlled), range(length - 1), strict=False):
        longer.append(states)
    taken = []
    for states in reversed(longer):
        event, codes = _next(system, codes, states)
        taken.append(trace_step(event.relation.event))
    return tuple(taken)


def _next(
    system: GuardedSystem, codes: dict[Element, int], within: Diagram
) -> tuple[InternalEvent, dict[Element, int]]:
    """Return the first internal event that leads from a state into a set, and the state after it."""
    here = system.encoding.state(codes)
    for internal in system.internal:
        after = _after(internal, here) & within
        if after.satisfiable():
            return internal, pick(after, system.encoding.layout.state)
    raise AssertionError("the states were said to go on")


def _after(internal: InternalEvent, states: Diagram) -> Diagram:
    """Return the states after an internal event in some of these states."""
    return states & internal.allowed if internal.step is None else internal.step.image(states)


@require_loop_states(CONFLUENCE)
def confluence(loop: LoopModel) -> Verdict:
    """Check that internal events lead from every state of the control loop to at most one quiescent state.

    Independent events cannot lead to different states by a different order, so each group is examined separately.
    """
    system = loop.system
    quiescent = format_count(system.encoding.count(loop.quiescent), "of them at rest").removesuffix("s")
    evidence = f"{format_count(system.encoding.count(loop.states), 'state')}, {quiescent}"
    skipped = False
    for group in independent_groups(system.internal):
        withheld = {event.relation.event: loop.withheld(event.relation.event) for event in group}
        resets = [event for event, states in withheld.items() if states.satisfiable()]
        # A single event has no order.
        if len(group) == 1:
            continue
        skipped = skipped or len(resets) > _MOST_WITHHELD
        for chosen in _subsets(resets[:_MOST_WITHHELD]):
            ends = _Ends(
                loop, [_held_back(event, withheld) if event.relation.event in chosen else event for event in group]
            )
            if ends.several.satisfiable():
                return ends.verdict(evidence)
    if skipped:
        return Verdict(CONFLUENCE, Outcome.SKIPPED, evidence, "too many resets have to do with each other")
    return Verdict(CONFLUENCE, Outcome.PROVED, evidence)


def _subsets(events: Sequence[sct.Event]) -> Iterator[tuple[sct.Event, ...]]:
    return chain.from_iterable(combinations(events, size) for size in range(len(events) + 1))


def _held_back(internal: InternalEvent, withheld: Mapping[sct.Event, Diagram]) -> InternalEvent:
    """Return a reset that happens only in states in which nothing holds it back."""
    allowed = internal.allowed & ~withheld[internal.relation.event]
    return replace(internal, allowed=allowed, step=internal.relation.step_where(allowed))


class _Ends:
    """Final states of dependent internal events that happen in any order."""

    def __init__(self, loop: LoopModel, events: Sequence[InternalEvent]) -> None:
        self._loop = loop
        self._moves = [(event.relation, event.step) for event in events if event.step is not None]
        self._quiescent = loop.states & ~loop.system.diagrams.any_of(event.allowed for event in events)

    @cached_property
    def several(self) -> Diagram:
        """States with several final states. These differ in some bit that one of the events changes."""
        system, several = self._loop.system, self._loop.system.diagrams.false
        for element in dict.fromkeys(element for relation, _ in self._moves for element in relation.changed):
            for bit in system.encoding.bits(element):
                ending_set, ending_clear = (
                    coreachable(system.diagrams, steps(self._moves), self._quiescent & value, self._loop.states)
                    for value in (bit, ~bit)
                )
                several |= ending_set & ending_clear
        return several

    def verdict(self, evidence: str) -> Verdict:
        """Return the refutation, with two paths from one of these states."""
        system = self._loop.system
        path = self._loop.path_to(self.several)
        way = self._way(path, self._quiescent)
        other_way = self._way(path, self._quiescent & ~system.last(way))
        return Verdict(
            CONFLUENCE,
            Outcome.REFUTED,
            evidence,
            _difference(system, way, other_way),
            system.trace(path),
            system.trace(way),
            system.trace(other_way),
        )

    def _way(self, before: Path, goal: Diagram) -> Path:
        system = self._loop.system
        way = shortest_path(system.encoding, self._moves, system.last(before), goal, self._loop.states)
        assert way is not None
        return way


def _difference(system: GuardedSystem, way: Path, other_way: Path) -> str:
    ends = way.states[-1], other_way.states[-1]
    differing = [element for element in ends[0] if ends[0][element] != ends[1][element]]
    first, second = (system.where(end, differing) for end in ends)
    return f"depending on their order, silent events end where `{first}` or where `{second}`"
