"""The data that events bring, and where it is read: one answer for the node that runs and those that are generated.

Read is only what the transitions need that an event takes in the present state: what its reactions there assign. Where
any of that can't be read, the event happens for no component. Inputs of the supervisor always can: no element of an
array is one (rule `variable-type`, and what makes a rosgraph model valid).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robosc.metamodel import rosgraph
from robosc.metamodel.reflection import tree

if TYPE_CHECKING:
    from robosc.metamodel import expression as ex


def receptions(graph: rosgraph.RosGraph) -> list[rosgraph.Reception]:
    """All data that comes in."""
    clients: list[rosgraph.ServiceClient | rosgraph.ActionClient] = [*graph.serviceClients, *graph.actionClients]
    return [
        *(reception for topic in graph.subscriptions for reception in topic.receptions),
        *(client.response for client in clients),
        *(action.feedback for action in graph.actionClients),
    ]


def reads_elements(expression: ex.Expression) -> bool:
    """Whether an element of an array is read, which need not be there. What rules of enumerations read is theirs."""
    return any(isinstance(step, rosgraph.IndexStep) for _, step in tree(expression))
