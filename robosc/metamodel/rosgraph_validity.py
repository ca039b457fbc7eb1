"""What makes a rosgraph model one that nodes can be generated from."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robosc.metamodel import rosgraph, sct
from robosc.metamodel.expression_types import ExpressionTypes
from robosc.metamodel.reflection import tree
from robosc.metamodel.rosgraph_shapes import shape_faults
from robosc.semantics.typing import BOOLEAN, declared_type

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

Fault = tuple[Any, str]
_INTERFACES = {
    rosgraph.Subscription: rosgraph.InterfaceKind.message,
    rosgraph.Publisher: rosgraph.InterfaceKind.message,
    rosgraph.ServiceClient: rosgraph.InterfaceKind.service,
    rosgraph.ActionClient: rosgraph.InterfaceKind.action,
}


def rosgraph_faults(graph: rosgraph.RosGraph, elements: Sequence[Any]) -> Iterator[Fault]:
    """What is wrong with the graph, of which `elements` are all, each before what it contains."""
    types = ExpressionTypes()
    types.add(elements)
    yield from types.faults
    for element in elements:
        yield from _typed_faults(element, types)
        yield from _reference_faults(element)
        yield from _event_faults(element, graph)
    yield from shape_faults(graph, elements)


def _typed_faults(element: Any, types: ExpressionTypes) -> Iterator[Fault]:
    match element:
        case rosgraph.NodeVariable():
            yield from types.unless(element.initial, declared_type(element.type))
        case rosgraph.FieldAssignment():
            yield from types.unless(element.value, declared_type(element.type))
        case rosgraph.InputAssignment():
            yield from types.unless(element.value, declared_type(element.input.type))
            if any(isinstance(step, rosgraph.IndexStep) for _, step in tree(element.value)):
                yield element, "an input is no element of an array, which need not be there"
        case rosgraph.NodeAssignment():
            yield from types.unless(element.value, declared_type(element.variable.type))
        case rosgraph.ConversionRule():
            yield from types.unless(element.condition, BOOLEAN)


def _reference_faults(element: Any) -> Iterator[Fault]:
    match element:
        case rosgraph.Conversion():
            literals = [element.default, *(rule.literal for rule in element.rules)]
            for literal in dict.fromkeys(literals):
                if literal.eContainer() is not element.enumeration:
                    yield element, f"'{literal.name}' is no literal of {element.enumeration.name}"
        case rosgraph.Reception():
            for assignment in element.inputs:
                if assignment.input not in element.event.inputs:
                    yield assignment, f"'{element.event.name}' does not carry the input '{assignment.input.name}'"
        case rosgraph.ProvidedData() if element.location.eContainer().kind != sct.PlantKind.data:
            yield element, f"'{element.location.name}' is no location of a data plant"
        case rosgraph.Reaction() if len({location.eContainer() for location in element.locations}) > 1:
            yield element, "the locations are of several plants"


def _event_faults(element: Any, graph: rosgraph.RosGraph) -> Iterator[Fault]:
    event = getattr(element, "event", None)
    if isinstance(event, sct.Event) and event.eContainer().eContainer() is not graph.model:
        yield element, f"the event '{event.name}' is another model's"
    wanted = _INTERFACES.get(type(element))
    if wanted is not None and element.interface.kind != wanted:
        yield element, f"'{element.interface.type}' is a {element.interface.kind}, but a {wanted} is wanted"
