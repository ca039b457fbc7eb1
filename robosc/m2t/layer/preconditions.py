"""What a layer can't be made of: each a located error; and settings that mean nothing to it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from robosc.configuration import Configuration
from robosc.diagnostics import Diagnostic, Severity
from robosc.m2t.cpp.preconditions import graph_preconditions, package_preconditions
from robosc.metamodel.places import place

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robosc.m2t.models import Models
    from robosc.metamodel import rosgraph

RULE = "layer-topic"

_PACKAGE = re.compile(r"[a-z]([a-z0-9]|_(?!_))*[a-z0-9]")
_EXECUTABLE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.+-]*")
_NODE = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_NAMESPACE = re.compile(r"/?[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*")
_FILE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.+-]*(/[A-Za-z0-9_][A-Za-z0-9_.+-]*)*")


def preconditions(models: Models, configuration: Configuration) -> list[Diagnostic]:
    """What keeps these models from becoming a layer with these settings, and settings without effect (warnings)."""
    found = graph_preconditions(models)
    graph = models.rosgraph
    if graph is None:
        return found
    return [
        *found,
        *package_preconditions(graph, configuration, configuration.layer_name(graph)),
        *_shared_topics(graph),
        *_controller(configuration),
        *_unused(configuration),
    ]


def _shared_topics(graph: rosgraph.RosGraph) -> Iterator[Diagnostic]:
    """A message that could be two things can't be handed on as one."""
    taken: dict[str, str] = {}
    for topic, name, element in _communications(graph):
        key = topic.removeprefix("/")
        if key in taken:
            file, span = place(element)
            message = (
                f'{taken[key]} and {name} are both on "{topic}": a supervisory layer would not know which one passes'
            )
            hint = "give each a topic of its own, or make one of them"
            yield Diagnostic(file, span, Severity.ERROR, RULE, message, hint)
        taken.setdefault(key, name)


def _communications(
    graph: rosgraph.RosGraph,
) -> Iterator[tuple[str, str, rosgraph.Reception | rosgraph.Sending]]:
    for subscription in graph.subscriptions:
        yield from ((subscription.topic, each.name, each) for each in subscription.receptions)
    for publisher in graph.publishers:
        yield from ((publisher.topic, each.name, each) for each in publisher.sendings)


def _controller(configuration: Configuration) -> Iterator[Diagnostic]:
    """What stands in the launch file as it is."""
    controller = configuration.supervisor.controller
    key = ("supervisor", "controller")
    if controller.run and controller.launch:
        yield configuration.error(key, '"run" and "launch" both start the controller', "leave out one of them")
    checked = []
    if controller.run:
        run = controller.run
        checked = [
            ("run", "packageName", run.package_name, _PACKAGE),
            ("run", "executable", run.executable, _EXECUTABLE),
            ("run", "name", run.name, _NODE),
            ("run", "namespace", run.namespace, _NAMESPACE),
        ]
    if controller.launch:
        checked += [
            ("launch", "packageName", controller.launch.package_name, _PACKAGE),
            ("launch", "file", controller.launch.file, _FILE),
        ]
    for form, name, value, pattern in checked:
        if value is not None and not pattern.fullmatch(value):
            message = f'"{".".join((*key, form, name))}" is no name that a launch file could use'
            yield configuration.error((*key, form, name), message)


def _unused(configuration: Configuration) -> Iterator[Diagnostic]:
    default = Configuration()
    settings = {
        "retryMs": configuration.retry_ms != default.retry_ms,
        "frameId": configuration.frame_id,
        "watchdogMs": configuration.watchdog_ms,
        "watchdogStops": configuration.watchdog_stops,
        "onShutdown": configuration.on_shutdown,
        "onWithheld": configuration.on_withheld,
        "lifecycle": configuration.lifecycle,
    }
    for key, used in settings.items():
        if used:
            yield configuration.warning((key,), f'"{key}" has no effect on this target')
