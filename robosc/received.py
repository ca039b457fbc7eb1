"""The data that events bring, and where it is read: one answer for the node that runs and those that are generated.

Read is only what the transitions need that an event takes in the present state: what its reactions there assign, and
its inputs there. Where any of that can't be read, the event happens for no component.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.edges import edges_from
from robosc.metamodel import rosgraph, sct
from robosc.metamodel.reflection import tree
from robosc.roles import plant_of

if TYPE_CHECKING:
    from robosc.metamodel import expression as ex


def receptions(graph: rosgraph.RosGraph) -> list[rosgraph.Reception]:
    """All data that comes in."""
    clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = [*graph.serviceClients, *graph.actionClients]
    return [
        *(each for topic in graph.subscriptions for each in topic.receptions),
        *(each.response for each in clients),
        *(each.feedback for each in graph.actionClients),
    ]


def reads_elements(expression: ex.Expression) -> bool:
    """Whether an element of an array is read, which need not be there. What rules of enumerations read is theirs."""
    return any(isinstance(step, rosgraph.IndexStep) for _, step in tree(expression))


def locations_reading(event: sct.Event, value: sct.Input) -> list[sct.Location]:
    """The locations of all plants with a transition on the event that reads an input of it, in the model's order."""
    model = plant_of(event).eContainer()
    assert isinstance(model, sct.SupervisoryControlModel)
    return [
        location
        for plant in model.plants
        for location in plant.locations
        if any(edge.event is event and _reads(edge, value) for edge in edges_from(location))
    ]


def _reads(edge: sct.Edge, value: sct.Input) -> bool:
    return any(isinstance(part, sct.InputReference) and part.input is value for _, part in tree(edge))
