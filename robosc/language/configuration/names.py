"""Names of topics, services and actions, as the configuration makes them."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from robosc.language.configuration import Configuration
    from robosc.model import rosgraph


@contextmanager
def configured_names(graph: rosgraph.RosGraph | None, configuration: Configuration) -> Iterator[None]:
    """Within this block, the names of a graph lose their leading `/` unless `absoluteNames` keeps it."""
    if graph is None or configuration.absolute_names:
        yield
        return
    named: list[tuple[Any, str]] = [
        (topic, "topic") for topic in (*graph.subscriptions, *graph.publishers, *graph.model.plants)
    ]
    services = (*graph.serviceClients, *graph.serviceServers)
    actions = (*graph.actionClients, *graph.actionServers)
    named += [(user, "identifier") for user in (*services, *actions)]
    names = [(element, attribute, getattr(element, attribute)) for element, attribute in named]
    for element, attribute, name in names:
        setattr(element, attribute, name and name.removeprefix("/"))
    try:
        yield
    finally:
        for element, attribute, name in names:
            setattr(element, attribute, name)


def absolute_names(graph: rosgraph.RosGraph) -> tuple[list[str], list[str], list[str]]:
    """Return the absolute names of topics, services and actions, each once."""

    def absolute(names: Iterable[str]) -> list[str]:
        return [*dict.fromkeys(name for name in names if name.startswith("/"))]

    return (
        absolute([*(end.topic for end in graph.subscriptions), *(end.topic for end in graph.publishers)]),
        absolute(
            [*(end.identifier for end in graph.serviceClients), *(end.identifier for end in graph.serviceServers)]
        ),
        absolute([*(end.identifier for end in graph.actionClients), *(end.identifier for end in graph.actionServers)]),
    )
