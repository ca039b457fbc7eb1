"""Finite and bounded response: silent events come to rest, after a number of steps that is known.

The terms are those of Reijnen, Hofkamp, van de Mortel-Fronczak, Reniers, Rooda: Finite response and confluence of
state-based supervisory controllers, CASE 2019.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.analysis.verification.system import counted, happening
from robosc.analysis.verification.verdict import Outcome, Verdict
from robosc.synthesis.decoding import pick
from robosc.synthesis.settling import runs

if TYPE_CHECKING:
    from robosc.analysis.verification.system import SupervisedSystem
    from robosc.synthesis import TraceStep
    from robosc.synthesis.bdd import Diagram
    from robosc.synthesis.encoding import Element
    from robosc.synthesis.settling import SilentEvent

FINITE, BOUNDED = "finite response", "bounded response"
_GIVEN_UP = "silent events take so many steps to come to rest that counting them was given up"


def finite_response(system: SupervisedSystem) -> Verdict:
    """From no reachable state silent events can happen for ever."""
    found = system.settling
    evidence = f"{system.size}, {counted(len(system.silent), 'silent event')}"
    if found.restless.satisfiable():
        stem, cycle = _lasso(system, found.restless)
        explanation = f"{counted(len(cycle), 'silent event')} can happen again and again, and nothing else then happens"
        return Verdict(FINITE, Outcome.REFUTED, evidence, explanation, stem, cycle)
    if found.bound is None:
        return Verdict(FINITE, Outcome.SKIPPED, evidence, _GIVEN_UP)
    return Verdict(FINITE, Outcome.PROVED, evidence)


def bounded_response(system: SupervisedSystem) -> Verdict:
    """No more silent events happen in a row than the supervisor says, and there is such a bound."""
    found = system.settling
    if found.restless.satisfiable():
        return Verdict(
            BOUNDED, Outcome.REFUTED, system.size, "silent events need not come to rest: see finite response"
        )
    if found.bound is None:
        return Verdict(BOUNDED, Outcome.SKIPPED, system.size, _GIVEN_UP)
    said = system.supervisor.settlingBound
    if said is not None and said < found.bound:
        # What was found is the bound of groups of events taken together: no run need be that long.
        for length, states in enumerate(runs(system.diagrams, system.silent, system.reachable), 1):
            if length > said and states.satisfiable():
                path = system.path_to(states)
                run = _run(system, path.states[-1], length)
                explanation = f"the supervisor says that at most {counted(said, 'silent event')} happen in a row"
                return Verdict(BOUNDED, Outcome.REFUTED, system.size, explanation, system.trace(path), run)
            if not states.satisfiable():
                break
    bound = found.bound if said is None else min(said, found.bound)
    return Verdict(BOUNDED, Outcome.PROVED, f"{system.size}, at most {counted(bound, 'silent event')} in a row")


def _lasso(system: SupervisedSystem, restless: Diagram) -> tuple[tuple[TraceStep, ...], tuple[TraceStep, ...]]:
    """A shortest way to where silent events need never end, as far as the first cycle; and the cycle."""
    path = system.path_to(_recurring(system, restless))
    states, events = [path.states[-1]], []
    while True:
        event, after = _next(system, states[-1], restless)
        events.append(event)
        if after in states:
            start = states.index(after)
            taken = [happening(each.relation) for each in events]
            return (*system.trace(path), *taken[:start]), tuple(taken[start:])
        states.append(after)


def _recurring(system: SupervisedSystem, restless: Diagram) -> Diagram:
    """Of the states from which silent events need not end, those on a way from one cycle of them to another."""
    while True:
        after = system.diagrams.false
        for each in system.silent:
            after |= restless & each.allowed if each.step is None else each.step.image(restless)
        if restless == restless & after:
            return restless
        restless &= after


def _run(system: SupervisedSystem, codes: dict[Element, int], length: int) -> tuple[TraceStep, ...]:
    """So many silent events in a row from a state from which they are possible."""
    longer = [system.reachable]
    for states, _ in zip(runs(system.diagrams, system.silent, system.reachable), range(length - 1), strict=False):
        longer.append(states)
    taken = []
    for states in reversed(longer):
        event, codes = _next(system, codes, states)
        taken.append(happening(event.relation))
    return tuple(taken)


def _next(
    system: SupervisedSystem, codes: dict[Element, int], within: Diagram
) -> tuple[SilentEvent, dict[Element, int]]:
    """The first silent event that leads from a state to one of these, and the state after it."""
    here = system.encoding.state(codes)
    for each in system.silent:
        after = (here & each.allowed if each.step is None else each.step.image(here)) & within
        if after.satisfiable():
            return each, pick(after, system.encoding.layout.state)
    raise AssertionError("the states were said to go on")
