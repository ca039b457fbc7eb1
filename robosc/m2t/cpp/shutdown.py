"""The messages with which a node stops the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.metamodel import rosgraph


def message_named(graph: rosgraph.RosGraph, name: str) -> rosgraph.Sending | None:
    """The message that the node sends by this name, or by `Component.name`; None where there is none, or several."""
    sendings = [each for publisher in graph.publishers for each in publisher.sendings]
    found = [each for each in sendings if name in (each.name, each.event.eContainer().origin)]
    return found[0] if len(found) == 1 else None
