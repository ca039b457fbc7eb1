"""The messages with which a node stops the robot, and the requirements that they override."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robosc.metamodel import rosgraph, sct


def message_named(graph: rosgraph.RosGraph, name: str) -> rosgraph.Sending | None:
    """The message that the node sends by this name, or by `Component.name`; None where there is none, or several."""
    sendings = [each for publisher in graph.publishers for each in publisher.sendings]
    found = [each for each in sendings if name in (each.name, each.event.eContainer().origin)]
    return found[0] if len(found) == 1 else None


def reasons_of(graph: rosgraph.RosGraph, event: sct.Event) -> list[str]:
    """Why an event may be forbidden, in the words of the robot's model: its requirements, and why synthesis does so."""
    guards = graph.model.supervisor.guards if graph.model.supervisor else ()
    why = [each.explanation for each in guards if each.event == event and each.explanation]
    return [*requirements_on(graph, event), *(f"synthesis prevents this: {each}" for each in why)]


def requirements_on(graph: rosgraph.RosGraph, event: sct.Event) -> list[str]:
    """The requirements on an event, in the words of the robot's model."""
    return [each.text for each in graph.model.requirements if each.event == event and each.text]
