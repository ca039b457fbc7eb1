"""`initial-state` (thesis 4.5.9)."""

from collections.abc import Iterator

from robosc.checks.automata import behaviours, states
from robosc.checks.rule import Finding, rule
from robosc.metamodel import robosc as rsc


@rule("initial-state")
def initial_state(base: rsc.Base) -> Iterator[Finding]:
    """A behaviour has exactly one initial state, and so at least one state."""
    for component, behaviour in behaviours(base):
        every = states(behaviour.automaton)
        initial = [state for state in every if state.initial]
        for other in initial[1:]:
            yield Finding(
                other,
                f"`{component.name}` has a second initial state `{other.name}`, expected one: it starts in"
                f" `{initial[0].name}`",
                f"leave `initial` out before `{other.name}` or before `{initial[0].name}`",
            )
        if not every:
            yield Finding(
                behaviour,
                f"the behaviour of `{component.name}` has no state, expected one that is initial",
                "add a state, such as `initial marked state idle { }`",
                relies_on=behaviour,
            )
        elif not initial:
            yield Finding(
                behaviour,
                f"no state of `{component.name}` is initial, expected one",
                f"write `initial` before the state it starts in, such as `initial state {every[0].name}`",
                relies_on=behaviour,
            )
