"""`single-behaviour` (thesis 4.5.7)."""

from collections.abc import Iterator

from robosc.checks.automata import components
from robosc.checks.rule import Finding, rule
from robosc.checks.unique_names import on_line
from robosc.metamodel import robosc as rsc


@rule("single-behaviour")
def single_behaviour(base: rsc.Base) -> Iterator[Finding]:
    """A component has at most one behaviour."""
    for component, local in components(base):
        every = [definition for definition in local.definitions if isinstance(definition, rsc.ComponentBehaviour)]
        for other in every[1:]:
            yield Finding(
                other,
                f"`{component.name}` has another behaviour already{on_line(every[0])}, expected one",
                "move its states, variables and transitions to the first one, or to a component of their own",
            )
