"""The automata that a text defines."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import robosc as rsc

if TYPE_CHECKING:
    from collections.abc import Iterator


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
    return [each for each in automaton.definitions if isinstance(each, rsc.State)]


def common_transitions(automaton: rsc.Automaton) -> list[rsc.Transition]:
    """The transitions that every state has, in the order of the text."""
    return [each for each in automaton.definitions if isinstance(each, rsc.Transition)]


def transitions(automaton: rsc.Automaton) -> Iterator[rsc.Transition]:
    """All its transitions, in the order of the text."""
    for definition in automaton.definitions:
        if isinstance(definition, rsc.State):
            yield from definition.transitions
        elif isinstance(definition, rsc.Transition):
            yield definition
