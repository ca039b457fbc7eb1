"""Rules `initial-state` and `marked-state` (thesis 4.5.9 and 4.5.10)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.language.checks.automata import initial_states, one_initial, start_of
from robosc.language.checks.definitions import behaviours, common_transitions, states
from robosc.language.checks.edits import Choice, Insertion, part_of
from robosc.language.checks.rule import Finding, rule
from robosc.model import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping


@rule("initial-state")
def initial_state(base: rsc.Base) -> Iterator[Finding]:
    """Every behavior has exactly one initial state, and therefore at least one state."""
    yield from initial_states(base)
    for component, behaviour in behaviours(base):
        every = states(behaviour.automaton)
        initial = [state for state in every if state.initial]
        for other in initial[1:]:
            yield Finding(
                other,
                f"`{component.name}` has a second initial state `{other.name}`, expected one: it starts in"
                f" `{initial[0].name}`",
                one_initial(
                    f"leave `initial` out before `{other.name}` or before `{initial[0].name}`", other, initial[0]
                ),
            )
        if not every:
            yield Finding(
                behaviour,
                f"the behaviour of `{component.name}` has no state, expected one that is initial",
                Insertion(
                    "add a state, such as `initial marked state idle { }`",
                    " initial marked state idle { }",
                    part_of(behaviour).find("{"),
                    behind=True,
                    is_choice=True,
                ),
                relies_on=behaviour,
            )
        elif not initial:
            yield Finding(
                behaviour,
                f"no state of `{component.name}` is initial, expected one",
                start_of(
                    f"write `initial` before the state it starts in, such as `initial state {every[0].name}`", every
                ),
                relies_on=behaviour,
            )


@rule("marked-state")
def marked_state(base: rsc.Base) -> Iterator[Finding]:
    """From each reachable state of a component, its transitions lead to a marked state. Guards are ignored."""
    for component, behaviour in behaviours(base):
        every = states(behaviour.automaton)
        initial = [state for state in every if state.initial][:1]  # `initial-state` reports a second one.
        common = common_transitions(behaviour.automaton)
        known = set(every)
        after = {
            state: [transition.target for transition in (*state.transitions, *common) if transition.target in known]
            for state in every
        }
        before: dict[rsc.State, list[rsc.State]] = {state: [] for state in every}
        for source, targets in after.items():
            for target in targets:
                before[target].append(source)
        marked = [state for state in every if state.marked]
        live = _closure(marked, before)
        reached = _closure(initial, after)
        for state in every:
            if state in reached and state not in live:
                yield Finding(
                    state,
                    f"no marked state can be reached from `{component.name}.{state.name}`, expected that every"
                    " reachable state leads to one",
                    Insertion(
                        f"write `marked` before `state {state.name}`, or add a transition to "
                        + " or ".join(f"`{other.name}`" for other in marked[:3]),
                        "marked ",
                        state,
                        is_choice=True,
                    )
                    if marked
                    else _rest(f"write `marked` before a state of `{component.name}` where it may rest", every),
                    relies_on=behaviour,
                    relies_on_names=(rsc.Transition,),
                )


def _rest(hint: str, states: Iterable[rsc.State]) -> Choice:
    ways = (Insertion(f"write `marked` before `state {state.name}`", "marked ", state) for state in states)
    return Choice(hint, tuple(ways))


def _closure(start: Iterable[rsc.State], edges: Mapping[rsc.State, Iterable[rsc.State]]) -> set[rsc.State]:
    reached = set(start)
    queue = list(reached)
    while queue:
        for target in edges[queue.pop()]:
            if target not in reached:
                reached.add(target)
                queue.append(target)
    return reached
