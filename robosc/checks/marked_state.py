"""`marked-state` (thesis 4.5.10)."""

from collections.abc import Iterable, Iterator, Mapping

from robosc.checks.automata import behaviours, common_transitions, states
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc


@rule("marked-state")
def marked_state(base: rsc.Base) -> Iterator[Finding]:
    """From each reachable state of a component its transitions lead to a marked state, guards left aside."""
    for component, behaviour in behaviours(base):
        every = states(behaviour.automaton)
        initial = [state for state in every if state.initial][:1]  # A second one is the matter of `initial-state`.
        common = common_transitions(behaviour.automaton)
        after = {state: list(_successors([*state.transitions, *common], behaviour.automaton)) for state in every}
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
                    f"write `marked` before `state {state.name}`, or add a transition to {_names(marked)}"
                    if marked
                    else f"write `marked` before a state of `{component.name}` where it may rest",
                    relies_on=behaviour,
                    relies_on_names=(rsc.Transition,),
                )


def _successors(transitions: Iterable[rsc.Transition], automaton: rsc.Automaton) -> Iterator[rsc.State]:
    for transition in transitions:
        if transition.target and transition.target.eContainer() is automaton:
            yield transition.target


def _closure(start: Iterable[rsc.State], edges: Mapping[rsc.State, Iterable[rsc.State]]) -> set[rsc.State]:
    found = set(start)
    queue = list(found)
    while queue:
        for target in edges[queue.pop()]:
            if target not in found:
                found.add(target)
                queue.append(target)
    return found


def _names(marked: list[rsc.State]) -> str:
    return " or ".join(f"`{state.name}`" for state in marked[:3])
