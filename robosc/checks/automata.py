"""The automata that a text defines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.metamodel import expression as ex


def components(base: rsc.Base) -> Iterator[tuple[rsc.Component, rsc.LocalComponent]]:
    """The components that the base itself defines, in the order of the text."""
    for component in base.definitions:
        if isinstance(component, rsc.Component) and isinstance(component.type, rsc.LocalComponent):
            yield component, component.type


def behaviours(base: rsc.Base) -> Iterator[tuple[rsc.Component, rsc.ComponentBehaviour]]:
    """Every behaviour of these components, of one component all of them."""
    for component, local in components(base):
        for definition in local.definitions:
            if isinstance(definition, rsc.ComponentBehaviour) and definition.automaton:
                yield component, definition


def states(automaton: rsc.Automaton) -> list[rsc.State]:
    """Its states, in the order of the text."""
    return [definition for definition in automaton.definitions if isinstance(definition, rsc.State)]


def common_transitions(automaton: rsc.Automaton) -> list[rsc.Transition]:
    """The transitions that every state has, in the order of the text."""
    return [definition for definition in automaton.definitions if isinstance(definition, rsc.Transition)]


def transitions(automaton: rsc.Automaton) -> Iterator[rsc.Transition]:
    """All its transitions, in the order of the text."""
    for definition in automaton.definitions:
        if isinstance(definition, rsc.State):
            yield from definition.transitions
        elif isinstance(definition, rsc.Transition):
            yield definition


def sends_message(transition: rsc.Transition) -> bool:
    """Whether a transition happens when the controller sends its component a message."""
    if not isinstance(transition, rsc.ResultTransition) or str(transition.resultType) != "request":
        return False
    communication = transition.communicationType.communicationType if transition.communicationType else None
    return isinstance(communication, rsc.Message) and str(communication.direction) == "incoming"


def assigned_variable(assignment: rsc.Assignment) -> rsc.Variable | None:
    """The variable of the own component that an assignment means; None for anything else."""
    item = assignment.item.item if assignment.item else None
    own = isinstance(item, rsc.Variable) and _component(item) is _component(assignment)
    return item if own and isinstance(item, rsc.Variable) else None


def _component(element: ex.Located) -> rsc.Component | None:
    around = element
    while around is not None and not isinstance(around, rsc.Component):
        around = around.eContainer()
    return around
