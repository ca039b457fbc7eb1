"""What a text declares to carry data, and the types that it names for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.checks.automata import behaviours, components
from robosc.metamodel import robosc as rsc
from robosc.semantics.communication import carried

if TYPE_CHECKING:
    from collections.abc import Iterator

#: For one that has taken an outgoing message for what the controller sends.
DIRECTIONS = (
    "or, if the controller sends it, declare it as `incoming message {}`: incoming is what a component receives"
)


def communications(base: rsc.Base) -> Iterator[tuple[rsc.Component, rsc.CommunicationType]]:
    """The messages, services and actions that the base itself defines, each with its component."""
    for component, local in components(base):
        for definition in local.definitions:
            if isinstance(definition, rsc.CommunicationType):
                yield component, definition


def variables(base: rsc.Base) -> Iterator[tuple[rsc.Component, rsc.Variable]]:
    """The variables that the base itself defines, each with its component."""
    for component, behaviour in behaviours(base):
        for definition in behaviour.automaton.definitions:
            if isinstance(definition, rsc.Variable):
                yield component, definition


def data_types(base: rsc.Base) -> Iterator[rsc.DataType]:
    """Every type that stands in the text of a base, those within arrays too."""
    for outermost in _outermost(base):
        around: rsc.DataType | None = outermost
        while around is not None:
            yield around
            around = around.type if isinstance(around, rsc.Array) else None


def _outermost(base: rsc.Base) -> Iterator[rsc.DataType | None]:
    for definition in base.definitions:
        if isinstance(definition, rsc.EnumDataType):
            yield definition.type
        elif isinstance(definition, rsc.ObjectDataType):
            yield from (part.type for part in definition.properties)
    for _, communication in communications(base):
        yield from (declared for _, declared in carried(communication))
    for _, variable in variables(base):
        yield variable.type
