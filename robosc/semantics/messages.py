"""Which data of messages a node reads, and which headers it fills: one answer for all nodes, run and generated.

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


def parts_with_headers(sending: rosgraph.Sending) -> list[tuple[str, ...]]:
    """The data as a whole, `()`, and its parts on the way to fields that the model sets, by their path, sorted.

    A goal of `pose.pose.position.x` has `pose`, `pose.pose` and `pose.pose.position`: each gets the time and the frame,
    where it has a field `header`. A part of which the model sets some field of `header` is not among them: that header
    is the model's.
    """
    paths = [tuple(field.path) for data in sending.alternatives for field in data.fields]
    parts = {()} | {path[:length] for path in paths for length in range(1, len(path))}
    given = {path[: path.index("header")] for path in paths if "header" in path}
    return sorted(part for part in parts - given if "header" not in part)
