"""Names of topics, services and actions, as the configuration makes them."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph


@contextmanager
def configured_names(graph: rosgraph.RosGraph | None, configuration: Configuration) -> Iterator[None]:
    """Within this block, the names of a graph lose their leading `/` unless `absoluteNames` keeps it."""
    if graph is None or configuration.absolute_names:
        yield
        return
    topics = [*graph.subscriptions, *graph.publishers, *(plant for plant in graph.model.plants if plant.topic)]
    names = [(element, "topic", element.topic) for element in topics]
    names += [(client, "identifier", client.identifier) for client in [*graph.serviceClients, *graph.actionClients]]
    for element, attribute, name in names:
        setattr(element, attribute, name.removeprefix("/"))
    try:
        yield
    finally:
        for element, attribute, name in names:
            setattr(element, attribute, name)


def absolute_names(graph: rosgraph.RosGraph) -> tuple[Sequence[str], Sequence[str], Sequence[str]]:
    """Return the absolute names of topics, services and actions, each once."""
    topics = [topic.topic for topic in [*graph.subscriptions, *graph.publishers]]
    services, actions = (
        [client.identifier for client in known] for known in (graph.serviceClients, graph.actionClients)
    )
    return tuple(
        [*dict.fromkeys(name for name in names if name.startswith("/"))] for names in (topics, services, actions)
    )
